"""The rules of omega_disr: the same spin-ups, the mark read with other running medians and other majorities.

`ratd.experiments.spin_up.marks` says what the two rules are for. Nothing is run again for another rule, so that what
differs is the rule alone.
"""

from itertools import product

from ratd.aggregates.growth import grow
from ratd.experiments.spin_up.marks import MAJORITY, MEDIAN_WINDOW, disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

COLUMNS = {
    **GRAIN_COLUMNS,
    "window": ("1", "records in the running median of the stress"),
    "majority": ("1", "part of the mass that the largest fragment must hold where the peak is looked for"),
    "omega_disr": ("rad s-1", "angular velocity of disruption by these rules"),
}
KIND = table_kind("mark_rules", "The mark of disruption by other rules", COLUMNS)


def compute(settings, progress=None):
    """Spin up all grains of one type and size, and read their mark by each rule.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seeds (number); windows, majorities (lists), each varied while the other is that of
        `ratd.experiments.spin_up.marks`.
    progress : callable, optional
        Called with a sentence after each grain.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`; omega_disr is NaN where a rule finds no mark.
    """
    rules = [*product(settings["windows"], [MAJORITY]), *product([MEDIAN_WINDOW], settings["majorities"])]
    rows = []
    for seed in range(settings["seeds"]):
        grain = grow(settings["type"], settings["a_eff"], settings["material"], seed)
        run = spin_up(grain)
        for window, majority in dict.fromkeys([(MEDIAN_WINDOW, MAJORITY), *rules]):
            omega = disruption(run, majority=majority, window=window)["omega_disr"].item()
            rows.append(dict(**grain_values(grain), window=window, majority=majority, omega_disr=omega))
        if progress is not None:
            progress(f"seed {seed}: done")
    return rows
