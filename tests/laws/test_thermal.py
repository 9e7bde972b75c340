"""Thermal breaking: barriers against quadrature of the force laws, limits, and the numbers of a referee."""

import math

import numpy as np
import pytest
from scipy.constants import Boltzmann, electron_volt
from scipy.integrate import quad
from scipy.optimize import brentq

from ratd.base.errors import InputError
from ratd.laws.johnson_kendall_roberts import COMPRESSION_END, S_END, compression_of, normal_force
from ratd.laws.thermal import (
    HOUR,
    attempt_frequency,
    contact_barriers,
    dmt_barrier,
    jkr_barrier,
    life_temperature,
    mean_life,
    pull_off_share,
    table,
)

LOADS = [0.0, 0.1, 0.5, 5 / 9, 0.6, 0.9, 0.99]


def pull_of(compression):
    """Pull of a JKR contact over F_C at a compression over delta_0, from the law itself."""
    s = brentq(lambda s: compression_of(s) - compression, S_END, 2.0, xtol=1e-15)
    return -normal_force(s, 1.0)


@pytest.mark.parametrize("load", LOADS)
def test_barrier_of_jkr_is_the_work_beyond_the_pull(load):
    """The pull of the contact less that from outside, over the way from where both are equal until they are again."""
    top = -0.3968502629920499  # where the contact pulls most
    start = brentq(lambda d: pull_of(d) - load, top, 1.5, xtol=1e-14)
    end = COMPRESSION_END
    if load > pull_of(COMPRESSION_END + 1e-9):
        end = brentq(lambda d: pull_of(d) - load, COMPRESSION_END + 1e-9, top, xtol=1e-14)
    work, _ = quad(lambda d: pull_of(d) - load, end, start, points=[top], epsabs=1e-9, limit=200)
    assert jkr_barrier(load, 1.0, 1.0) == pytest.approx(work, rel=1e-6)
    assert jkr_barrier(load, 3e-9, 5e-11) / 1.5e-19 == pytest.approx(work, rel=1e-6)


@pytest.mark.parametrize("reach", [0.0, 3.0])
@pytest.mark.parametrize("load", LOADS[1:])
def test_barrier_of_dmt_is_the_work_beyond_the_pull(load, reach):
    """F_a = 1, delta_eq = 1: the force is delta^(3/2) - 1 in contact, and the adhesion alone outside."""

    def pull(distance):
        if distance <= 0.0:
            return 1.0 - (-distance) ** 1.5
        return (reach / (reach + distance)) ** 2 if reach else 0.0

    start = brentq(lambda d: pull(d) - load, -1.0, 0.0)
    end = brentq(lambda d: pull(d) - load, 0.0, 100.0) if reach else 0.0
    work, _ = quad(lambda d: pull(d) - load, start, end, points=[0.0], epsabs=1e-10)
    assert dmt_barrier(load, 1.0, 1.0, reach) == pytest.approx(work, rel=1e-6)


def test_barriers_without_a_load():
    """DMT: E_break of Umstaetter & Urbassek (2020), Eq. 2, and all of the attraction of two rigid spheres."""
    assert jkr_barrier(0.0, 1.0, 1.0) == pytest.approx(1.2734, abs=1e-4)
    assert dmt_barrier(0.0, 2.0, 3.0) == pytest.approx(0.6 * 2.0 * 3.0)
    assert dmt_barrier(0.0, 2.0, 0.0, 3.0) == pytest.approx(2.0 * 3.0)


@pytest.mark.parametrize(
    ("barrier_of", "exponent", "factor"),
    [
        (lambda load: jkr_barrier(load, 1.0, 1.0), 1.5, 8 / 9 * 2 ** (2 / 3)),
        (lambda load: dmt_barrier(load, 1.0, 1.0), 5 / 3, 0.6),
        (lambda load: dmt_barrier(load, 1.0, 0.0, 1.0), 2.0, 0.25),
    ],
)
def test_how_a_barrier_vanishes_towards_the_greatest_pull(barrier_of, exponent, factor):
    left = np.array([1e-4, 1e-5])
    barrier = barrier_of(1.0 - left)
    assert np.log(barrier[0] / barrier[1]) / np.log(10) == pytest.approx(exponent, abs=1e-3)
    assert barrier[1] == pytest.approx(factor * left[1] ** exponent, rel=2e-3)
    assert barrier_of(1.0) == pytest.approx(0.0, abs=1e-15)
    many = barrier_of(np.linspace(0.0, 1.0, 1001))
    assert (np.diff(many) < 0.0).all()


