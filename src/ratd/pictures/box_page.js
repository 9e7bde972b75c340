// The page's own part of the script that stepper.js begins.

function tell(step) {
    element("phi").textContent = steps.phi[step].toPrecision(3);
    element("length").textContent = (1e6 * steps.length[step]).toPrecision(3) + " µm";
    element("contacts").textContent = steps.contacts[step].toFixed(2);
}

colourBy("contacts");
