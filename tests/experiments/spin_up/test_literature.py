"""Tensile strengths of the literature and the porosity at the break, beside made-up grains that follow them."""

import numpy as np
import pandas as pd
import pytest

from ratd.base.materials import get_material
from ratd.experiments.spin_up.findings.literature import needed_strength, of_literature
from ratd.experiments.spin_up.tensile import eq27, tensile_strength_greenberg1995

SIZES = (100, 300, 550)


@pytest.fixture(scope="module")
def grains():
    """Three grains a cell, whose omega is that of Greenberg's strength, and half of it at the largest size of BAM2."""
    rows = []
    for material in ("a-C", "q-S", "co-S"):
        density = get_material(material).density
        for kind, contacts in (("BA", 1.0), ("BAM1", 2.0), ("BAM2", 3.0)):
            for nm in SIZES:
                phi = 0.4 * (nm / 100.0) ** -0.5
                strength = tensile_strength_greenberg1995(contacts, phi, 1e-19, 30e-9, 1e-10)
                omega = eq27(nm * 1e-9, strength, density)
                for seed in range(3):
                    n = 50 * nm
                    rows.append(
                        {
                            "material": material, "type": kind, "a_eff": nm * 1e-9, "nm": float(nm), "seed": seed,
                            "n_monomers": n, "n_contacts": contacts * n, "filling_factor": phi, "porosity": 1.0 - phi,
                            "fractal_dimension": 2.5, "mean_monomer_radius": 30e-9,
                            "omega_disr": omega * (0.5 if (kind, nm) == ("BAM2", 550) else 1.0), "printed": 2.0 * omega,
                            "porosity_start": 0.6, "porosity_disr": 0.6 + 0.01 * seed if kind == "BAM1" else np.nan,
                        }
                    )  # fmt: skip
    return pd.DataFrame(rows)


def test_the_needed_strength_gives_the_omega_back():
    strength = needed_strength(np.array([1e-7, 5e-7]), np.array([1e8, 2e7]), 2000.0)
    np.testing.assert_allclose(eq27([1e-7, 5e-7], strength, 2000.0), [1e8, 2e7])
    np.testing.assert_allclose(strength, 2000.0 * 25.0)


def test_a_strength_that_the_grains_follow_is_told_apart(grains):
    values = of_literature(grains, grains)
    assert values["literature.BA G95"].value == pytest.approx(1.0)
    assert values["literature.BAM2 G95"].value == pytest.approx(2.0)
    # phi^1.6 falls faster than phi, and phi falls with size
    assert values["literature.BA S13 low"].value == pytest.approx((550 / 100) ** (-0.5 * 0.6 / 2))
    strength = tensile_strength_greenberg1995(2.0, 0.4, 1e-19, 30e-9, 1e-10)
    assert values["literature.BAM1 100 S"].value == pytest.approx(strength / 1e3)
    assert values["literature.BAM1 100 S printed"].value == pytest.approx(4.0 * strength / 1e6)


def test_the_verdict_on_powers_of_the_filling_factor_can_be_another(grains):
    assert of_literature(grains, grains)["literature.powers"] == "not all too slowly"
    largest = grains["nm"] == 550
    weak = grains.assign(omega_disr=grains["omega_disr"].where(~largest, 0.3 * grains["omega_disr"]))
    # a scatter of the materials, so that there is an error
    weak["omega_disr"] *= 1.0 + 0.01 * (weak["material"] == "a-C") * largest
    assert of_literature(weak, weak)["literature.powers"] == "too slowly"


def test_porosity_is_compared_grain_by_grain(grains):
    values = of_literature(grains, grains)
    assert values["literature.BAM1 porosity start"].value == pytest.approx(60.0)
    assert values["literature.BAM1 porosity change"].value == pytest.approx(1.0)
    assert 0.0 < values["literature.BAM1 porosity change"].error < 0.5
