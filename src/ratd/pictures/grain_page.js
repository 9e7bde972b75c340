// The page's own part of the script that stepper.js begins.

function powerOfTen(value) {
    if (value === 0) {
        return "0";
    }
    const [mantissa, exponent] = value.toExponential(3).split("e");
    return mantissa + " &times; 10<sup>" + Number(exponent) + "</sup>";
}

function tell(step) {
    const ratio = steps.ratio[step];
    element("omega").innerHTML = powerOfTen(steps.omega[step]) + " rad/s";
    element("ratio").textContent = ratio === null ? "the run has no peak of the stress" : ratio.toFixed(3);
    element("largest").textContent = (100 * steps.largest[step]).toFixed(1) + " %";
    element("fragments").textContent = steps.fragments[step];
    element("dropped").textContent = steps.dropped[step];
}

const atDisruption = steps.ratio.findIndex((ratio) => ratio !== null && ratio >= 1);
if (atDisruption >= 0) {
    element("marks").append(new Option("disruption", atDisruption));
}

colourBy("fragment");
setTimeout(standBack, 100); // k3d places the camera some milliseconds after this script
