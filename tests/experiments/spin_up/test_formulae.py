"""Single formulae as printed: that they reach the contacts, and what is told of them."""

import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ratd.base.errors import InputError
from ratd.experiments.spin_up.figures.formulae import formulae as figure
from ratd.experiments.spin_up.formula_table import FORMULA_COLUMNS, FORMULAE, formula_effects, formula_table
from ratd.experiments.spin_up.formulae import use
from ratd.experiments.spin_up.plan import load
from ratd.pipeline import io

NU = 0.17
CONSTANTS = """
import sys
from ratd.experiments.spin_up.formulae import use
use(sys.argv[1], 0.17)
from ratd.engine.layout import INV_ZETA2, K_SLIDE, K_TWIST, PULL_OFF
from ratd.engine.state import contact_field, new_state
from ratd.aggregates.grain import Grain
grain = Grain([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9, 20e-9], "q-S")
state = new_state(grain.position, grain.radius, grain.material, grain.contacts, timestep_factor=0.1)
print(*(repr(float(contact_field(state, field)[0])) for field in (K_SLIDE, INV_ZETA2, K_TWIST, PULL_OFF)))
"""


@pytest.fixture(scope="module")
def constants():
    """Formula -> constants of a contact in a process that uses it: k_s, 1/zeta_c^2, k_t, F_C."""
    found = {}
    for formula in ("consistent", "sliding_stiffness", "sliding_limit", "twisting_stiffness"):
        done = subprocess.run([sys.executable, "-c", CONSTANTS, formula], capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr
        found[formula] = np.array([float(word) for word in done.stdout.split()])
    return found


@pytest.mark.parametrize(
    ("formula", "place", "ratio"),
    [
        # G/(2 - 2 nu^2) over G/(2 (2 - nu)); (1 - nu) over (2 - nu), squared and inverse; 2 G/(2 - 2 nu^2) over G
        ("sliding_stiffness", 0, (2 - NU) / (1 - NU**2)),
        ("sliding_limit", 1, ((2 - NU) / (1 - NU)) ** 2),
        ("twisting_stiffness", 2, 1 / (1 - NU**2)),
    ],
)
def test_one_constant_of_a_contact_is_as_printed_and_no_other(constants, formula, place, ratio):
    expected = np.ones(4)
    expected[place] = ratio
    np.testing.assert_allclose(constants[formula] / constants["consistent"], expected, rtol=1e-12)


def test_a_formula_is_refused_once_the_engine_is_loaded():
    import ratd.engine.contacts  # noqa: F401

    with pytest.raises(RuntimeError, match="engine is loaded already"):
        use("sliding_limit", NU)


def test_only_the_run_without_damping_has_another_material():
    plan = load("config/config.yaml", "config/spin_up.yaml")
    assert plan.formulae == list(FORMULAE)
    changed = {formula: plan.formula_runs(formula)[0]["changed"] for formula in FORMULAE}
    assert {name for name, value in changed.items() if value} == {"damping"}
    assert changed["damping"] == {"viscous_time": 0.0}
    assert [(run["grain"]["type"], run["grain"]["a_eff"]) for run in plan.formula_runs("damping")] == [
        (kind, pytest.approx(float(size) * 1e-9)) for kind, size in plan.formula_cells
    ]
    same = {formula: [dict(run, changed={}) for run in plan.formula_runs(formula)] for formula in FORMULAE}
    assert all(same[formula] == same["consistent"] for formula in FORMULAE)


def made_up(formula, kind, seed, omega, a_eff=1e-7):
    attributes = {"material": "q-S", "type": kind, "drive": "prescribed", "a_eff": a_eff, "seed": seed}
    return formula, [xr.Dataset({"omega_disr": omega, "omega_mass_75": 2 * omega}, attrs=attributes)]


@pytest.fixture
def table():
    grains = [(kind, seed) for kind in ("BA", "BAM2") for seed in range(3)]
    own = [made_up("consistent", kind, seed, 1e8 + seed) for kind, seed in grains]
    other = [made_up("damping", kind, seed, (1e8 + seed) * (0.9 if kind == "BA" else 0.8)) for kind, seed in grains]
    return formula_table(own + other)


def test_effects_are_medians_over_the_same_grains(table, tmp_path):
    found = formula_effects(table, "omega_disr").set_index("type")
    assert set(found["formula"]) == {"damping"}
    np.testing.assert_allclose(found.loc[["BA", "BAM2", "all"], "median"], [0.9, 0.8, 0.85])
    assert list(found.loc[["BA", "all"], "n"]) == [3, 6]
    io.write(tmp_path / "a.nc", table.rename_axis("entry").to_xarray().drop_vars("entry"), "formulae")
    back = io.read(tmp_path / "a.nc", "formulae").to_dataframe()
    assert (back[list(FORMULA_COLUMNS)].to_numpy() == table.to_numpy()).all()


def test_a_grain_without_its_consistent_run_is_named():
    with pytest.raises(InputError, match="q-S, BA, .* was not spun up with the consistent model"):
        formula_table([made_up("damping", "BA", 0, 1e8)])


def test_effects_of_one_size_are_told_apart_from_those_of_another(table):
    larger = [made_up("consistent", "BA", 0, 1e8, 2e-7), made_up("damping", "BA", 0, 1.2e8, 2e-7)]
    both = pd.concat([table, formula_table(larger)])
    both["a_eff"] *= 1 + 1e-15 * np.arange(len(both))  # as from the sum of their monomers
    found = formula_effects(both, "omega_disr").set_index(["nm", "type"])["median"]
    assert found[100, "BA"] == pytest.approx(0.9) and found[200, "BA"] == found[200, "all"] == pytest.approx(1.2)
    rows = [axes.get_title() for axes in figure(both).axes]
    assert len(rows) == 4 and sum("100 nm" in row for row in rows) == sum("200 nm" in row for row in rows) == 2


def test_the_figure_shows_every_type_and_all(table):
    axes = figure(table).axes[0]
    points = [line.get_xdata()[0] for line in axes.get_lines() if line.get_marker() in "os^D"]
    np.testing.assert_allclose(sorted(points), [0.8, 0.85, 0.9])
    with pytest.raises(InputError, match="at least one run"):
        figure(table[table["formula"] == "consistent"])
