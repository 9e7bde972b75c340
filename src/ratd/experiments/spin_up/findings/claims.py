"""What the paper says of the spin-up, one finding after the other, beside what the grains here do.

A finding is *yes* where ours keeps its rule, *no* where it does not by more than two standard errors, *open* between.
The rules stand in the document beside the verdicts.
"""

import math

import numpy as np
import pandas as pd

from ratd.base.statistics import equal_weights, mean_of, slope_error, slope_of
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import TYPES, cell_of, size_key
from ratd.experiments.spin_up.findings.ensemble import CLASSES, middle, of_class
from ratd.experiments.spin_up.marks import MARK
from ratd.experiments.spin_up.fragmentation import mass_shares
from ratd.experiments.spin_up.oblateness import oblate_change, oblate_share
from ratd.experiments.spin_up.printed import FIRST_LOSS, PAPER_MEAN_RADIUS, PRINTED_GRAINS
from ratd.base.measured import Measured, median

__all__ = ["claims", "grown_claims", "is_above", "is_below", "is_near_quarter", "is_within"]

BAM = ("BAM1", "BAM2")
STAYS = 0.05
"""Rise of a porosity over the large grains that is no rise."""
WHOLE = 0.99
"""Part of its mass that a grain has which counts as whole."""
ROUND = 1.7
"""c/b below which most large grains of the paper are."""
FIGURE_6 = (200, 350, 500)
"""Sizes [nm] of the grains of Fig. 6, of which the paper tells the shapes."""
SHOWN = "a-C"
"""Their material."""
ABSTRACT = (1e8, 1e9)
"""omega_disr [rad/s] of the abstract, 1e8 to 1e9."""
SURE = 2.0
"""Standard errors from which on a difference is no chance."""


def is_above(found, limit):
    """Verdict: found > limit, a Measured and a number."""
    return "open" if abs(found.value - limit) < SURE * found.error else "yes" if found.value > limit else "no"


def is_below(found, limit):
    """Verdict: found < limit."""
    return {"yes": "no", "no": "yes", "open": "open"}[is_above(found, limit)]


def is_within(found, low, high):
    """Verdict: low < found < high."""
    return all_of([is_above(found, low), is_below(found, high)])


def is_near_quarter(ratio):
    """Verdict: omega_disr over the omega at which a quarter is lost is about 1."""
    return is_within(ratio, 0.8, 1.25)


def all_of(verdicts):
    """Verdict: all of several hold."""
    verdicts = set(verdicts)
    return "no" if "no" in verdicts else "open" if "open" in verdicts else "yes"


def claims(letter, table, fragments):
    """Findings on the spin-ups of one drive.

    Parameters
    ----------
    letter : str
        The first letter of the names.
    table : pandas.DataFrame
        As `ratd.experiments.spin_up.findings.ensemble.beside_print` returns it.
    fragments : pandas.DataFrame
        As `ratd.experiments.spin_up.fragmentation.spun_up_fragments` returns it.

    Returns
    -------
    dict
        Name of a slot -> value; verdicts begin with the letter and ``holds``.
    """
    return _where(letter, table) | _how(letter, table, fragments) | _shapes(letter, table)


