"""Show at which angular velocity pairs of monomers part."""

import numpy as np

from ratd.figures.style import GREY, TWO_COLUMNS, logarithmic, nanometres, new_figure, styled
from ratd.markdown import markdown_table, plural

LOOK = {"damped": ("#0072B2", "damped, from equilibrium"), "undamped": ("#D55E00", r"undamped, from $\delta = 0$")}
EQ35 = np.sqrt(5.0 / 9.0)
DRAIN = (
    "What is left of the deviation is the outer torque: it takes the angular momentum out of the frame one step after "
    "the Coriolis force has put it in, and only after the velocity was turned, so that vibrations along the radius "
    "lose energy at a rate ~ omega² dt, over a spin-up by a part ~ omega dt/epsilon."
)


@styled
def draw(table):
    """omega of parting over the exact one, against the radius (equal pairs) and the ratio of radii.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.pull_off.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(TWO_COLUMNS, 0.42 * TWO_COLUMNS, "pairs of monomers spun up slowly (drive: prescribed)")
    left, middle, right = figure.subplots(1, 3, sharey=True)
    pairs = table[table["study"] == "pairs"]
    for start, (colour, label) in LOOK.items():
        part = pairs[pairs["start"] == start]
        equal = part["radius_1"] == part["radius_2"]
        ratio = part["omega"] / part["omega_force"]
        left.plot(nanometres(part["radius_1"])[equal], ratio[equal], ".", color=colour, label=label)
        middle.plot((part["radius_2"] / part["radius_1"])[~equal], ratio[~equal], ".", color=colour)
    undamped = LOOK["undamped"][0]
    steps = table[table["study"] == "step"]
    for (_, part), marker in zip(steps.groupby("material", sort=False), "os^Dv", strict=False):
        part = part.sort_values("timestep_factor")
        x = part["timestep_factor"]
        right.plot(x, part["omega"] / part["omega_force"], marker=marker, color=undamped)
        right.plot(x, part["omega_vibrating"] / part["omega_force"], color="black", lw=0.8, ls=":")
    right.plot([], [], color="black", lw=0.8, ls=":", label="1-D integration")
    adiabatic = (table["omega_adiabatic"] / table["omega_force"]).median()
    for axes in (left, middle, right):
        axes.axhline(1.0, color="black", lw=0.8, label=r"$m_\mathrm{red}\omega^2(a_1+a_2) = 3\pi\gamma R$")
        axes.axhline(EQ35, color=GREY, lw=0.8, ls="--", label="Eq. 35")
        axes.axhline(adiabatic, color=undamped, lw=0.8, label="adiabatic, undamped")
    left.set_xlabel("radius of both monomers [nm]")
    middle.set_xlabel("ratio of the radii")
    right.set_xlabel("step factor f")
    if len(steps):
        right.set_title(f"undamped, {nanometres(steps['radius_1'].iloc[0]):.0f} nm, "
                        rf"$\epsilon$ = {steps['epsilon'].iloc[0]:g}")  # fmt: skip
    for axes in (middle, right):
        axes.set_xscale("log")
        logarithmic(axes.xaxis)
    left.set_ylabel(r"$\omega$ of parting over that of a slow force")
    left.set_ylim(0.7, 1.05)
    handles, labels = right.get_legend_handles_labels()
    more, names = left.get_legend_handles_labels()
    found = dict(zip(labels + names, handles + more, strict=True))
    figure.legend(found.values(), found.keys(), loc="outside lower center", ncols=3)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    pairs = table[table["study"] == "pairs"]
    rows = []
    for (material, start), part in pairs.groupby(["material", "start"], sort=False):
        solution = "omega_force" if start == "damped" else "omega_adiabatic"
        for name, chosen in (
            ("equal", part["radius_1"] == part["radius_2"]),
            ("unequal", part["radius_1"] != part["radius_2"]),
        ):
            ratio = (part["omega"] / part[solution])[chosen]
            if not len(ratio):
                continue
            over = [(part["omega"] / part[other])[chosen] for other in ("omega_force", "omega_eq35")]
            rows.append(
                [material, start, name, f"{ratio.notna().sum()}", f"{ratio.isna().sum()}", f"{ratio.median():.4f}",
                 f"{ratio.min():.4f}–{ratio.max():.4f}", f"{100 * np.abs(ratio - 1.0).max():.2f} %",
                 *(f"{value.min():.3f}–{value.max():.3f}" for value in over)]
            )  # fmt: skip
    header = [
        "material", "start", "radii", "pairs", "never parted", "median over its solution", "range",
        "farthest from 1", "over slowly growing force", "over Eq. 35",
    ]  # fmt: skip
    damped, undamped = (pairs[pairs["start"] == start] for start in ("damped", "undamped"))
    good = int((np.abs(damped["omega"] / damped["omega_force"] - 1.0) < 0.01).sum())
    adiabatic = undamped["omega_adiabatic"] / undamped["omega_force"]
    return "\n\n".join(
        [
            "## Pull-off",
            "Pairs of equal monomers with radii drawn evenly from 10-100 nm, and pairs with a ratio of radii up to "
            f"{(table['radius_2'] / table['radius_1']).max():.0f}, are spun up until they part: damped ones from "
            f"equilibrium ({_how(damped)}), undamped ones from first touch, delta = 0, so that they vibrate until they "
            f"part ({_how(undamped)}). The numbers are ranges over the pairs; there is no other scatter.",
            "A damped pair should part at the solution for a slowly growing force, m_red omega² (a_1 + a_2) = 3 pi "
            "gamma R; Eq. 35 takes 5/9 of that force. An undamped pair keeps the action of its vibration and should "
            "part when the vibration reaches the top of the barrier that contact and centrifugal force leave: at "
            f"{adiabatic.min():.4f}–{adiabatic.max():.4f} of the former for epsilon -> 0, which happens to lie close "
            f"to Eq. 35, at {EQ35:.4f}. Each omega is divided by the solution for its start.",
            markdown_table(header, rows),
            f"Within 1 % of the exact answer: {good} of {plural(len(damped), 'damped pair')}.",
            _tell_steps(table[table["study"] == "step"]),
        ]
    )


def _how(part):
    """epsilon and f of some runs, in words."""
    return f"epsilon = {part['epsilon'].iloc[0]:g}, f = {part['timestep_factor'].iloc[0]:g}"


def _tell_steps(steps):
    """The undamped pair against the step."""
    factors = sorted(set(steps["timestep_factor"]))
    rows, worst = [], 0.0
    for material, part in steps.groupby("material", sort=False):
        part = part.set_index("timestep_factor")
        off = part["omega"] / part["omega_vibrating"] - 1.0
        worst = max(worst, off.abs().max())
        rows.append(
            [material, f"{(part['omega_vibrating'] / part['omega_adiabatic']).iloc[0]:.4f}"]
            + [f"{100 * off[f]:+.2f} %" if np.isfinite(off[f]) else "never parted" for f in factors]
        )
    radius, epsilon = nanometres(steps["radius_1"].iloc[0]), steps["epsilon"].iloc[0]
    sections = [
        f"One undamped pair of {radius:.0f} nm against the step, epsilon = {epsilon:g}. The second column is an "
        "integration of the distance alone, m_red (r'' - omega² r) = F(delta), with error control and the exact "
        "contact radius, over the adiabatic solution; the others are the engine over that integration.",
        markdown_table(["material", "1-D over adiabatic", *(f"f = {f:g}" for f in factors)], rows),
    ]
    if worst > 0.02:
        sections.append(DRAIN)
    return "\n\n".join(sections)
