"""Show what the printed equations give."""

import numpy as np

from ratd.figures.style import GREY, TWO_COLUMNS, TYPE_COLOUR, TYPE_MARKER, logarithmic, new_figure, styled
from ratd.markdown import markdown_table, measured, measured_range, plural
from ratd.solid import solid_omega
from ratd.spinup import EPSILON
from ratd.statistics import median_of
from ratd.validation.literal import EXACT_END, MARKS

MARK = "omega_mass_75"
MARK_WORDS = {
    "omega_disr": "omega_disr",
    "omega_first_loss": "first loss of mass",
    "omega_mass_75": "loss of a quarter of the mass",
}
LAW = 1 / 3
"""Exponent of omega in (d omega/dt)/dt that is looked for."""
SCALE = r"$(\mathrm{d}\omega/\mathrm{d}t\,/\,\mathrm{d}t)^{1/3}$"


def with_reference(table):
    """The literal runs, with more columns.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.literal.COLUMNS`.

    Returns
    -------
    pandas.DataFrame
        ``grain``; ``scale``, (d omega/dt / dt)^(1/3); and of every mark ``true_MARK``, that of the consistent drive of
        the same grain. For the explicit Coriolis term ``solid_MARK``, where a solid grain parts that holds up to that,
        and ``backwards_MARK``, whether it then turns against the frame. For the exact one, of runs that lose mass and
        where the grain turns fastest before: ``turns``, how fast in the inertial frame over the consistent omega of the
        first loss, ``stretched``, and the product ``unstretched``, how fast it would turn as it was at rest.
    """
    key = ["material", "type", "a_eff", "seed"]
    true = table[table["drive"] == "prescribed"].set_index(key)[list(MARKS)].add_prefix("true_")
    rows = table[table["drive"] == "literal"].join(true, on=key)
    rows["grain"] = [f"{t} {a * 1e9:.0f} {s:.0f}" for t, a, s in rows[["type", "a_eff", "seed"]].values]
    rows["a_eff"] = rows["a_eff"].round(12)  # grains of one size differ by rounding
    rows["scale"] = (rows["angular_acceleration"] / rows["timestep"]) ** LAW
    for mark in MARKS:
        run = rows[[f"true_{mark}", "spin_share", "angular_acceleration", "timestep"]].to_numpy()
        rows[f"solid_{mark}"], rows[f"backwards_{mark}"] = zip(*(solid_omega(*values) for values in run), strict=True)
    lost = rows["omega_first_loss"].notna()
    rows["stretched"] = rows["stretched"].where(lost)
    rows["turns"] = (rows["turned"] / rows["true_omega_first_loss"]).where(lost)
    rows["unstretched"] = rows["stretched"] * rows["turns"]
    return rows


def torn_backwards(rows, mark):
    """Runs with the explicit term that have a mark, and in which a solid grain would be turned backwards."""
    has = np.isfinite(rows[mark]) & np.isfinite(rows[f"solid_{mark}"])
    return rows[(rows["coriolis"] == "explicit") & has & rows[f"backwards_{mark}"]]


def rate_exponent(table, mark):
    """Exponent of a mark in d omega/dt with the explicit term, see `ratd.statistics.median_of`; over the grains.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.literal.COLUMNS`.
    mark : str
    """
    return _rate_exponent(torn_backwards(with_reference(table), mark), mark)


def _rate_exponent(used, mark):
    return median_of([power for power, _ in exponents(used, mark)])


def exact_over_consistent(table):
    """omega of the first loss with the exact Coriolis term over that in the consistent model.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.literal.COLUMNS`.

    Returns
    -------
    medians, single : tuple of float
        Least and greatest: of the medians of each type and size, over the runs that lost mass, and of these runs.
    """
    exact = with_reference(table[table["coriolis"] == "exact"])
    over = exact["omega_first_loss"] / exact["true_omega_first_loss"]
    medians = over.groupby([exact["type"], exact["a_eff"]]).median()
    return tuple((float(values.min()), float(values.max())) for values in (medians, over))


