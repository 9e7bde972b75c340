// Runs in k3d's page when the scene is there. K3DInstance is k3d's handle of the scene; its time is the number of the
// snapshot. What the page tells stands in custom_data of the spheres, see stepper.py; the page's own script follows.

const element = (id) => document.getElementById(id);
const spheres = () => Object.values(K3DInstance.getWorld().ObjectsListJson).find((object) => object.type === "Points");
const { steps, colours } = spheres().custom_data;
const last = Object.values(steps)[0].length - 1;
const slider = element("step");
const PAUSE = 180; // between two snapshots that are played [ms]
let step = 0;
let player = null;

function show(wanted) {
    step = Math.min(Math.max(wanted, 0), last);
    tell(step);
    element("of").textContent = step + 1 + " of " + (last + 1);
    slider.value = step;
    return K3DInstance.setTime(step);
}

function colourBy(choice) {
    spheres().colors = colours[choice];
    for (const name of Object.keys(colours)) {
        document.getElementById("legend-" + name).hidden = name !== choice;
    }
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
setTimeout(standBack, 100); // k3d places the camera some milliseconds after this script
document.querySelectorAll("[name=colour]").forEach((button) => {
    // a chosen button must not take the arrow keys to itself
    button.addEventListener("change", () => {
        button.blur();
        colourBy(button.value);
    });
});
// before k3d and the slider, which have keys of their own
window.addEventListener("keydown", (event) => stepBy(event.key) && event.preventDefault(), true);
