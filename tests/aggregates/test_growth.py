import math

import numpy as np
import pandas as pd
import pytest

import naive_geometry as naive
from ratd.aggregates import ballistic, radii
from ratd.aggregates.ballistic import place_monomers
from ratd.aggregates.grain import gaps
from ratd.aggregates.growth import TYPES, grow, grow_with_radii, smallest_a_eff
from ratd.aggregates.radii import RadiusDistribution, draw_radii, mrn_moment, mrn_radii
from ratd.base.errors import InputError
from ratd.base.materials import Material, get_material
from ratd.geometry.directions import random_direction, random_normal
from ratd.laws.contact_constants import equilibrium_compression, reduced_radius
from tiny_pipeline import ROOT

QUARTZ = get_material("q-S")
CONSTANTS = QUARTZ.surface_energy, QUARTZ.reduced_modulus


def rng(seed):
    return np.random.Generator(np.random.PCG64(seed))


def touching_distance(a_i, a_j):
    return a_i + a_j - equilibrium_compression(reduced_radius(a_i, a_j), *CONSTANTS)


def polydisperse(n, seed):
    return np.clip(rng(seed).lognormal(math.log(20e-9), 0.844, n), 10e-9, 100e-9)


# Radii


def test_moments_of_the_distribution():
    distribution = RadiusDistribution()
    a = np.linspace(10e-9, 100e-9, 200001)
    density = np.exp(-0.5 * (np.log(a / 20e-9) / 0.844) ** 2) / a
    for k in (1, 2, 3, 6):
        assert distribution.moment(k) == pytest.approx(np.trapezoid(a**k * density) / np.trapezoid(density), rel=1e-6)
    assert distribution.moment(0) == 1.0


def test_both_readings_give_the_monomer_counts_of_figure_1():
    assert RadiusDistribution().moment(3) ** (1 / 3) == pytest.approx(40.9e-9, rel=1e-3)
    assert RadiusDistribution(8.77e-9, 1.2845).moment(3) ** (1 / 3) == pytest.approx(40.3e-9, rel=2e-3)


@pytest.mark.parametrize(
    ("q", "length"),
    [(1, 0.0831), (2, 0.1036), (3, 0.1560), (4, 0.2462), (5, 0.3536), (6, 0.4631), (4.5, 0.2989), (4.6, 0.3098)],
)
def test_mean_lengths_of_the_mrn_law_are_the_exact_ones(q, length):
    """shared/collision.md, Sect. 3, for radii of 0.05 to 2.5 um."""
    assert mrn_moment(q, 0.05e-6, 2.5e-6) ** (1 / q) == pytest.approx(length * 1e-6, abs=0.5e-10)


def test_radii_of_the_mrn_law_have_its_moments_and_ends():
    smallest, largest = 0.05e-6, 2.5e-6
    np.testing.assert_allclose(mrn_radii([0.0, 1.0], smallest, largest), [smallest, largest], rtol=1e-12)
    u = (np.arange(400_000) + 0.5) / 400_000
    for k in (0, 1, 2, 2.5, 3):
        assert np.mean(mrn_radii(u, smallest, largest) ** k) == pytest.approx(
            mrn_moment(k, smallest, largest), rel=2e-3
        )


@pytest.mark.parametrize("median", [20e-9, 8.77e-9])
def test_free_draws_follow_the_cut_distribution(median):
    distribution = RadiusDistribution(median, 0.844 if median > 10e-9 else 1.2845)
    source = rng(1)
    a = [radii._cut_lognormal(math.log(median / 10e-9), distribution.sigma_ln, 10.0, source) for _ in range(40000)]
    a = np.array(a) * 10e-9
    assert a.min() >= 10e-9 and a.max() <= 100e-9
    for k in (1, 3):
        spread = math.sqrt(distribution.moment(2 * k) / distribution.moment(k) ** 2 - 1)
        assert np.mean(a**k) / distribution.moment(k) == pytest.approx(1.0, abs=4 * spread / 200)