def _where(letter, table):
    """omega itself, and how it goes with type and size."""
    ratio = median(table["omega_disr"] / table["printed"], cell_of(table))
    low, high = (table["omega_disr"].min(), table["omega_disr"].max())
    by_size = _by_type_and_size(table)
    values = {
        f"{letter}.disr over print": ratio,
        f"{letter}.disr over print least": float(by_size.min()),
        f"{letter}.disr over print most": float(by_size.max()),
        f"{letter}.holds level": is_within(ratio, 0.8, 1.25),
        f"{letter}.holds range": "yes" if 2.5e8 < low and high < 1e10 else "no",
        f"{letter}.in abstract": float(table["omega_disr"].between(*ABSTRACT).mean()),
        f"{letter}.large in abstract": float(of_class(table, "large")["omega_disr"].between(*ABSTRACT).mean()),
    }
    (material, kind, size), _ = FIRST_LOSS
    shown = table[
        (table["material"] == material) & (table["type"] == kind) & np.isclose(table["a_eff"], size, atol=0.0)
    ]
    last = median(shown["omega_end"] / shown["omega_first_loss"])
    values |= {f"{letter}.to the last": last, f"{letter}.holds to the last": is_within(last, 5.0, 20.0)}
    slopes_above = []
    for kind in TYPES:
        part = of_class(table[table["type"] == kind], "large")
        x, y = np.log(part["a_eff"]), np.log(part["omega_disr"])
        slopes_above.append(_slope(x, y, part))
    values[f"{letter}.holds limit"] = all_of(is_within(slope, -0.25, 0.25) for slope in slopes_above)
    values[f"{letter}.steepest"] = min(slope.value for slope in slopes_above)
    values[f"{letter}.flattest"] = max(slope.value for slope in slopes_above)
    order = table.assign(log=np.log(table["omega_disr"]), size=size_key(table["a_eff"]))
    cells = order.groupby(["material", "type", "size"])["log"]
    means, errors = (each.unstack("type") for each in (cells.mean(), cells.sem()))
    ahead = pd.DataFrame({kind: means[kind] - means["BA"] for kind in BAM})
    sure = pd.DataFrame({kind: ahead[kind] > SURE * np.hypot(errors[kind], errors["BA"]) for kind in BAM})
    first = (ahead > 0.0).all(axis="columns")
    values[f"{letter}.BA first"], values[f"{letter}.BA cells"] = int(first.sum()), len(first)
    values[f"{letter}.BA first surely"] = int(sure.all(axis="columns").sum())
    values[f"{letter}.holds BA first"] = "yes" if first.all() else "open" if first.mean() > 0.9 else "no"
    return values


def _by_type_and_size(table):
    """omega_disr over the printed one, medians of the grains of each type and size."""
    return (table["omega_disr"] / table["printed"]).groupby([table["type"], size_key(table["a_eff"])]).median()


def _slope(x, y, part):
    slope, influence = slope_of(x, y, part["material"], equal_weights(cell_of(part)))
    return Measured(slope, slope_error(influence))


def _how(letter, table, fragments):
    """How the mass goes, and what the contacts do."""
    values = {}
    lost = 1.0 - table["mass_fraction_disr"]
    near = {kind: _near(table[table["type"] == kind]) for kind in TYPES}
    for kind, share in near.items():
        values[f"{letter}.near quarter {kind}"] = Measured(100 * share.value, 100 * share.error)
        values[f"{letter}.lost at disr {kind}"] = 100.0 * _by_type(lost, table)[kind].value
    apart = _by_type(table["omega_disr"] / table[MARK], table)
    values |= {f"{letter}.disr over quarter {kind}": value for kind, value in apart.items()}
    values[f"{letter}.holds quarter BAM"] = all_of(is_near_quarter(apart[kind]) for kind in BAM)
    for name in CLASSES:
        part = of_class(table[table["type"] == "BA"], name)
        ratio = values[f"{letter}.disr over quarter BA {name}"] = median(part["omega_disr"] / part[MARK], cell_of(part))
        values[f"{letter}.holds quarter BA {name}"] = is_near_quarter(ratio)
    half = fragments[fragments["half"]]
    grains = half.groupby("grain")
    pieces = _by_type(grains["mass_fraction"].max(), grains[["material", "type", "a_eff"]].first())
    for kind, piece in pieces.items():
        values[f"{letter}.largest piece {kind}"] = piece
    values[f"{letter}.holds continuous"] = all_of(is_below(piece, 0.1) for piece in pieces.values())
    found = [mass_shares(half[half["type"] == kind])["1 monomer"] for kind in BAM]
    values[f"{letter}.holds single"] = all_of(is_above(share, 0.8) for share in found)
    gain = table["n_contacts_max"] / table["n_contacts"]
    gains = _by_type(gain, table)
    for kind, value in gains.items():
        values[f"{letter}.contacts {kind}"] = value
    values[f"{letter}.contacts BAM2 grain"] = float((gain[table["type"] == "BAM2"] > 1.0).mean())
    values[f"{letter}.holds contacts"] = "yes" if gains["BAM2"].value > 1.0 else "no"
    return values