def test_numbers_of_the_referee():
    """q-S, equal spheres of 10 nm: 0.32 eV, 37 kT at 100 K, 12 kT at 300 K."""
    barrier = contact_barriers("q-S", 10e-9)["JKR"][0](0.0)
    assert barrier / electron_volt == pytest.approx(0.32, abs=0.005)
    assert barrier / (Boltzmann * 100.0) == pytest.approx(37, abs=0.5)
    assert barrier / (Boltzmann * 300.0) == pytest.approx(12, abs=0.5)


def test_life():
    """A barrier of no height: each attempt counts. Strong damping slows by 2 zeta, as Kramers found."""
    frequency = attempt_frequency(4.0 * math.pi**2, 1.0)
    assert frequency == pytest.approx(1.0)
    assert mean_life(0.0, 10.0, 7.0) == pytest.approx(1.0 / 7.0)
    assert mean_life(Boltzmann * 20.0, 10.0, 7.0) == pytest.approx(math.exp(2.0) / 7.0)
    assert mean_life(0.0, 10.0, 7.0, damping_ratio=50.0) == pytest.approx(100.0 / 7.0, rel=1e-3)
    temperature = life_temperature(3e-20, 1e10, 5.0)
    assert mean_life(3e-20, temperature, 1e10) == pytest.approx(5.0)


def test_pull_that_holds_for_a_time():
    for barrier_of, frequency in contact_barriers("a-C", 30e-9).values():
        share = pull_off_share(barrier_of, 300.0, frequency, HOUR)
        assert 0.0 < share < 1.0
        assert mean_life(barrier_of(share), 300.0, frequency) == pytest.approx(HOUR, rel=1e-6)
        assert pull_off_share(barrier_of, 1e-3, frequency, HOUR) == pytest.approx(1.0, abs=1e-3)
        # at the temperature at which the contact lives so long by itself it holds nothing
        limit = life_temperature(barrier_of(0.0), frequency, HOUR)
        assert pull_off_share(barrier_of, limit * (1 + 1e-9), frequency, HOUR) == 0.0
        assert pull_off_share(barrier_of, limit * 0.99, frequency, HOUR) > 0.0


def test_table_has_every_case_once():
    found = table(materials=["q-S"], radii=[10e-9, 100e-9], temperatures=[20.0, 300.0])
    assert len(found) == 12 and not found.duplicated(["material", "law", "radius", "temperature"]).any()
    case = found.set_index(["law", "radius", "temperature"])
    assert case["barrier_kT"]["JKR", 10e-9, 300.0] == pytest.approx(12.3, abs=0.1)
    # life without a load: the JKR contact of 10 nm is gone at once in the warm, and with forces that reach it stays
    assert case["life"]["JKR", 10e-9, 300.0] < 1e-3 and case["pull_off"]["JKR", 10e-9, 300.0] == 0.0
    assert case["life"]["DMT with reach", 10e-9, 300.0] > HOUR
    np.testing.assert_allclose(case["omega"] ** 2, case["pull_off"])
    # barriers grow as gamma^(5/3) R^(4/3)/E^(2/3)
    barrier = case["barrier_eV"]
    assert barrier["JKR", 100e-9, 20.0] / barrier["JKR", 10e-9, 20.0] == pytest.approx(10 ** (4 / 3))


@pytest.mark.parametrize("load", [-0.1, 1.1, float("nan")])
def test_a_load_beyond_the_greatest_pull_is_refused(load):
    with pytest.raises(InputError, match="greatest"):
        jkr_barrier(load, 1.0, 1.0)
    with pytest.raises(InputError, match="greatest"):
        dmt_barrier([0.5, load], 1.0, 1.0)


def test_a_time_shorter_than_an_attempt_is_refused():
    with pytest.raises(InputError, match="attempt"):
        life_temperature(1e-20, 1e10, 1e-11)
