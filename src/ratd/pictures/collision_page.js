// The page's own part of the script that stepper.js begins.

function tell(step) {
    element("time").textContent = (1e6 * steps.time[step]).toFixed(3) + " µs";
    element("pieces").textContent = steps.pieces[step];
    element("first").textContent = (100 * steps.first[step]).toFixed(1) + " %";
    element("second").textContent = (100 * steps.second[step]).toFixed(1) + " %";
    element("X").textContent = (steps.first[step] - steps.second[step]).toFixed(3);
    element("N_s").textContent = (1 - steps.first[step] - steps.second[step]).toFixed(3);
}

colourBy("size");
