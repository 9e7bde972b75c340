import math

import numpy as np
import pytest

from ratd.aggregates.files import grain_row
from ratd.aggregates.grain import Grain
from ratd.aggregates.growth import grow
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.geometry.shape import enclosing_radius
from ratd.laws.contact_constants import equilibrium_compression

QUARTZ = get_material("q-S")
DELTA_0 = equilibrium_compression(10e-9, QUARTZ.surface_energy, QUARTZ.reduced_modulus)


def chain(n=3, compression=1.0, a=20e-9):
    """Equal monomers in a row along x, each contact compressed by so many equilibrium compressions of 20 nm."""
    position = np.zeros((n, 3))
    position[:, 0] = np.arange(n) * (2 * a - compression * DELTA_0)
    return position, np.full(n, a)


def test_a_chain():
    position, radius = chain(4)
    grain = Grain(position, radius, "q-S", type="chain", seed=3)
    np.testing.assert_array_equal(grain.contacts, [[0, 1], [1, 2], [2, 3]])
    assert grain.contacts.dtype == np.int64
    assert (grain.n_monomers, grain.n_contacts, grain.type, grain.seed) == (4, 3, "chain", 3)
    assert grain.material is QUARTZ
    np.testing.assert_allclose(grain.mass, 4 / 3 * math.pi * 2650.0 * 20e-9**3)
    assert grain.effective_radius == pytest.approx(4 ** (1 / 3) * 20e-9)
    assert grain.a_eff == grain.effective_radius
    assert grain.enclosing_radius == pytest.approx(enclosing_radius(position, radius))
    assert grain.shape.mean_coordination == 1.5
    assert "n_monomers=4" in repr(grain)


def test_the_arrays_are_contiguous_copies():
    position, radius = chain(3)
    grain = Grain(np.asfortranarray(position), radius, "q-S")
    position[0] = radius[0] = 7.0
    assert grain.position.flags.c_contiguous and grain.position.dtype == np.float64
    assert np.all(grain.position[0] == 0.0) and grain.radius[0] == 20e-9


def test_lists_are_taken():
    grain = Grain([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9, 20e-9], "q-S")
    assert grain.position.dtype == np.float64
    assert grain.n_contacts == 1


def test_the_row_of_a_file_has_the_shape_of_the_grain():
    z = np.array([0.0, 49.9e-9, 99.8e-9])
    position = np.column_stack([0 * z, 0 * z, z])
    row = grain_row(Grain(position, [20e-9, 30e-9, 20e-9], "q-S", type="BA", seed=4), 1e8)
    short, middle, long = (row[f"axis_{axis}"].item() for axis in "abc")
    assert short == pytest.approx(middle) and long > 2 * middle
    assert row["mean_monomer_radius"].item() == pytest.approx(70e-9 / 3)
    assert row["enclosing_radius"].item() == pytest.approx((99.8e-9 + 40e-9) / 2, rel=1e-6)


@pytest.mark.parametrize("compression", [-0.09, 0.0, 1.0, 2.9])
def test_contacts_near_equilibrium_are_taken(compression):
    assert Grain(*chain(3, compression), "q-S").n_contacts == 2


def test_the_tolerances_scale_with_each_pair():
    # A gap of 0.09 of the equilibrium compression of two large monomers is too wide for two small ones.
    large = equilibrium_compression(50e-9, QUARTZ.surface_energy, QUARTZ.reduced_modulus)
    small = equilibrium_compression(5e-9, QUARTZ.surface_energy, QUARTZ.reduced_modulus)
    assert 0.09 * large > 0.1 * small
    assert Grain([[0, 0, 0], [0, 0, 200e-9 + 0.09 * large]], [100e-9] * 2, "q-S").n_contacts == 1
    with pytest.raises(InputError, match="2 pieces"):
        Grain([[0, 0, 0], [0, 0, 20e-9 + 0.09 * large]], [10e-9] * 2, "q-S")


@pytest.mark.parametrize("compression", [3.1, 100.0])
def test_overlapping_monomers_are_refused(compression):
    position, radius = chain(3)
    position[2, 0] -= (compression - 1.0) * DELTA_0
    with pytest.raises(InputError, match=f"Monomers 1 and 2 overlap by {compression:g} equilibrium compressions"):
        Grain(position, radius, "q-S")