def _by_type(values, table):
    """Type -> median of its grains, all cells counting alike."""
    cells = cell_of(table)
    return {kind: median(values[own], cells[own]) for kind in TYPES for own in (table["type"] == kind,)}


def _near(table):
    """Share of the grains in which a quarter of the mass is lost within 25 % of omega_disr, of those that lose it."""
    both = (table[MARK] / table["omega_disr"])[table[MARK] > 0.0]
    share = float((np.abs(np.log(both)) < math.log(1.25)).mean())
    return Measured(share, math.sqrt(share * (1.0 - share) / len(both)))


def _shapes(letter, table):
    """Whether grains become oblate: large ones, and small BA, of which the paper says that they do not."""
    ba, bam = (table[table["type"].isin(kinds)] for kinds in (("BA",), BAM))
    parts = {"BA": of_class(ba, "large"), "BAM": of_class(bam, "large")}
    parts |= {f"small {name}": part[np.isclose(part["nm"], FIGURE_6[0])] for name, part in (("BA", ba), ("BAM", bam))}
    values = {}
    for name, part in parts.items():
        change, (share, error, *_) = Measured(*oblate_change(part)), oblate_share(part, "disr")
        end = Measured(share, error)
        values[f"{letter}.oblate {name} disr"] = Measured(100 * end.value, 100 * end.error)
        values[f"{letter}.oblate {name} change"] = Measured(100 * change.value, 100 * change.error)
        whole = oblate_change(part[part["mass_fraction_disr"] >= WHOLE], by_cell=False)
        values[f"{letter}.oblate whole {name} change"] = Measured(*(100 * number for number in whole))
        more = all_of([is_above(change, 0.0), is_above(end, 0.5)])
        values[f"{letter}.holds oblate {name}"] = is_below(change, 0.0) if name == "small BA" else more
    stretch = (table["axis_b_disr"] / table["axis_a_disr"]).replace(np.inf, np.nan)
    most = stretch[bam.index[_of_figure_6(bam)]].max()
    values[f"{letter}.remnants"] = 100.0 * float((parts["BA"]["mass_fraction_disr"] < WHOLE).mean())
    flat = {}
    for kind in TYPES:
        part = of_class(table[table["type"] == kind], "large")
        flat[kind] = values[f"{letter}.b/a {kind}"] = median(stretch[part.index], cell_of(part))
    least = min(flat["BAM1"], flat["BAM2"])
    change = Measured(flat["BA"].value - least.value, math.hypot(flat["BA"].error, least.error))
    values[f"{letter}.holds b/a BA"] = is_below(change, 0.0)
    return values | {
        f"{letter}.most oblate": float(most),
        f"{letter}.holds b/a": "yes" if 4.0 < most < 6.25 else "no",
    }


