"""What is printed in Reissl et al. (2024), A&A 692, A60: every number that we compare with, and where it stands.

Tables 1 and 2 stand in `ratd.composition`, Table 3 in `ratd.ensemble`, the error of Fig. 10 in `ratd.figures.figure10`.
All values as printed, converted to SI units. The rules are ours: they say, before anything is compared, when a printed
value or finding counts as held by our grains.
"""

from dataclasses import dataclass, replace

from ratd.ensemble import PAPER_MEAN_RADIUS
from ratd.figures.figure10 import PAPER_ERROR

__all__ = ["ABOUT", "GRAINS", "MOST", "PRINTED", "Printed"]

NEAR, ROUGHLY = "within a quarter", "within a factor of 2"
ABOUT = {"grains": "the grains as grown", "spin-up": "the spin-up", "other": "other numbers of the text"}
"""What the printed values are about; each part is counted by itself."""


@dataclass(frozen=True)
class Printed:
    """One printed value.

    Parameters
    ----------
    place : str
        Section, figure or table.
    what : str
        What it is the value of.
    text : str
        As printed (or said).
    rule : str
        When it holds for our grains, in words; empty where nothing can hold.
    value : float or tuple of float or None
        In SI units; a tuple is a range; None where the paper gives words only.
    about : str
        A key of `ABOUT`.
    setting : float or None
        Value [SI] of the parameter that is varied.
    """

    place: str
    what: str
    text: str
    rule: str
    value: float | tuple | None = None
    about: str = "spin-up"
    setting: float | None = None


GRAINS = {
    # type, a_eff [nm]: N_mon, N_con, a_out [nm]
    ("BA", 200): (160, 162, 543.1),
    ("BA", 350): (521, 521, 882.6),
    ("BA", 500): (1773, 1772, 1385.7),
    ("BAM1", 200): (117, 235, 457.4),
    ("BAM1", 350): (636, 1275, 901.2),
    ("BAM1", 500): (1885, 3774, 1214.7),
    ("BAM2", 200): (157, 475, 320.1),
    ("BAM2", 350): (649, 1950, 603.3),
    ("BAM2", 500): (1814, 5546, 845.2),
}
"""The nine grains of Fig. 1; which material they are of is not printed."""
MOST = (0.025, 0.975)
"""Quantiles between which 95 % of our grains lie, with which those of Fig. 1 are compared."""

