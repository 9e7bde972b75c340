"""omega_disr by other rules: what the document tells, from a table that is known."""

import numpy as np
import pandas as pd
import pytest

from ratd.experiments.spin_up.findings.mark_rules import of_mark_rules


def test_what_rules_change_is_found_in_a_table_that_is_known():
    """Without a median all marks lie 20 % higher with some scatter; a lower majority adds half a power of size.

    Sizes that differ in the last digit alone are one: all sizes count alike.
    """
    rng, rows = np.random.default_rng(0), []
    for kind in ("BA", "BAM1", "BAM2"):
        for a_eff in (100e-9, 300e-9, 400e-9, 550e-9):
            for seed in range(20):
                usual = 1e9 * rng.uniform(0.5, 2.0)
                size = a_eff * (1.0 + 4e-16 * (seed % 2 and a_eff < 200e-9))
                for window, majority, factor in (
                    (5, 0.5, 1.0),
                    (1, 0.5, 1.2 * np.exp(0.01 * rng.normal())),
                    (5, 0.25, np.sqrt(a_eff / 300e-9)),
                    (9, 0.5, 1.0 if seed else np.nan),
                ):
                    row = {"type": kind, "a_eff": size, "seed": seed, "window": window, "majority": majority}
                    rows.append({"material": "q-S", **row, "omega_disr": factor * usual})
    found = of_mark_rules(pd.DataFrame(rows))
    assert found["rules.grains"] == 240 and found["rules.most moved"] == 1.0
    for kind in ("BA", "BAM1", "BAM2"):
        value, error = found[f"rules.1 0.5 {kind}"]
        assert value == pytest.approx(1.2, abs=4 * error) and error == pytest.approx(1.2 * 0.01 / np.sqrt(80), rel=0.3)
        assert found[f"rules.1 0.5 {kind} moved"] == 1.0
        power, error = found[f"rules.1 0.5 {kind} power"]
        assert abs(power) < 4 * error < 0.05
        assert found[f"rules.5 0.25 {kind} power"].value == pytest.approx(0.5)
        mean = (100e-9 * 300e-9 * 400e-9 * 550e-9) ** 0.125 / 300e-9**0.5
        assert found[f"rules.5 0.25 {kind}"].value == pytest.approx(mean)
        # sizes of 100, 400 and 550 nm
        assert found[f"rules.5 0.25 {kind} moved"] == 0.75
        # a grain without a mark by one of the rules does not count
        assert found[f"rules.9 0.5 {kind}"].value == 1.0 and found[f"rules.9 0.5 {kind} moved"] == 0.0
    assert found["rules.farthest power"] == pytest.approx(0.5)
