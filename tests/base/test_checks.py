"""What counts as a number, an array of numbers, and a grain of dust; how many of them there are in words."""

import numpy as np
import pytest

import ratd
from files import make_grain
from ratd.base.checks import GREATEST_SEED, check_radii, is_number, is_whole, number_array, whole_number
from ratd.base.errors import InputError
from ratd.base.words import plural


@pytest.mark.parametrize("value", [1, 1.5, np.float64(1), np.float32(1), np.int64(3), np.uint8(3)])
def test_numbers_of_numpy_are_numbers(value):
    assert is_number(value) and is_whole(value) == (int(value) == value and not isinstance(value, float | np.floating))


@pytest.mark.parametrize("value", [True, np.True_, "1", 1j, np.nan, np.inf, None, [1], np.ones(2)])
def test_what_is_no_number(value):
    assert not is_number(value) and not is_whole(value)


def test_whole_numbers_may_be_written_with_an_exponent():
    assert whole_number(1e3, "records", 1) == 1000 and isinstance(whole_number(1e3, "records", 1), int)
    for value in (0, 1.5, "3", True, np.nan, 10**400):
        with pytest.raises(InputError, match="records is .*; it must be a whole number of at least 1"):
            whole_number(value, "records", 1)


def test_the_least_number_that_is_named_is_allowed():
    assert whole_number(1, "records", 1) == 1


@pytest.mark.parametrize("values", [["1", "2"], [1j, 2], np.array([1 + 0j]), [True, False], [[1], [1, 2]], [None], "1"])
def test_text_and_complex_numbers_make_no_array(values):
    with pytest.raises(InputError, match="x is not an array of numbers"):
        number_array(values, "x")


def test_an_array_of_numbers_is_a_copy():
    given = np.arange(3.0)
    taken = number_array(given, "x")
    taken[0] = 5
    assert given[0] == 0 and number_array([1, np.float32(2)], "x").dtype == np.float64


@pytest.mark.parametrize(
    ("factor", "said"),
    [(1e9, "multiply those in nm by 1e-09"), (1e6, "in µm by 1e-06"), (1e-9, "by 1e\\+09, which"), (1e25, "m\\.$")],
)
def test_radii_in_another_unit_are_refused_with_the_factor(factor, said):
    grain = make_grain()
    with pytest.raises(InputError, match=said):
        check_radii(grain.radius * factor)
    with pytest.raises(InputError, match=said):
        ratd.Grain(grain.position * factor, grain.radius * factor, "q-S")
    with pytest.raises(InputError, match=said):
        ratd.evolve(grain.position * factor, grain.radius * factor, duration=1e-9)


def test_positions_alone_in_nm_are_refused():
    grain = make_grain()
    with pytest.raises(InputError, match="3 pieces.*multiply those in nm by 1e-09"):
        ratd.Grain(grain.position * 1e9, grain.radius, "q-S")
    with pytest.raises(InputError, match="position.*in nm by 1e-09"):
        ratd.evolve(grain.position * 1e9, grain.radius, duration=1e-9)


def test_a_material_of_numpy_numbers_is_that_of_plain_ones():
    numbers = {"surface_energy": 0.02, "youngs_modulus": 54e9, "poisson_number": 0.17, "density": 2650}
    plain = ratd.Material("x", **numbers)
    assert ratd.Material("x", **{name: np.float64(value) for name, value in numbers.items()}) == plain
    assert type(ratd.Material("x", **numbers | {"density": np.int64(2650)}).density) is float
    with pytest.raises(InputError, match="density = '2650'"):
        ratd.Material("x", **numbers | {"density": "2650"})


@pytest.mark.parametrize(
    ("name", "value"), [("seed", GREATEST_SEED + 1), ("seed", 1.0), ("a_eff", "1e-7"), ("a_eff", 1e-7j)]
)
def test_growth_takes_no_text_and_bounds_its_seed(name, value):
    with pytest.raises(InputError, match=f"{name} is"):
        ratd.grow(**{"type": "BA", "a_eff": 60e-9, "material": "q-S", "seed": 0} | {name: value})


def test_one_alone_is_no_plural():
    assert [plural(n, "grain") for n in (0, 1, 2)] == ["0 grains", "1 grain", "2 grains"]
