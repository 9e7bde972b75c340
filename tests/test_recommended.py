"""What the document recommends, from made-up grains of which the law is known."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from ratd.reproduction.recommended import BY_TYPE, NAMES, SURE, recommended_section

from ratd.experiments.spin_up.cross_validation import PREDICTORS
from ratd.experiments.spin_up.size_law import SPLIT, size_law_unit
from synthetic_runs import make_table

SIZES = (100e-9, 300e-9, 500e-9)
LAW = {"BA": (0.5, 2.0), "BAM1": (1.25, 1.5), "BAM2": (3.0, 1.25)}


@pytest.fixture(scope="module")
def table():
    """omega_disr twice the omega of the loss of a quarter; 12 grains a cell, 9 of 500 nm."""
    table = make_table(sizes=SIZES, seeds=12)
    table = table[(table["a_eff"] < 400e-9) | (table["seed"] < 9)]
    constant, power = (np.array([LAW[kind][k] for kind in table["type"]]) for k in range(2))
    omega = constant * size_law_unit(table) * (table["a_eff"] / SPLIT) ** -power
    return table.assign(omega_mass_75=omega, omega_disr=2 * omega, cut_bound=omega / 0.8)


def data_of(table, least=BY_TYPE):
    rows = [
        {"type": kind, "predictor": name, "scatter": 0.1 + 0.2 * (name != least), "error": 0.01}
        | {"more": 0.2 * (name != least), "more_error": 0.01}
        for kind in (*LAW, "all") for name in PREDICTORS
    ]  # fmt: skip
    return SimpleNamespace(
        tables={"prescribed": table},
        predictions={"prescribed": {"size": pd.DataFrame(rows)}},
        plan=SimpleNamespace(materials=None),
        study=lambda name: None,
    )


def test_law_and_medians_are_those_of_the_grains(table):
    text = "\n\n".join(recommended_section(data_of(table)))
    for kind, (constant, power) in LAW.items():
        for name, factor in zip(NAMES.values(), (1, 2), strict=True):
            line = next(line for line in text.splitlines() if line.startswith(f"| {name} | {kind} |"))
            assert [float(cell) for cell in line.strip("| ").split(" | ")[2:5]] == [factor * constant, power, 1.0]
        for (material, size), cell in table[table["type"] == kind].groupby(["material", "a_eff"]):
            line = next(line for line in text.splitlines() if line.startswith(f"| {material} | {kind} |"))
            found = line.strip("| ").split(" | ")[2 + [round(a * 1e9) for a in SIZES].index(round(size * 1e9))]
            assert found.endswith("*") == (len(cell) < SURE)
            quarter, peak = found.rstrip("*").rstrip(")").split(" (")
            assert float(quarter) == pytest.approx(cell["omega_mass_75"].median() / 1e6, rel=6e-3)
            assert float(peak) == pytest.approx(2 * cell["omega_mass_75"].median() / 1e6, rel=6e-3)


def test_star_is_explained_where_there_is_one(table):
    legend = f"(*: fewer than {SURE} grains)"
    assert legend in "\n".join(recommended_section(data_of(table)))
    assert legend not in "\n".join(recommended_section(data_of(table[table["a_eff"] < 400e-9])))


def test_cut_bound_is_recommended_where_it_predicts_best(table):
    assert "BA 0.8 and 1.6; BAM1 0.8 and 1.6; BAM2 0.8 and 1.6." in "\n".join(recommended_section(data_of(table)))
    assert "cut bound" not in "\n".join(recommended_section(data_of(table, "power of size")))


def test_without_the_consistent_model_nothing_is_recommended(table):
    data = data_of(table)
    data.tables = {"literal": table}
    assert recommended_section(data) == []
