"""Words on which sentences of docs/compression.md rest, from its numbers."""

import math

from scipy.stats import t as student

from ratd.experiments.compression.losses import WAYS
from ratd.experiments.compression.pairs import BY_SIZE, HIGH, SLOW_RATES, beside

__all__ = ["below", "half_width", "verdicts"]


def verdicts(values, sets):
    """Words on which sentences of the document rest."""
    found = {}
    for name, phi in ((BY_SIZE[-1], 0.03), (BY_SIZE[-1], 0.1), (HIGH, 0.3)):
        if f"{name}.ratio_{phi:g}" in values:
            ratio = values[f"{name}.ratio_{phi:g}"].value
            found[f"line_{phi:g}"] = "on" if abs(ratio - 1.0) < 0.25 else "below" if ratio < 1.0 else "above"
    exponents = [values[f"{name}.exponent"] for name in ("base", BY_SIZE[-1]) if f"{name}.exponent" in values]
    words = {_beside_3(exponent) for exponent in exponents}
    found["exponent"] = words.pop() if len(words) == 1 else "differs"
    for name, phi in (("base", 0.1), (HIGH, 0.48)):
        if f"{name}.rolling_{phi:g}" in values:
            found[f"leader_{phi:g}"] = max(WAYS[:3], key=lambda way: values[f"{name}.{way}_{phi:g}"].value)
    if "silicate.rolling_0.48" in values:
        found["leader_silicate"] = max(WAYS[:3], key=lambda way: values[f"silicate.{way}_0.48"].value)
    for name in sets:
        other = beside(name)
        if name != other and {f"{name}.ratio", f"{other}.ratio"} <= set(values):
            found[f"{name}.same"] = "agrees" if _same(values, name, other) else "differs"
    if "xi_p48_32" in values:
        alike = max(abs(values[f"xi_p48_{name}"].value - 1.0) for name in ("8", "32")) < 0.4
        found["high_density"] = "hardly depends" if alike else "depends"
    if "explicit_k_n_0.paired" in values:
        n, ratio, steeper = (values[f"explicit_k_n_0.{name}"] for name in ("n", "paired", "paired_exponent"))
        found["undamped_pressure"] = "certain" if below(ratio, n) else "not certain"
        found["undamped_exponent"] = "certain" if steeper.value + half_width(steeper, n) < 0.0 else "not certain"
    if "slow_16384.over_0.03" in values:
        n = values["slow_16384.n"]
        late = values["slow_16384.over_0.03"]
        early = [values[f"slow_16384.{what}_0.005"] for what in ("over", "ratio")]
        found["slow_early"] = "less" if all(below(own, n) for own in early) else "as much"
        found["slow_line"] = "below" if below(values["slow_16384.ratio_0.01"], n) else "not below"
        for phi in (0.01, 0.02):
            both = [values[f"slow_16384.{over}_{phi}"] for over in ("over", "over_all")]
            sure = all(below(own, n) for own in both)
            found[f"slow_{phi}"] = "show" if sure else "suggest" if both[0].value < 1.0 else "deny"
        found["slow_0.03"] = _alike([late])
        steeper = values["slow_16384.steeper_low"]
        found["slow_steeper"] = "more" if steeper.value > half_width(steeper, n) else "no more"
    if "slow_16384.over_next_0.01" in values:
        found["loose_line"] = "below" if below(values["loose_16384.ratio_0.005"], values["loose_16384.n"]) else "on"
        over = [values[f"slow_16384.over_next_{phi:g}"] for phi in (0.005, 0.01)]
        found["slow_enough"] = _alike(over)
    copies = [own for name, own in values.items() if name.startswith("copies_4096.over_others_")]
    if copies:
        found["copies_mean"] = _alike(copies)
    if "short_16384.over_0.01" in values:
        off = max(abs(values[f"short_16384.over_{phi}"].value - 1.0) for phi in (0.005, 0.01))
        found["short_steps"] = "less than a tenth" if off < 0.1 else "a tenth or more"
    if {"slow_65536.ratio_0.005", "slow_16384.ratio_0.005"} <= set(values):
        alike = [
            abs(values[f"slow_65536.ratio_{phi:g}"].value - own.value) < 2.0 * own.error
            for phi, own in ((phi, values[f"slow_16384.ratio_{phi:g}"]) for phi in (0.005, 0.01))
        ]
        found["slow_size"] = "not the reason" if all(alike) else "a reason"
    slow = [values[f"rate_{rate}.paired"].value for rate in SLOW_RATES if f"rate_{rate}.paired" in values]
    sizes = [f"{name}.over_larger_{phi:g}" for name in BY_SIZE[:-1] for phi in (0.03, 0.05)]
    if slow and set(sizes) <= set(values):
        most = max(abs(ratio - 1.0) for ratio in [*slow, *(values[name].value for name in sizes)])
        found["steady"] = "some 15 %" if most < 0.16 else "more"
    friction = [own.value for name, own in values.items() if name.startswith("springs.friction_")]
    if friction:
        found["springs_back"] = "elastic" if max(friction) < 0.1 else "not elastic"
    at_02 = [f"{name}.ratio_0.2" for name in ("xi_32", HIGH, "xi_2", "silicate_16384")]
    if set(at_02) <= set(values):
        much, some, *little = (values[name].value for name in at_02)
        found["twisting_0.2"] = "the more" if much < some < min(little) else "no more"
    at_300 = [values[name] for name in ("silicate_16384.phi_300", "silicate.phi_300") if name in values]
    if at_300:
        found["silicate_300"] = "agrees" if all(abs(own.value - 0.24) < 0.02 for own in at_300) else "differs"
    return found


def _alike(ratios):
    """Whether pressures are the same, from their ratios: all within two errors of 1."""
    return "the same" if all(abs(own.value - 1.0) < 2.0 * own.error for own in ratios) else "another"


def half_width(own, n):
    """Half the width of the range that holds a mean of `n` clusters in 19 cases of 20 (Student's t)."""
    return student.ppf(0.975, n - 1) * own.error


def below(own, n):
    """Whether a ratio of `n` clusters is surely below 1."""
    return own.value + half_width(own, n) < 1.0


def _beside_3(exponent):
    """Where an exponent lies beside the printed one."""
    steeper = exponent.value - 3.0
    return "is 3" if abs(steeper) < 2.0 * exponent.error else "above 3" if steeper > 0.0 else "below 3"


def _same(values, name, beside):
    """Whether the mean ratio in the range of the fit is that of another set, within 15 % and two errors."""
    own, other = values[f"{name}.ratio"], values[f"{beside}.ratio"]
    return abs(own.value - other.value) < max(0.15, 2.0 * math.hypot(own.error, other.error))