def test_draws_from_a_narrow_range_follow_the_same_law():
    # Between 10 and 11 nm, where the density is nearly 1/a: mean of ln a = half the range.
    source = rng(1)
    logs = np.log([radii._cut_lognormal(math.log(2.0), 0.844, 1.1, source) for _ in range(20000)])
    assert logs.min() >= 0.0 and logs.max() <= math.log(1.1)
    grid = np.linspace(0, math.log(1.1), 10001)
    density = np.exp(-0.5 * ((grid - math.log(2.0)) / 0.844) ** 2)
    assert logs.mean() == pytest.approx(np.sum(grid * density) / np.sum(density), abs=4 * logs.std() / math.sqrt(20000))


@pytest.mark.parametrize("a_eff", [25e-9, 50e-9, 100e-9, 350e-9, 550e-9])
@pytest.mark.parametrize("fewest", [2, 3, 4])
@pytest.mark.parametrize("distribution", [RadiusDistribution(), RadiusDistribution(8.77e-9, 1.2845)])
def test_the_effective_radius_is_exact_and_every_radius_in_range(a_eff, fewest, distribution):
    for seed in range(5):
        radius = draw_radii(a_eff, fewest, distribution, rng(seed))
        assert len(radius) >= fewest
        assert math.fsum(radius**3) == pytest.approx(a_eff**3, rel=1e-14)
        assert radius.min() >= 10e-9 and radius.max() <= 100e-9


@pytest.mark.parametrize("fewest", [2, 3, 4])
def test_sizes_just_above_the_limit_give_the_fewest_monomers(fewest):
    a_eff = fewest ** (1 / 3) * 10e-9 * (1 + 1e-6)
    radius = draw_radii(a_eff, fewest, RadiusDistribution(), rng(1))
    assert len(radius) == fewest
    assert math.fsum(radius**3) == pytest.approx(a_eff**3, rel=1e-14)


@pytest.mark.parametrize("a_eff", [200e-9, 350e-9])
def test_mean_number_of_monomers_is_that_of_figure_1(a_eff):
    # 40.9 nm a monomer: 117 at 200 nm and 627 at 350 nm, and a little more since a sequence has a first monomer.
    counts = [len(draw_radii(a_eff, 2, RadiusDistribution(), rng(seed))) for seed in range(200)]
    assert np.mean(counts) == pytest.approx((a_eff / 40.9e-9) ** 3, rel=0.06)


@pytest.mark.parametrize("fewest", [2, 4])
def test_radii_are_those_of_free_draws_that_happen_to_fill_the_volume(fewest):
    # The slow way: free sequences, of which every beginning is kept that comes within 3 % of the volume of 60 nm.
    distribution = RadiusDistribution()
    volume = 60e-9**3
    source = rng(5)
    free = source.lognormal(math.log(20e-9), 0.844, 1_200_000)
    free = free[(free >= 10e-9) & (free <= 100e-9)]
    kept, begin, total = [], 0, 0.0
    for i, cube in enumerate(free**3):
        total += cube
        if abs(total / volume - 1) < 0.03 and i + 1 - begin >= fewest:
            kept.append(free[begin : i + 1])
        elif total > volume:
            begin, total = i + 1, 0.0
    drawn = [draw_radii(60e-9, fewest, distribution, source) for _ in range(4000)]
    assert len(kept) > 4000
    for value in (len, np.mean, np.max, np.min):
        slow, fast = np.array([value(r) for r in kept]), np.array([value(r) for r in drawn])
        error = math.hypot(slow.std() / math.sqrt(len(slow)), fast.std() / math.sqrt(len(fast)))
        # 1 % allows for the 3 % of volume.
        assert fast.mean() == pytest.approx(slow.mean(), abs=4 * error + 0.01 * slow.mean())