def exponents(rows, column):
    """Exponents of omega in d omega/dt and in dt, fitted within each grain; list of pairs."""
    found = []
    for _, part in rows.groupby("grain"):
        if len(part) < 4:
            continue
        x = np.log(part[["angular_acceleration", "timestep"]].to_numpy())
        x = np.column_stack([x, np.ones(len(x))])
        if np.linalg.matrix_rank(x - x.mean(axis=0) + [0, 0, 1]) < 3:
            continue
        found.append(np.linalg.lstsq(x, np.log(part[column].to_numpy()), rcond=None)[0][:2])
    return found


@styled
def draw(table):
    """Left: explicit Coriolis term, lines for solid grains. Right: exact, against how the grain stretches.

    Parameters
    ----------
    table : pandas.DataFrame
        Columns of `ratd.validation.literal.COLUMNS`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    rows = with_reference(table)
    figure = new_figure(TWO_COLUMNS, 0.5 * TWO_COLUMNS, "the printed equations (drive: literal)")
    left, right = figure.subplots(1, 2)
    explicit = torn_backwards(rows, MARK)
    sizes = sorted(rows["a_eff"].unique())
    faces = dict(zip(sizes, ("white", None, "black"), strict=False))
    for (kind, a_eff), part in rows.groupby(["type", "a_eff"]):
        look = dict(color=TYPE_COLOUR.get(kind, "black"), marker=TYPE_MARKER.get(kind, "o"), ls="none")
        look |= dict(mfc=faces.get(a_eff))
        here = explicit[explicit["grain"].isin(part["grain"])]
        label = f"{kind} {a_eff * 1e9:.0f} nm"
        left.plot(here["scale"] / here[f"true_{MARK}"], here[MARK] / here["scale"], label=label, **look)
        here = part[part["coriolis"] == "exact"]
        right.plot(here["stretched"], here["unstretched"], **look)
    for _, here in explicit.groupby("grain"):
        first = here.iloc[0]
        ratio = here["scale"] / here[f"true_{MARK}"]
        x = np.geomspace(ratio.min() / 1.1, ratio.max() * 1.1, 30)
        solid = [solid_omega(1.0 / value, first["spin_share"], 1.0, 1.0)[0] for value in x]
        look = dict(color=TYPE_COLOUR.get(first["type"], "black"), lw=0.6, zorder=0)
        left.plot(x, solid, **look)
    if len(explicit):
        left.plot([], [], color="black", lw=0.6, label="solid grain, in the colour of its type")
        left.axhline(explicit[MARK].div(explicit["scale"]).median(), color=GREY, lw=0.8, ls=":", label="exponent 1/3")
    x = rows["stretched"][rows["unstretched"].notna()]
    if len(x):
        ends = np.array([x.min() - 0.1, x.max() + 0.1])
        right.plot(ends, ends, color="black", lw=0.8, ls="--", label="as fast as in the consistent model")
    left.set_xscale("log")
    logarithmic(left.xaxis)
    left.set_title("explicit Coriolis term")
    left.set_xlabel(rf"{SCALE} over consistent $\omega$")
    left.set_ylabel(rf"$\omega$ at 25 % mass loss over {SCALE}")
    right.set_title("exact Coriolis term")
    right.set_xlabel(r"$I_\mathrm{orbit}+I_\mathrm{spin}$ over that at rest, where it turns fastest")
    right.set_ylabel("$\\omega$ times share of the spins at rest\nover consistent $\\omega$ of first loss")
    shown = zip(left.get_legend_handles_labels(), right.get_legend_handles_labels(), strict=True)
    handles, labels = (one + other for one, other in shown)
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def tell(table):
    """The section of the report, Markdown."""
    rows = with_reference(table)
    explicit, exact = (rows[rows["coriolis"] == term] for term in ("explicit", "exact"))
    accelerations = explicit["angular_acceleration"]
    parts = explicit["scale"] * explicit["spin_share"] / explicit[f"true_{MARK}"]
    law = [_law(rows, mark) for mark in MARKS]
    return "\n\n".join(
        [
            "## The literal drive",
            _result(rows),
            f"The equations as printed, for {plural(rows['grain'].nunique(), 'grain')} of "
            + ", ".join(f"{a * 1e9:.0f}" for a in sorted(rows["a_eff"].unique()))
            + f" nm, with d omega/dt from {accelerations.min():.1e} to {accelerations.max():.1e} rad/s² and f = "
            + ", ".join(f"{f:g}" for f in sorted(set(explicit["timestep_factor"])))
            + ". For each grain d omega/dt is chosen so that q = (d omega/dt / dt)^(1/3) is "
            f"{parts.min():.2f} to {parts.max():.2f} times the omega at which its spins alone would tear it (see "
            "below).",
            "With the Coriolis force at the velocity half a step before, a solid grain is turned backwards: Omega, its "
            "angular velocity in the inertial frame, obeys d Omega/dt = s d omega/dt - (1 - s) omega "
            "(omega - Omega)² dt with s the share of the spins, and it parts where |Omega| is the consistent threshold "
            "(`ratd.solid.solid_omega`). omega/q then depends on s and on threshold/q alone. omega ~ q, "
            "the exponents 1/3 and -1/3, would hold for a threshold far above q; far below, they are 1/4 and -1/4. "
            "They are fitted within each grain, to the runs in which a solid grain is turned backwards and to what the "
            "solid grain gives for these; medians over the grains with standard error, in brackets the range of 68 % "
            "of the runs.",
            markdown_table(
                [
                    "mark",
                    "runs (grains)",
                    "exponent of d omega/dt",
                    "solid grain",
                    "exponent of dt",
                    "solid grain",
                    "omega/q",
                    "omega over that of a solid grain",
                ],
                law,
            ),
            _verdict(rows),
            "With the exact Coriolis term a grain turns by its spins alone, with omega I_spin/(I_orbit + I_spin), "
            "because the printed equation of the spins lacks the Euler term. A solid one should then lose its first "
            "mass at the consistent omega of that loss divided by the share. But the spins give a grain its angular "
            "momentum, whatever its shape, and one that stretches turns slower. The table gives medians over the runs "
            "that lost mass, with standard error where there are three grains: omega of the first loss over that in "
            "the consistent model; and where the grain turns fastest before it, “stretched”, the factor by which "
            "I_orbit + I_spin has grown, “turns”, how fast it turns in the inertial frame over the consistent omega of "
            "the first loss, and “unstretched”, the product of the two, how fast it would turn had it kept its shape. "
            "“turns” is 1 if a grain comes apart as soon as it turns as fast as in the consistent model. Runs end at "
            f"{EXACT_END:g} times the omega at which a solid grain would lose a quarter of its mass.",
            markdown_table(
                [
                    "type",
                    "size [nm]",
                    "runs that lost mass",
                    "share of the spins",
                    "omega over consistent",
                    "unstretched",
                    "stretched",
                    "turns",
                ],
                _spins(exact),
            ),
            _stretched(exact),
        ]
    )


def _result(rows):
    """A paragraph: what both forms of the Coriolis term come to."""
    used = torn_backwards(rows, MARK)
    powers = np.array(exponents(used, MARK)).reshape(-1, 2)
    exact = rows[(rows["coriolis"] == "exact") & rows["turns"].notna()]
    words = []
    if len(powers):
        rate, step = (median_of(powers[:, k])["median"] for k in range(2))
        words.append(
            "With the Coriolis force half a step late a grain is turned backwards, and comes apart at an omega that "
            f"goes as (d omega/dt)^{rate:.2f} dt^{step:.2f}, as that of a rigid grain does."
        )
    if len(exact):
        turns = median_of(exact["turns"], exact["grain"])
        words.append(
            "With the exact one it turns only with omega s, s = I_spin/(I_orbit + I_spin) being the share of the "
            f"monomers' own moments of inertia ({exact['spin_share'].min():.2g} to {exact['spin_share'].max():.2g} "
            f"here), and comes apart where that is {measured(turns['median'], turns['error'])} times the omega at "
            "which it does in the consistent model."
        )
    return " ".join(words) or "No grain came apart in these runs."


def _law(rows, mark):
    """A row of the table of the explicit term."""
    used = torn_backwards(rows, mark)
    own, solid = (np.array(exponents(used, column)).reshape(-1, 2) for column in (mark, f"solid_{mark}"))
    cells = [MARK_WORDS[mark], f"{len(used)} ({used['grain'].nunique()})"]
    for power in range(2):
        for fits in (own, solid):
            s = median_of(fits[:, power])
            cells.append(measured(s["median"], s["error"]))
    for scale in ("scale", f"solid_{mark}"):
        s = median_of(used[mark] / used[scale], used["grain"])
        cells.append(measured_range(s))
    return cells


def _verdict(rows):
    """A paragraph: which of the two readings of the explicit term holds."""
    used = torn_backwards(rows, MARK)
    found = _rate_exponent(used, MARK)
    shift = median_of(used[MARK] / used[f"true_{MARK}"], used["grain"])
    off = np.abs(used[MARK] / used[f"solid_{MARK}"] - 1.0)
    words = (
        f"In these runs a quarter of the mass is lost at {measured(shift['median'], shift['error'])} times the "
        f"omega of the consistent model (68 % of the runs {shift['low']:.1f}–{shift['high']:.1f}); nine runs of ten "
        f"are within {100 * np.quantile(off, 0.9):.1f} % of the solid grain, all within {100 * off.max():.1f} %. "
        if len(used)
        else "No grain lost a quarter of its mass in these runs. "
    )
    if np.isfinite(found["error"]) and found["error"] > 0.0:
        apart = abs(found["median"] - LAW) / found["error"]
        words += (
            f"Its exponent of d omega/dt is {apart:.1f} standard errors away from 1/3: omega ~ "
            f"(d omega/dt / dt)^(1/3) {'holds within its error' if apart < 2.0 else 'does not hold exactly'}."
        )
    return words.strip()


def _spins(exact):
    """Rows of the table of the exact term."""
    lines = []
    for (kind, a_eff), part in exact.groupby(["type", "a_eff"]):
        over = part["omega_first_loss"] / part["true_omega_first_loss"]
        values = (over, part["unstretched"], part["stretched"], part["turns"])
        found = [median_of(value, part["grain"]) for value in values]
        lost = f"{part['omega_first_loss'].count()} of {len(part)}"
        lines.append(
            [kind, f"{a_eff * 1e9:.0f}", lost, f"{part['spin_share'].median():.4f}"]
            + [measured(each["median"], each["error"]) for each in found]
        )
    return lines


def _by_type(lost):
    """Type -> what `median_of` gives of ``turns`` and of ``unstretched``, dict of lists."""
    return {
        kind: [median_of(part[name], part["grain"]) for name in ("turns", "unstretched")]
        for kind, part in lost.groupby("type")
    }


def _why(found):
    """A sentence: the types of which stretching changes the outcome, from `_by_type`."""
    differ, agree = [], []
    for kind, (turns, unstretched) in found.items():
        apart = abs(unstretched["median"] - turns["median"])
        (differ if apart > 2.0 * np.hypot(turns["error"], unstretched["error"]) else agree).append(kind)
    words = []
    if differ:
        words.append(f"Stretching is why {' and '.join(differ)} grains need more omega")
    if agree:
        words.append(f"in {' and '.join(agree)} the two numbers agree within two standard errors")
    text = "; ".join(words)
    return text[0].upper() + text[1:] + "."


def _stretched(exact):
    """Paragraphs: how near each type comes to the consistent threshold as it stretches, and what the rate does."""
    lost = exact[exact["turns"].notna()]
    if not len(lost):
        return "No grain lost mass in these runs."
    found = _by_type(lost)
    parts = ["{} {}, {}".format(kind, *map(measured_range, values)) for kind, values in found.items()]
    rate = lost["spin_share"] * lost["angular_acceleration"] / lost["turned"] ** 2
    pairs = [part.sort_values("angular_acceleration")["turns"] for _, part in lost.groupby("grain") if len(part) == 2]
    change = median_of([pair.iloc[1] / pair.iloc[0] for pair in pairs])
    paces = ", ".join(f"{EPSILON[kind]:g} ({kind})" for kind in dict.fromkeys(lost["type"]))
    return (
        "“turns” over all sizes, with the range of 68 % of the runs, and behind it “unstretched”: "
        f"{'; '.join(parts)}. {_why(found)} The angular velocity of a grain rises with epsilon = s d omega/dt/Omega² "
        f"of {rate.min():.1g} to {rate.max():.1g}, that of the consistent runs with {paces}, on which their omega "
        "depends by a few per cent (Convergence in docs/validation.md); the faster run of a grain gives "
        f"{measured_range(change)} times the slower one. What is left of the differences from 1 is not explained."
    )
