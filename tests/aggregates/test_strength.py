"""Strengths that others have fitted: the numbers that their papers name."""

import numpy as np
import pytest

import ratd
from ratd.aggregates.radii import RadiusDistribution, lognormal_radii
from ratd.aggregates.strength import (
    compressive_strength_kataoka2013,
    compressive_strength_tatsuuma2023,
    filling_factor_guettler2009,
    midplane_tension,
    power_kataoka2013,
    power_tatsuuma2023,
    rolling_pressure,
    sound_speed_kataoka2013,
    tensile_strength_tatsuuma2019,
)

ICE, SILICATE = ratd.MATERIALS["ice"], ratd.MATERIALS["silicate"]


def test_the_powers_are_those_of_the_laws():
    """Of D = 2 the printed third power; of the law with a greatest filling factor the numerical derivative."""
    assert power_kataoka2013(2.0) == 3.0 and power_kataoka2013(1.5) == 2.0
    for phi, end in ((0.1, 0.74), (0.4, 0.65)):
        around = phi * np.exp([-1e-5, 1e-5])
        slope = np.diff(np.log(compressive_strength_tatsuuma2023(around, 1.0, end)))[0] / 2e-5
        assert power_tatsuuma2023(phi, end) == pytest.approx(slope, rel=1e-6)


def test_p_0_is_that_of_the_paper():
    ice = rolling_pressure(ICE.surface_energy, ICE.critical_rolling_displacement, 1e-7)
    silicate = rolling_pressure(SILICATE.surface_energy, SILICATE.critical_rolling_displacement, 6e-7)
    assert ice == pytest.approx(4.74e5, rel=1e-3)
    assert silicate * (6e-7) ** 3 == pytest.approx(1.42e-15, rel=2e-3)
    assert compressive_strength_kataoka2013(0.24, silicate) == pytest.approx(91.0, rel=0.01)
    assert compressive_strength_tatsuuma2023(0.24, silicate) == pytest.approx(295.0, rel=0.01)
    assert sound_speed_kataoka2013(1.0, ice, ICE.density) == pytest.approx(10.6, abs=0.05)
    assert sound_speed_kataoka2013(0.01, silicate, SILICATE.density) == pytest.approx(0.77e-2, rel=0.01)


def test_the_tensile_strength_is_that_of_the_paper():
    """9.51 kPa (phi/0.1)^1.8 for ice of 0.1 um, gamma = 0.1 J m-2."""
    assert tensile_strength_tatsuuma2019(0.1, 1e-7, 0.1) == pytest.approx(9.51e3, rel=1e-3)
    assert tensile_strength_tatsuuma2019(0.1, 1e-7, 0.2) == pytest.approx(9.51e3 * 2**1.8, rel=1e-3)


def test_the_tension_is_the_pull_of_half_of_a_porous_sphere():
    """Of 2/3 pi rho phi a^3, whose centre of mass is 3/8 a from the axis, over pi a^2."""
    pull = 2 / 3 * np.pi * 3000.0 * 0.5 * 1e-18 * 3 / 8 * 1e-6 * 1e8**2
    assert midplane_tension(1e8, 3000.0, 0.5, 1e-6) == pytest.approx(pull / (np.pi * 1e-12))


def test_the_laws_agree_at_low_filling_factors():
    phi = np.array([1e-4, 1e-3])
    assert compressive_strength_tatsuuma2023(phi, 2.0) == pytest.approx(
        compressive_strength_kataoka2013(phi, 2.0), rel=0.01
    )


def test_the_dust_cakes_reach_both_of_their_filling_factors():
    assert filling_factor_guettler2009([1e-9, 1e15]) == pytest.approx([0.12, 0.58], abs=1e-3)
    assert filling_factor_guettler2009(300.0) == pytest.approx(0.146, abs=1e-3)


def test_lognormal_radii_are_the_quantiles_of_the_cut_distribution():
    own = RadiusDistribution(80e-9, 0.5, 30e-9, 300e-9)
    radii = lognormal_radii((np.arange(4000) + 0.5) / 4000, own)
    assert (np.diff(radii) > 0.0).all() and radii[0] > 30e-9 and radii[-1] < 300e-9
    for k in (1, 3):
        assert np.mean(radii**k) == pytest.approx(own.moment(k), rel=1e-3)