_GROWN = {
    "porosity_BA": Printed(
        "Fig. 2, Sect. 8", "porosity, BA", "0.4–0.85", "means of the sizes in it, to a tenth", (0.4, 0.85)
    ),
    "porosity_BAM1": Printed(
        "Fig. 2, Sect. 8", "porosity, BAM1", "0.35–0.7", "means of the sizes in it, to a tenth", (0.35, 0.7)
    ),
    "porosity_BAM2": Printed(
        "Fig. 2, Sect. 8", "porosity, BAM2", "0.35–0.5", "means of the sizes in it, to a tenth", (0.35, 0.5)
    ),
    "porosity_BAM2_text": Printed(
        "Sect. 7.3", "porosity, BAM2", "0.4–0.5", "means of the sizes in it, to a tenth", (0.4, 0.5)
    ),
    "porosity_slope": Printed(
        "Sect. 3, Fig. 2",
        "change of the mean porosity with size",
        "stagnates for larger sizes",
        "less than 0.05 from 300 nm on",
    ),
    "fractal_BA": Printed("Sect. 7.3", "fractal dimension, BA", "about 2.0", NEAR, 2.0),
    "fractal_slope": Printed(
        "Sect. 3, Fig. 2",
        "change of the median fractal dimension with size",
        "“increases slightly towards larger grains”",
        "rises for all types from 300 nm on",
    ),
    "half": Printed("Abstract, Sect. 8", "oblate at rest, all grains", "“50:50”", "0.4–0.6", 0.5),
    "oblate_start_200": Printed("Sect. 7.3, Fig. 6", "oblate at rest, 200 nm", "about half", "0.4–0.6", 0.5),
    "oblate_start_350": Printed("Sect. 7.3, Fig. 6", "oblate at rest, 350 nm", "“slightly more prolate”", "0.3–0.5"),
    "oblate_start_500": Printed("Sect. 7.3, Fig. 6", "oblate at rest, 500 nm", "“slightly more prolate”", "0.3–0.5"),
    "c_over_b": Printed("Sect. 7.3, Fig. 6", "grains with c/b < 1.7 at rest, 350 and 500 nm", "most", "more than half"),
    "compact": Printed(
        "Sect. 8",
        "porosity less that of as many equal monomers, BAM",
        "“more compact and less porous”",
        "below 0 at each size, both types",
    ),
    "deeper": Printed(
        "Sect. 8",
        "rank correlation of a monomer's radius with its distance from the centre of mass, BAM less BA",
        "“smaller monomer tend to migrate deeper”",
        "above 0 at each size, both types",
    ),
    "fractal_shape": Printed(
        "Sect. 7.3, Fig. 2",
        "rank correlation of the fractal dimension with c/a",
        "“not well correlated”",
        "between -0.3 and 0.3, all types",
        0.0,
    ),
}
_OTHER = {
    "mean_radius": Printed("Sect. 3", "average radius of the monomers", "20 nm", NEAR, PAPER_MEAN_RADIUS),
    "deviation": Printed("Sect. 3", "standard deviation of the radii of the monomers", "1.65 nm", NEAR, 1.65e-9),
    "step": Printed(
        "Sect. 6",
        "time step 0.02 min(t_dis), monomers of 10 nm",
        "“only a few ns”",
        "1–5 ns, to a quarter",
        (1e-9, 5e-9),
    ),
    "pairs": Printed(
        "App. A, Fig. 10",
        "greatest error against Eq. 35, undamped pairs",
        f"{100 * PAPER_ERROR:g} %",
        "not above it",
        PAPER_ERROR,
    ),
    "pairs_trend": Printed(
        "App. A",
        "mean of (omega_ref - omega)/omega_ref, undamped pairs",
        "“a trend of underpredicting”",
        "above 0",
    ),
    "pairs_damped": Printed(
        "App. A, Fig. 10",
        "greatest error against Eq. 35, damped pairs",
        f"{100 * PAPER_ERROR:g} %",
        "not above it",
        PAPER_ERROR,
    ),
}
_SPUN_UP = {
    "ensemble": Printed("Sect. 3", "grains of the ensemble", "2970", "", 2970),
    "terminal": Printed("Sect. 7", "grains not disrupted below omega_RAT = 3e10 rad/s", "none", "none", 0),
    "onset": Printed("Sect. 7.1, Fig. 4", "mass constant up to [rad/s], cell of Fig. 4", "3e8", NEAR, 3e8),
    "drag_time": Printed(
        "Sect. 6",
        "d ln omega_disr/d ln(d omega/dt)",
        "the drag time “does not impact the result” as long as forces change slowly enough",
        "all within 0.1 of 0",
        0.0,
    ),
    "decade": Printed(
        "Sect. 7.1, Fig. 4",
        "width of the loss of mass, end over onset, cell of Fig. 4",
        "roughly a factor of 10",
        ROUGHLY,
        10.0,
    ),
    "gain": Printed(
        "Sect. 7.1, Fig. 4",
        "greatest number of contacts over its start, BAM2",
        "exceeds the start for a while",
        "above 1",
    ),
    "gain_most": Printed(
        "Sect. 7.1",
        "greatest number of contacts over its start, BAM2 less the greater of BA and BAM1",
        "“most pronounced for BAM2”",
        "above 0",
    ),
    "stress_rise": Printed(
        "Sect. 7.1, Fig. 4",
        "greatest fall of the stress before its peak, over the peak, cell of Fig. 4",
        "“rises steadily”",
        "below 0.1 in the median",
    ),
    "stress_drop": Printed(
        "Sect. 7.1, Fig. 4",
        "omega at which the stress has fallen to half of its peak over omega_disr, cell of Fig. 4",
        "“drops then abruptly”",
        "below 1.1 in the median",
    ),
    "peak_mass": Printed(
        "Sect. 8",
        "mass lost at omega_disr, the peak of the stress",
        "“roughly coincides with” 25 %",
        "median 0.15–0.35, all types",
        0.25,
    ),
    "abrupt": Printed(
        "Sect. 8",
        "largest piece that leaves at once while the first half of the mass does, over the mass of the grain",
        "not “a single abrupt event” but “continuous mass loss”",
        "median below 0.1, all types",
    ),
    "quarter": Printed(
        "Sect. 7.1, Sect. 8",
        "omega at 25 % mass loss over omega_disr",
        "“close to but not identical”",
        f"all {NEAR}",
        1.0,
    ),
    "whole_01": Printed(
        "Sect. 7.2, Fig. 5",
        "mass of the largest fragment at 0.1 omega_disr, cell of Fig. 4",
        "all monomers connected",
        "1 in the median",
        1.0,
    ),
    "contacts_01": Printed(
        "Sect. 7.2, Fig. 5",
        "contacts at 0.1 omega_disr over their start, cell of Fig. 4",
        "“first connections break”",
        "below 1 in the median",
    ),
    "whole_08": Printed(
        "Sect. 7.2, Fig. 5",
        "mass of the largest fragment at 0.8 omega_disr, cell of Fig. 4",
        "small fragments have left",
        "below 1 in the median",
    ),
    "whole_10": Printed(
        "Sect. 7.2, Fig. 5",
        "mass of the largest fragment at omega_disr, cell of Fig. 4",
        "larger fragments have left",
        "below 0.95 in the median",
    ),
    "reconnect": Printed(
        "Sect. 7.2",
        "share of the changes of the mass of the largest fragment by which it gains, up to omega_disr, cell of Fig. 4",
        "fragments “may rarely reconnect”",
        "below a tenth",
    ),
    "blocks": Printed(
        "Sect. 7.2", "mass share of single monomers in what leaves, BAM", "“almost completely”", "at least 0.8", 1.0
    ),
    "few": Printed(
        "Sect. 8",
        "mass share of fragments of up to 3 monomers in what leaves",
        "“not larger than a few monomers”",
        "at least 0.8",
        1.0,
    ),
    "oblate_disr": Printed("Sect. 7.3, Fig. 6", "oblate at omega_disr, BAM1 and BAM2", "most", "more than half"),
    "oblate_disr_BA": Printed(
        "Sect. 7.3, Fig. 6", "oblate at omega_disr, BA 200 nm", "prolate preferred", "less than half"
    ),
    "more_oblate": Printed(
        "Fig. 6, Sect. 8",
        "share of oblate grains at omega_disr less that at rest, BAM1 and BAM2",
        "“clear tendency … to become oblate”",
        "above 0",
    ),
    "b_over_a": Printed("Sect. 7.3, Fig. 6", "greatest b/a at omega_disr, BAM", "up to 5.0", NEAR, 5.0),
    "b_over_a_BA": Printed(
        "Sect. 7.3, Fig. 6", "median b/a at omega_disr, BA over BAM", "BA “smaller axis ratios”", "below 1"
    ),
    "porosity_change_BA": Printed(
        "Sect. 7.3", "porosity at omega_disr less that at rest, BA", "no increase", "median and mean not above 0", 0.0
    ),
    "porosity_change_BAM": Printed(
        "Sect. 7.3",
        "porosity at omega_disr less that at rest, BAM",
        "slight increase, “at the beginning”",
        "median and mean above 0, both types",
    ),
    "porosity_alike": Printed(
        "Sect. 7.3",
        "mean porosity at omega_disr, BAM1 less BAM2",
        "“virtually identical”",
        "within 0.05 of 0",
        0.0,
    ),
    "variation": Printed(
        "Sect. 7.3",
        "scatter of the porosity within its cell at omega_disr less that at rest, BAM",
        "“a large variation” close to the breaking point",
        "above 0, both types",
    ),
    "easier": Printed(
        "Sect. 7.3",
        "omega_disr of BA over that of BAM1 and of BAM2",
        "BA “break more easily”",
        "below 1, both",
    ),
    "range": Printed(
        "Sect. 7.4, Fig. 7", "omega_disr, all grains [rad/s]", "5e8–5e9", f"both ends {ROUGHLY}", (5e8, 5e9)
    ),
    "order": Printed(
        "Abstract", "order of magnitude of omega_disr [rad/s]", "1e8–1e9", "means of the cells in it", (1e8, 1e9)
    ),
    "flattening": Printed(
        "Abstract, Sect. 8",
        "d ln omega_disr/d ln a_eff above 300 nm",
        "“asymptotic limit”, i.e. 0",
        "all within 0.25 of 0",
        0.0,
    ),
    "match": Printed(
        "Sect. 7.4, Fig. 7",
        "distance of the mean of each size from Eq. 33 fitted to the grains, root mean square",
        "“matches very well”",
        "below 10 %, all types",
    ),
    "exponents": Printed(
        "Sect. 7.4",
        "scatter about Eq. 33 with separate exponents of N_con/N_mon, N_mon and phi, over that with one exponent",
        "“does not improve the accuracy of the fit”",
        "at least 0.95 for a fifth of the grains left out",
        1.0,
    ),
    "withstand": Printed(
        "Abstract",
        "omega_disr over the strength models, greatest size, co-S BAM2",
        "up to a factor of 10",
        f"the greatest {ROUGHLY}",
        10.0,
    ),
    "rolling": Printed(
        "Sect. 7.5, Fig. 9",
        "omega at xi_c = 6.4 nm over that at 0.2 nm, a-C",
        "“small fluctuations but no clear trend”",
        f"all within {100 * PAPER_ERROR:g} % of 1, the accuracy of App. A",
        1.0,
        setting=6.4e-9,
    ),
    "viscous_rise": Printed(
        "Sect. 7.5, Fig. 9",
        "omega at T_vis = 9 ps over that at 1 ps, a-C",
        "“a clear increase”",
        "above 1, both types",
    ),
    "viscous": Printed(
        "Sect. 7.5, Fig. 9",
        "omega at T_vis = 9 ps over that at 5 ps, a-C BAM2",
        "1.11",
        "1.055–1.165, half of the rise either way",
        1.11,
        setting=9e-12,
    ),
}


def _about(values, about):
    return {key: replace(value, about=about) for key, value in values.items()}


PRINTED = _about(_GROWN, "grains") | _SPUN_UP | _about(_OTHER, "other")
"""Key -> what is printed: of the grains, of their spin-up, and other numbers, each part in the order of the paper."""