def grown_claims(grown):
    """Findings on the grains as grown."""
    values = {}
    for kind, (low, high) in {"BA": (0.40, 0.85), "BAM1": (0.35, 0.70), "BAM2": (0.35, 0.50)}.items():
        part = grown[grown["type"] == kind]
        large = of_class(part, "large")
        mean = Measured(*mean_of(large["porosity"], cell_of(large)))
        values[f"g.porosity {kind}"] = mean
        values[f"g.porosity {kind} range"] = f"{part['porosity'].min():.2f}–{part['porosity'].max():.2f}"
        means = {
            round(size / 1e3): Measured(*mean_of(own["porosity"], cell_of(own)))
            for size, own in part.groupby(size_key(part["a_eff"]))
        }
        for end, limit, found in (("least", low, min(means.values())), ("most", high, max(means.values()))):
            values[f"g.holds porosity {kind} {end}"] = is_within(found, limit / 1.1, 1.1 * limit)
        for size in (min(means), max(means)):
            values[f"g.porosity {kind} {size}"] = means[size].value
        slope = _slope(np.log(large["a_eff"]), large["porosity"], large)
        rise = values[f"g.porosity {kind} rise"] = Measured(
            *(math.log(large["nm"].max() / large["nm"].min()) * each for each in slope)
        )
        values[f"g.holds porosity {kind} stays"] = is_below(rise, STAYS)
    shown, smallest = grown[_of_figure_6(grown)], grown[np.isclose(grown["nm"], FIGURE_6[0])]
    is_small = np.isclose(shown["nm"], FIGURE_6[0])
    parts = {"": grown, " smallest of all": smallest, " smallest": shown[is_small], " larger": shown[~is_small]}
    for name, part in parts.items():
        share, error, *_ = oblate_share(part.rename(columns=_AS_START), "start")
        found = values[f"g.oblate{name}"] = Measured(100 * share, 100 * error)
        values[f"g.holds oblate{name}"] = is_within(found, 45.0, 55.0)
        values[f"g.round{name}"] = 100.0 * float((part["axis_c"] < ROUND * part["axis_b"]).mean())
    half, fewer = values["g.oblate smallest"], values["g.oblate larger"]
    change = Measured(fewer.value - half.value, math.hypot(fewer.error, half.error))
    values["g.holds oblate larger"] = is_below(change, 0.0)
    ba = grown[(grown["type"] == "BA") & (grown["fractal_dimension"] < 3)]
    values["g.dimension"] = median(ba["fractal_dimension"])
    values["g.holds dimension"] = is_within(values["g.dimension"], 1.9, 2.1)
    known = grown[grown["fractal_dimension"] < 3]
    small, large = (known[np.isclose(known["nm"], size)]["fractal_dimension"] for size in (150, 550))
    change = Measured(large.median() - small.median(), math.hypot(median(large).error, median(small).error))
    values["g.dimension change"], values["g.holds dimension change"] = change, is_above(change, 0.0)
    radius = grown["mean_monomer_radius"] / NM
    values["g.radius"] = Measured(*mean_of(radius, cell_of(grown)))
    # the printed omega goes with the root of the mean radius
    values["g.radius factor"] = math.sqrt(values["g.radius"].value / (PAPER_MEAN_RADIUS / NM))
    values["g.radius range"] = middle(radius)
    values["g.holds radius"] = is_within(values["g.radius"], 18.0, 22.0)
    values |= beside_printed_grains(grown)
    return values


def beside_printed_grains(grown):
    """Least, median and greatest of N_mon, N_con and a_out [nm] of ours beside each grain of Fig. 1, as one text.

    ``g.printed BAM1 wider`` is how many printed BAM1 are wider than all of ours.
    """
    values, wider = {}, 0
    for (kind, size), printed in PRINTED_GRAINS.items():
        own = grown[(grown["type"] == kind) & np.isclose(grown["nm"], size)]
        for name, value in zip(("n_monomers", "n_contacts", "enclosing_radius"), printed, strict=True):
            unit = NM if name == "enclosing_radius" else 1.0
            found = own[name] / unit
            outside = "" if found.min() <= value / unit <= found.max() else ", **outside**"
            text = f"{value / unit:.0f} in {found.min():.0f} to {found.max():.0f} ({found.median():.0f}){outside}"
            values[f"g.printed {kind} {size} {name}"] = text
            wider += kind == "BAM1" and name == "enclosing_radius" and value / unit > found.max()
    return values | {"g.printed BAM1 wider": int(wider)}


def _of_figure_6(table):
    """Which grains are of those that Fig. 6 shows."""
    return (table["material"] == SHOWN) & np.isclose(table["nm"].to_numpy()[:, None], FIGURE_6).any(axis=1)


_AS_START = {f"axis_{axis}": f"axis_{axis}_start" for axis in "abc"}