def test_the_last_radii_are_no_different_from_the_first():
    drawn = [draw_radii(150e-9, 4, RadiusDistribution(), rng(seed)) for seed in range(1500)]
    first, last = (np.array([r[part] for r in drawn]) for part in (slice(None, 3), slice(-3, None)))
    for mine, other in ((first, last), (first**3, last**3)):
        error = math.hypot(mine.std(), other.std()) / math.sqrt(mine.size)
        assert mine.mean() == pytest.approx(other.mean(), abs=4 * error)


# Geometry of the arrival


def test_directions_are_isotropic():
    source = rng(2)
    d = np.array([random_direction(source) for _ in range(30000)])
    np.testing.assert_allclose(np.linalg.norm(d, axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(d.mean(axis=0), 0.0, atol=4 / math.sqrt(3 * 30000))
    np.testing.assert_allclose(d.T @ d / 30000, np.eye(3) / 3, atol=4 * 0.3 / math.sqrt(30000))


@pytest.mark.parametrize("normal", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.6, -0.8, 0.0), (-0.36, 0.48, 0.8)])
def test_normals_are_uniform_on_their_circle(normal):
    source = rng(3)
    u = np.array([random_normal(*normal, source) for _ in range(10000)])
    np.testing.assert_allclose(np.linalg.norm(u, axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(u @ normal, 0.0, atol=1e-12)
    np.testing.assert_allclose(u.mean(axis=0), 0.0, atol=0.03)
    np.testing.assert_allclose(u.T @ u / 10000, (np.eye(3) - np.outer(normal, normal)) / 2, atol=0.02)


def test_monomers_arrive_from_everywhere():
    # The second monomer's place relative to the first, and the spread of whole BA aggregates, have no direction.
    place = np.array([place_monomers(np.full(2, 3e-8), *CONSTANTS, 0, False, rng(s))[1] for s in range(8000)])
    n = place / np.linalg.norm(place, axis=1)[:, None]
    np.testing.assert_allclose(n.mean(axis=0), 0.0, atol=4 / math.sqrt(3 * 8000))
    np.testing.assert_allclose(n.T @ n / 8000, np.eye(3) / 3, atol=4 * 0.3 / math.sqrt(8000))
    spread = np.array([np.var(place_monomers(np.ones(100), *CONSTANTS, 0, False, rng(s)), axis=0) for s in range(300)])
    error = spread.std() / math.sqrt(300)
    np.testing.assert_allclose(spread.mean(axis=0), spread.mean(), atol=4 * error)


def table_of(position, radius):
    """The table of cells as the growth fills it."""
    size = 2 * radius.max()
    head, follower = np.full(256, -1), np.full(len(radius), -1)
    for i in range(len(radius)):
        ballistic._insert(i, position, size, head, follower)
    return size, head, follower


@pytest.mark.parametrize("n", [1, 5, 120])
@pytest.mark.parametrize("a", [10e-9, 100e-9])
def test_first_touch_is_that_of_trying_every_monomer(n, a):
    source = rng(n)
    radius = polydisperse(n, n)
    position = source.normal(size=(n, 3)) * 3e-7
    size, head, follower = table_of(position, radius)
    box = np.array([position.min(axis=0), position.max(axis=0)])
    distance = np.array([touching_distance(a, r) for r in radius])
    reach = np.linalg.norm(position, axis=1).max() + 1.5e-7
    hits = 0
    for k in range(400):
        d = np.eye(3)[k % 3] * (-1) ** k if k < 30 else np.array(random_direction(source))
        aside = np.array(random_normal(*d, source)) * reach * math.sqrt(source.random())
        start = aside - 2 * reach * d
        t, hit = ballistic._first_touch(
            start, d, a, position, radius, radius.max(), box, size, head, follower, *CONSTANTS
        )
        expected, expected_hit = naive.first_touch(start, d, distance, position)
        assert hit == expected_hit
        assert t == pytest.approx(expected, rel=1e-12)
        hits += hit >= 0
    assert 0 < hits < 400


def test_near_monomers_are_all_found_once():
    radius = polydisperse(150, 1)
    position = rng(4).normal(size=(150, 3)) * 4e-7
    size, head, follower = table_of(position, radius)
    near = np.empty(150, dtype=np.int64)
    for reach in (1e-9, 1e-7, 4e-7, 1e-5):
        for x in position[:20] * 1.1:
            count = ballistic._near(*x, reach, position, radius, radius.max(), size, head, follower, near)
            expected = np.flatnonzero(np.linalg.norm(position - x, axis=1) < reach + radius)
            np.testing.assert_array_equal(np.sort(near[:count]), expected)


@pytest.mark.parametrize("seed", range(8))
def test_rolling_stops_where_small_steps_do(seed):
    # A monomer on monomer 0 among others that leave its starting place free.
    source = rng(seed)
    a, s = 3e-8, touching_distance(3e-8, 4e-8)
    e, f = np.eye(3)[:2]
    position = np.zeros((12, 3))
    position[1:] = source.normal(size=(11, 3)) * 8e-8
    radius = np.full(12, 4e-8)
    distance = np.full(12, s)
    distance[0] = 0.0
    blocked = np.linalg.norm(position - s * e, axis=1) < s
    blocked[0] = False
    position[blocked] += 1e-6
    near = np.arange(12)
    angle, hit = ballistic._roll(position[0], e, f, s, a, (0, 0), near, 12, position, radius, *CONSTANTS)
    steps = 40000
    slow, slow_hit = naive.roll(position[0], e, f, s, distance, position, steps)
    assert hit == slow_hit
    if hit >= 0:
        assert slow - 2 * math.pi / steps <= angle <= slow


def test_the_way_to_the_nearest_place_is_no_longer_than_any_other():
    source = rng(11)
    a, s = 3e-8, touching_distance(3e-8, 4e-8)
    e = np.array([0.0, 0.6, 0.8])
    position = np.array([[0, 0, 0], [7.9e-8, 0, 0], [0, -5e-8, -6.2e-8], [-6e-8, 5.1e-8, 0.0]])
    radius = np.full(4, 4e-8)
    near = np.arange(4)
    f = np.empty(3)
    assert ballistic._way_to_nearest(e, s, a, 0, near, 4, position, radius, *CONSTANTS, f)
    assert f @ e == pytest.approx(0.0, abs=1e-12) and f @ f == pytest.approx(1.0)
    nearest, _ = ballistic._roll(position[0], e, f, s, a, (0, 0), near, 4, position, radius, *CONSTANTS)
    others = []
    for _ in range(2000):
        g = np.array(random_normal(*e, source))
        others.append(ballistic._roll(position[0], e, g, s, a, (0, 0), near, 4, position, radius, *CONSTANTS)[0])
    assert nearest <= min(others) <= nearest * 1.01


# Whole aggregates


@pytest.mark.parametrize("migration", ["random", "nearest"])
@pytest.mark.parametrize("type", TYPES)
def test_every_monomer_makes_the_contacts_of_its_type_and_none_overlaps(type, migration):
    for seed in range(3):
        grain = grow_with_radii(type, polydisperse(150, seed), "q-S", seed, migration=migration)
        pairs = grain.contacts
        gap = gaps(grain.position, grain.radius, pairs, *CONSTANTS)
        assert gap.min() >= -1.0 - 1e-6
        # Contacts at rest with monomers that were there before; accidental ones are less compressed.
        at_rest = pairs[np.abs(gap + 1.0) < 1e-6]
        earlier = np.bincount(at_rest[:, 1], minlength=150)
        wanted = np.minimum(TYPES[type] + 1, np.arange(150))
        np.testing.assert_array_equal(earlier, wanted)
        assert len(pairs) - len(at_rest) <= 8


def test_distances_are_kept_to_rounding():
    grain = grow_with_radii("BAM2", polydisperse(400, 2), "co-S", 1)
    gamma, modulus = grain.material.surface_energy, grain.material.reduced_modulus
    i, j = grain.contacts.T
    distance = np.linalg.norm(grain.position[i] - grain.position[j], axis=1)
    delta_0 = equilibrium_compression(reduced_radius(grain.radius[i], grain.radius[j]), gamma, modulus)
    assert np.all(distance >= (grain.radius[i] + grain.radius[j] - delta_0) * (1 - 1e-9))


@pytest.mark.parametrize(("type", "per_monomer"), [("BA", 1), ("BAM1", 2), ("BAM2", 3)])
@pytest.mark.parametrize("a_eff", [200e-9, 350e-9])
def test_number_of_contacts_is_that_of_figure_1(type, per_monomer, a_eff):
    least = 0 if type == "BA" else per_monomer
    for seed in range(4):
        grain = grow(type, a_eff, "q-S", seed)
        made = per_monomer * grain.n_monomers - per_monomer * (per_monomer + 1) // 2
        assert made <= grain.n_contacts <= made * 1.02 + 2
        assert grain.n_monomers > least


@pytest.mark.parametrize("type", TYPES)
@pytest.mark.parametrize("a_eff", [50e-9, 100e-9, 200e-9])
def test_grow_gives_an_exact_size_and_a_centred_grain(type, a_eff):
    for seed in range(10):
        grain = grow(type, a_eff, "a-C", seed)
        assert grain.n_monomers >= TYPES[type] + 2
        assert math.fsum(grain.radius**3) == pytest.approx(a_eff**3, rel=1e-12)
        assert (grain.type, grain.seed, grain.a_eff, grain.material.name) == (type, seed, a_eff, "a-C")
        np.testing.assert_allclose(grain.mass @ grain.position / grain.mass.sum(), 0.0, atol=1e-20)


def test_porosity_of_equal_monomers():
    """That of the reference, which is told of in docs/validation.md with many more."""
    table = pd.read_csv(ROOT / "docs/validation/data/growth_reference.csv")
    for row in table[table["n_monomers"] <= 256].itertuples():
        radii = np.full(row.n_monomers, 3e-8)
        seeds = range(10_000 // row.n_monomers)
        grains = [grow_with_radii(row.type, radii, "q-S", seed, migration="nearest") for seed in seeds]
        found = [grain.shape.porosity for grain in grains]
        error = math.hypot(row.error, np.std(found, ddof=1) / math.sqrt(len(found)))
        assert np.mean(found) == pytest.approx(row.porosity, abs=3.5 * error)


def test_random_migration_is_more_compact_than_the_shortest_one():
    radii = np.full(64, 3e-8)
    random, nearest = (
        np.mean([grow_with_radii("BAM1", radii, "q-S", seed, migration=m).shape.porosity for seed in range(60)])
        for m in ("random", "nearest")
    )
    assert random < nearest - 0.03


def test_a_monomer_without_any_place_makes_do_with_one_contact_fewer():
    # The third monomer hides between the first two: none of the last one's size touches it and both of them.
    grain = grow_with_radii("BAM2", [100e-9, 100e-9, 10e-9, 100e-9], "q-S", 1)
    assert grain.n_contacts == 1 + 2 + 2


def test_the_same_seed_gives_the_same_bytes_and_another_key_another_grain():
    def content(*key, **options):
        grain = grow(*key, **options)
        return grain.position.tobytes() + grain.radius.tobytes()

    one = content("BAM2", 150e-9, "q-S", 7)
    assert content("BAM2", 150e-9, "q-S", 7) == one
    assert content("BAM2", 150e-9, get_material("q-S"), np.int64(7)) == one
    others = [
        content("BAM2", 150e-9, "q-S", 8),
        content("BAM1", 150e-9, "q-S", 7),
        content("BAM2", 150.001e-9, "q-S", 7),
        content("BAM2", 150e-9, "co-S", 7),
        content("BAM2", 150e-9, "q-S", 7, migration="nearest"),
        content("BAM2", 150e-9, "q-S", 7, distribution=RadiusDistribution(25e-9)),
    ]
    assert len({one, *others}) == 7


def test_the_seed_hangs_on_the_name_of_the_material_alone():
    one = grow("BA", 100e-9, Material("x", 0.02, 54e9, 0.17, 2650.0), 1)
    other = grow("BA", 100e-9, Material("x", 0.03, 54e9, 0.17, 2650.0), 1)
    np.testing.assert_array_equal(one.radius, other.radius)


# Wrong input


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"type": "BCCA"}, "'BCCA'; allowed are BA, BAM1, BAM2"),
        ({"type": ["BA"]}, "allowed are BA, BAM1, BAM2"),
        ({"material": "granite"}, "granite"),
        ({"seed": -1}, "seed is -1"),
        ({"seed": 1.5}, "seed is 1.5"),
        ({"seed": True}, "seed is True"),
        ({"a_eff": -1e-7}, "must be above 1.26e-08 m"),
        ({"a_eff": math.nan}, "must be above"),
        ({"a_eff": "big"}, "must be above"),
        ({"a_eff": 200.0}, "at most 4.09e-06 m"),
        ({"migration": "lazy"}, "'lazy'; allowed are random, nearest"),
    ],
)
def test_wrong_arguments_are_refused(change, message):
    good = dict(type="BA", a_eff=1e-7, material="q-S", seed=1)
    with pytest.raises(InputError, match=message):
        grow(**{**good, **change})


