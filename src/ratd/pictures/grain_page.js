// Runs in k3d's page when the scene is there. K3DInstance is k3d's handle of the scene; its time is the number of the
// snapshot. What this script needs to know stands in custom_data of the spheres, see grain_page.py.

const element = (id) => document.getElementById(id);
const spheres = () => Object.values(K3DInstance.getWorld().ObjectsListJson).find((object) => object.type === "Points");
const { steps, colours } = spheres().custom_data;
const last = steps.omega.length - 1;
const slider = element("step");
const PAUSE = 180; // between two snapshots that are played [ms]
let step = 0;
let player = null;

function powerOfTen(value) {
    if (value === 0) {
        return "0";
    }
    const [mantissa, exponent] = value.toExponential(3).split("e");
    return mantissa + " &times; 10<sup>" + Number(exponent) + "</sup>";
}

function show(wanted) {
    step = Math.min(Math.max(wanted, 0), last);
    const ratio = steps.ratio[step];
    element("omega").innerHTML = powerOfTen(steps.omega[step]) + " rad/s";
    element("ratio").textContent = ratio === null ? "the run has no peak of the stress" : ratio.toFixed(3);
    element("largest").textContent = (100 * steps.largest[step]).toFixed(1) + " %";
    element("fragments").textContent = steps.fragments[step];
    element("dropped").textContent = steps.dropped[step];
    element("of").textContent = step + 1 + " of " + (last + 1);
    slider.value = step;
    return K3DInstance.setTime(step);
}

function colourBy(choice) {
    spheres().colors = colours[choice];
    element("legend-fragment").hidden = choice !== "fragment";
    element("legend-force").hidden = choice !== "force";
    return show(step);
}

function stop() {
    clearInterval(player);
    player = null;
    element("play").textContent = "play";
}

function play() {
    if (step === last) {
        show(0);
    }
    element("play").textContent = "pause";
    player = setInterval(() => (step === last ? stop() : show(step + 1)), PAUSE);
}

// The angle of view is that from the lower to the upper edge: a window higher than wide is seen from farther away.
function standBack() {
    const target = element("canvasTarget");
    const aspect = target.clientWidth / target.clientHeight;
    if (aspect < 1) {
        const [x, y, z, ...rest] = K3DInstance.getWorld().controls.getCameraArray();
        K3DInstance.setCamera([x / aspect, y / aspect, z / aspect, ...rest]);
    }
}

async function savePicture() {
    const canvas = await K3DInstance.getScreenshot(1, true); // larger ones have smaller spheres
    const link = document.createElement("a");
    const name = document.title.replace(/[^\w.-]+/g, "_");
    link.download = `${name}_${step + 1}.png`;
    link.href = canvas.toDataURL("image/png");
    link.click();
}

const playOrStop = () => (player === null ? play() : stop());

function stepBy(key) {
    const to = { ArrowLeft: step - 1, ArrowDown: step - 1, ArrowRight: step + 1, ArrowUp: step + 1, Home: 0, End: last };
    if (key in to) {
        stop();
        show(to[key]);
    } else if (key === " ") {
        playOrStop();
    } else {
        return false;
    }
    return true;
}

slider.max = last;
const atDisruption = steps.ratio.findIndex((ratio) => ratio !== null && ratio >= 1);
if (atDisruption >= 0) {
    element("disruption").append(new Option("disruption", atDisruption));
}
slider.addEventListener("input", () => {
    stop();
    show(Number(slider.value));
});
element("play").addEventListener("click", () => {
    element("play").blur(); // space is heard by the page, not twice
    playOrStop();
});
element("picture").addEventListener("click", () => {
    element("picture").blur();
    savePicture();
});
document.querySelectorAll("[name=colour]").forEach((button) => {
    // a chosen button must not take the arrow keys to itself
    button.addEventListener("change", () => {
        button.blur();
        colourBy(button.value);
    });
});
// before k3d and the slider, which have keys of their own
window.addEventListener("keydown", (event) => stepBy(event.key) && event.preventDefault(), true);
colourBy("fragment");
setTimeout(standBack, 100); // k3d places the camera some milliseconds after this script