def test_an_aggregate_in_two_pieces_is_refused():
    position, radius = chain(5)
    position[3:, 0] += 1.2 * DELTA_0
    gap = position[3, 0] - position[2, 0] - 40e-9
    with pytest.raises(InputError, match="in 2 pieces; it must be in one") as error:
        Grain(position, radius, "q-S")
    assert f"the nearest of different pieces: the gap between them is {gap:.3g} m" in str(error.value)
    assert "Monomers 2 and 3, counted from 0," in str(error.value)
    assert f"less than {0.1 * DELTA_0:.3g} m." in str(error.value)


def test_of_many_pieces_the_nearest_are_named():
    position = np.array([[0, 0, 0], [100e-9, 0, 0], [100e-9, 45e-9, 0], [0, 90e-9, 0]])
    with pytest.raises(InputError, match="in 4 pieces.* Monomers 1 and 2, .* is 1e-09 m"):
        Grain(position, [20e-9, 34e-9, 10e-9, 5e-9], "q-S")


def test_of_pieces_that_are_far_apart_not_all_pairs_are_looked_at():
    position, radius = chain(8)
    position[4:, 1] += 4e-6
    with pytest.raises(InputError, match="2 pieces.* No two monomers of different pieces are nearer .* than .*e-08 m"):
        Grain(position, radius, "q-S")


def test_one_monomer_inside_another_is_refused():
    with pytest.raises(InputError, match="overlap"):
        Grain(np.zeros((2, 3)), [50e-9, 10e-9], "q-S")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda x, a: (x[:, :2], a), r"shape \(3, 2\)"),
        (lambda x, a: (x, a[:2]), r"must be \(n, 3\) and \(n,\)"),
        (lambda x, a: (x.ravel(), a), r"must be \(n, 3\) and \(n,\)"),
        (lambda x, a: (x, a[:, None]), r"must be \(n, 3\) and \(n,\)"),
        (lambda x, a: (x[:1], a[:1]), "at least 2"),
        (lambda x, a: (x[:0], a[:0]), "at least 2"),
        (lambda x, a: (np.where(np.arange(3)[:, None] == 1, np.nan, x), a), r"position\[1\]"),
        (lambda x, a: (np.where(np.arange(3)[:, None] == 2, np.inf, x), a), r"position\[2\]"),
        (lambda x, a: (x, a * [1, np.nan, 1]), r"radius\[1\]"),
        (lambda x, a: (x, a * [1, 1, 0]), r"radius\[2\] is 0; every radius must be above 0"),
        (lambda x, a: (x, a * [-1, 1, 1]), r"radius\[0\]"),
        (lambda x, a: ("here", a), "position is not an array of numbers"),
        (lambda x, a: (x, [1e-8, "b", 1e-8]), "radius is not an array of numbers"),
    ],
)
def test_unusable_arrays_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        Grain(*change(*chain(3)), "q-S")


def test_an_unknown_material_is_refused():
    with pytest.raises(InputError, match="allowed are a-C"):
        Grain(*chain(3), "granite")


def test_a_eff_must_agree_with_the_radii():
    position, radius = chain(3)
    a_eff = 3 ** (1 / 3) * 20e-9
    assert Grain(position, radius, "q-S", a_eff=a_eff).a_eff == a_eff
    for wrong in (a_eff * 1.001, math.nan):
        with pytest.raises(InputError, match="a_eff"):
            Grain(position, radius, "q-S", a_eff=wrong)


def test_a_grain_with_other_positions_or_of_another_material():
    grain = grow("BA", 60e-9, "q-S", 3)
    other = grain.replace(material="a-C")
    assert other.material.name == "a-C" and (other.position == grain.position).all()
    turned = grain.replace(position=grain.position @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]]))
    for one in (other, turned):
        assert (one.type, one.seed, one.a_eff, one.n_contacts) == ("BA", 3, grain.a_eff, grain.n_contacts)
        assert (one.radius == grain.radius).all()
    assert (turned.position[:, 1] == grain.position[:, 0]).all() and turned.material == grain.material
    with pytest.raises(InputError, match="pieces"):
        grain.replace(position=2 * grain.position)