@pytest.mark.parametrize(("type", "fewest"), [("BA", 2), ("BAM1", 3), ("BAM2", 4)])
def test_sizes_below_the_fewest_monomers_are_refused(type, fewest):
    assert smallest_a_eff(type) == pytest.approx(fewest ** (1 / 3) * 10e-9)
    with pytest.raises(InputError, match=f"{fewest} monomers of the smallest radius"):
        grow(type, 0.999 * smallest_a_eff(type), "q-S", 1)
    assert grow(type, 1.001 * smallest_a_eff(type), "q-S", 1).n_monomers == fewest


def test_sizes_that_no_number_of_monomers_gives_are_refused():
    narrow = RadiusDistribution(10.5e-9, 0.1, 10e-9, 11e-9)
    with pytest.raises(InputError, match="no number of monomers"):
        grow("BA", 2.8 ** (1 / 3) * 10e-9, "q-S", 1, distribution=narrow)
    assert grow("BA", 3.5 ** (1 / 3) * 10e-9, "q-S", 1, distribution=narrow).n_monomers == 3


def test_sizes_that_only_equal_monomers_give_are_given_up(monkeypatch):
    # Three monomers of 11 nm and nothing else: no draws ever hit that.
    monkeypatch.setattr(radii, "_MOST_PATHS", 2000)
    narrow = RadiusDistribution(10.5e-9, 0.1, 10e-9, 11e-9)
    a_eff = 3 ** (1 / 3) * 11e-9 * (1 - 1e-9)
    with pytest.raises(InputError, match="choose another size"):
        grow("BAM1", a_eff, "q-S", 1, distribution=narrow)


@pytest.mark.parametrize("radii", [[], [1e-8], [1e-8, 0.0], [1e-8, math.nan], [[1e-8, 1e-8]]])
def test_wrong_radii_are_refused(radii):
    with pytest.raises(
        InputError,
        match=r"radii(.1. is (0|nan);| must be at least two) .*finite numbers above 0",
    ):
        grow_with_radii("BA", radii, "q-S", 1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"median": 0.0}, "median"),
        ({"sigma_ln": -1.0}, "sigma_ln"),
        ({"smallest": math.nan}, "smallest"),
        ({"largest": "wide"}, "largest"),
        ({"smallest": 100e-9, "largest": 10e-9}, "smallest must be below largest"),
        ({"median": 1e-9, "sigma_ln": 0.1}, "at least 0.001"),
        ({"median": 20, "smallest": 10, "largest": 100}, "multiply"),
    ],
)
def test_wrong_distributions_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        RadiusDistribution(**change)
