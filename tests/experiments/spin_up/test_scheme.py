"""Marks with one thing of the scheme changed, over those of the same grains in the ensemble."""

import pandas as pd
import pytest

from ratd.base.units import NM
from ratd.experiments.spin_up.findings.scheme import of_scheme

CHANGED = {"pace": 0.005, "drive": 1.0, "drag": 0.3}


def made(usual, slow, torque=1.1):
    """Large and small BA, and a BAM1: omega_disr over a quarter as usual and at the slow pace."""
    rows = []
    for kind, size in (("BA", 300), ("BA", 450), ("BA", 100), ("BAM1", 300)):
        for seed in range(5):
            grain = {"material": "q-S", "type": kind, "a_eff": size * NM, "seed": seed}
            quarter = (1.0 + 0.1 * seed) * 1e7
            ratios = {"production": (0.0, 1.0, usual), **{name: (value, 1.0, usual) for name, value in CHANGED.items()}}
            ratios["pace"] = (0.005, 0.9, slow)
            ratios["drive"] = (1.0, torque if kind == "BA" else 1.0, usual)
            for vary, (value, factor, ratio) in ratios.items():
                marks = {"omega_mass_75": factor * quarter, "omega_disr": ratio * factor * quarter}
                rows.append(grain | {"vary": vary, "value": value} | marks)
    # a pace that is not asked for
    rows.append(rows[0] | {"vary": "pace", "value": 0.01, "omega_disr": 1.0})
    return pd.DataFrame(rows)


def test_large_fluffy_grains_are_told_beside_their_usual_run():
    found = of_scheme(made(1.6, 1.0))
    assert found["scheme.slow grains"] == 10
    assert found["scheme.slow quarter"].value == pytest.approx(0.9)
    assert found["scheme.slow disr"].value == pytest.approx(0.9 / 1.6)
    assert [found[f"scheme.slow {when}"].value for when in ("before", "after")] == pytest.approx([1.6, 1.0])
    assert found["scheme.torque quarter"].value == pytest.approx(1.1)
    # 15 of 20 grains hold more under a torque
    assert found["scheme.torque all"].value == pytest.approx(1.1**0.75)
    assert found["scheme.drag disr"].value == pytest.approx(1.0)


def test_grains_that_lose_no_quarter_are_left_out():
    table = made(1.6, 1.0)
    one = (table["seed"] == 4) & (table["a_eff"] > 4e-7) & (table["vary"] == "pace")
    table.loc[one, "omega_mass_75"] = float("nan")
    assert of_scheme(table)["scheme.slow grains"] == 9


@pytest.mark.parametrize(
    ("usual", "slow", "verdict"), [(1.6, 1.5, "no"), (1.0, 1.1, "yes"), (1.6, 1.0, "open"), (1.0, 1.6, "open")]
)
def test_a_verdict_that_hangs_on_the_pace_is_open(usual, slow, verdict):
    assert of_scheme(made(usual, slow))["scheme.holds quarter BA large"] == verdict
