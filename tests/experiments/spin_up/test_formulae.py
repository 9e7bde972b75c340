"""Single formulae as printed: that they reach the contacts, and what is told of them."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ratd.aggregates.grain import Grain
from ratd.aggregates.growth import grow
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import contact_field, new_state
from ratd.experiments.evolve import evolve
from ratd.experiments.spin_up.contact_law import contact_law, printed_factors, printed_twist
from ratd.experiments.spin_up.figures.formulae import MEDIAN
from ratd.experiments.spin_up.figures.formulae import formulae as figure
from ratd.experiments.spin_up.formulae import (
    FORMULA_COLUMNS,
    FORMULAE,
    formula_effects,
    formula_table,
)
from ratd.experiments.spin_up.plan import load
from ratd.geometry.box import open_space
from ratd.laws.contact_constants import equilibrium_contact_radius
from ratd.laws.jkr_with_springs import INV_ZETA2, K_SLIDE, K_TWIST, PULL_OFF, jkr
from ratd.pipeline import io

NU = MATERIALS["q-S"].poisson_number


def constants(law):
    """Constants of a contact: k_s, 1/zeta_c^2, k_t, F_C."""
    grain = Grain([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9, 20e-9], "q-S")
    state = new_state(grain.position, grain.radius, grain.material, grain.contacts, law, open_space(), leapfrog())
    return np.array([contact_field(state, field)[0] for field in (K_SLIDE, INV_ZETA2, K_TWIST, PULL_OFF)])


@pytest.mark.parametrize("formula", FORMULAE)
def test_one_constant_of_a_contact_is_as_printed_and_no_other(formula):
    """With G* = G/(2 - 2 nu^2) in Eqs. 13 and 17 and zeta_c = r0 (1 - nu)/(16 pi)."""
    material = MATERIALS["q-S"]
    r0 = equilibrium_contact_radius(10e-9, material.surface_energy, material.reduced_modulus)
    printed_modulus = material.shear_modulus / (2 - 2 * NU**2)
    printed = {
        "sliding_stiffness": (0, 8 * r0 * printed_modulus),
        "sliding_limit": (1, (r0 * (1 - NU) / (16 * np.pi)) ** -2),
        "twisting_stiffness": (2, 16 / 3 * printed_modulus * r0**3),
    }
    expected = constants(jkr())
    if formula in printed:
        place, value = printed[formula]
        assert abs(value / expected[place] - 1) > 0.02
        expected[place] = value
    np.testing.assert_allclose(constants(jkr(**printed_factors(formula, NU))), expected, rtol=1e-12)


def test_by_the_printed_sign_of_a_twist_two_monomers_turn_against_each_other_ever_faster():
    material = MATERIALS["q-S"]
    stiffness = printed_factors("twisting_stiffness", NU)["twisting_stiffness"]
    plus = jkr(damping="none")._replace(twisting_stiffness=-stiffness)
    spin = [[0, 0, 1e4], [0, 0, -1e4]]
    pair = Grain([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9, 20e-9], "q-S")
    options = {"contacts": pair.contacts, "duration": 10e-9, "balance": None}
    run = evolve(pair.position, pair.radius, spin=spin, material="q-S", law=plus, **options)
    inertia = 0.4 * material.density * 4 / 3 * np.pi * 20e-9**5
    apart = 2 * np.sqrt(run["kinetic_spin"] / inertia)
    assert apart[-1] > 1e5 * apart[0]
    late = apart[-20:].diff("record") / run["time"][-20:].diff("record")
    np.testing.assert_allclose(late, printed_twist(20e-9, material), rtol=1e-3)
    used = evolve(pair.position, pair.radius, spin=spin, material="q-S", law=jkr(), **options)
    assert abs(used["spin"]).max() < 1.01e4


def test_by_the_printed_sign_of_a_twist_a_grain_of_single_contacts_comes_apart_by_itself():
    """As the appendix of the reproduction says: BA within 50 ns; three contacts a monomer hold BAM2 together."""
    law = contact_law({"formulae": "printed"}, NU)
    plus = law._replace(twisting_stiffness=-law.twisting_stiffness)
    pieces = {}
    for kind in ("BA", "BAM2"):
        grain = grow(kind, 100e-9, "q-S", 0)
        spin = 1e3 * np.random.default_rng(0).normal(size=(grain.n_monomers, 3))
        options = {"contacts": grain.contacts, "duration": 50e-9, "balance": None, "material": "q-S"}
        run = evolve(grain.position, grain.radius, spin=spin, law=plus, **options)
        pieces[kind] = len(np.unique(run["piece"]))
    assert pieces["BA"] > 5 and pieces["BAM2"] == 1


def test_the_law_of_the_paper_has_all_formulae_as_printed_and_no_damping():
    law = contact_law({"formulae": "printed"}, NU)
    one_by_one = {name: jkr(**printed_factors(name, NU)) for name in FORMULAE}
    expected = constants(jkr())
    for place, name in enumerate(("sliding_stiffness", "sliding_limit", "twisting_stiffness")):
        assert abs(constants(one_by_one[name])[place] / expected[place] - 1) > 0.02
        expected[place] = constants(one_by_one[name])[place]
    np.testing.assert_array_equal(constants(law), expected)
    assert law.damping == jkr(damping="none").damping and law.normal_force == jkr().normal_force


def test_a_law_in_words():
    assert contact_law(None, NU) is None
    assert contact_law({"normal_force": "DMT"}, NU) == jkr(normal_force="DMT")
    both = contact_law({"normal_force": "DMT", "formulae": "printed"}, NU)
    assert both == contact_law({"formulae": "printed"}, NU)._replace(normal_force=jkr(normal_force="DMT").normal_force)


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
    drawn = figure(both)
    (legend,) = drawn.legends
    assert {"100 nm", "200 nm"} < {text.get_text() for text in legend.texts}
    faces = {line.get_markerfacecolor(): line.get_xdata() for line in drawn.axes[0].get_lines() if marked(line, "o")}
    np.testing.assert_allclose(faces.pop("white"), [0.9] * 3)
    ((larger,),) = faces.values()
    assert larger == pytest.approx(1.2)


def marked(line, markers):
    return line.get_marker() in markers and len(line.get_xdata()) > 0


def test_the_figure_shows_every_grain_and_says_how_few_they_are(table):
    drawn = figure(table)
    axes = drawn.axes[0]
    assert "6 q-S grains, 3 of each type and size" in drawn.get_suptitle()
    points = np.concatenate([line.get_xdata() for line in axes.get_lines() if marked(line, "os^")])
    np.testing.assert_allclose(sorted(points), [0.8] * 3 + [0.9] * 3)
    medians = [line.get_xdata()[0] for line in axes.get_lines() if line.get_linewidth() == MEDIAN["lw"]]
    np.testing.assert_allclose(sorted(medians), [0.8, 0.9])
    with pytest.raises(InputError, match="at least one run"):
        figure(table[table["formula"] == "consistent"])
