"""Pictures of spheres, and figures 1 and 5 that are made of them."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from matplotlib.text import Text

from ratd.aggregates.grain import Grain
from ratd.base.errors import InputError
from ratd.experiments.spin_up.figures.figure1 import figure1
from ratd.experiments.spin_up.figures.figure5 import figure5, nearest_snapshots
from ratd.pictures.snapshots import LARGEST, displacements, fragment_colours
from ratd.pictures.spheres import render, scale_length, view_axes
from synthetic_runs import make_run, run_with_snapshots


def test_a_sphere_covers_its_disc_and_nothing_else():
    picture = render([[0.25, -0.5, 0]], [0.25], [[1, 1, 1]], 1.0, 200)
    centre = (np.arange(200) + 0.5) / 100 - 1
    y, x = np.meshgrid(-centre, centre, indexing="ij")
    distance = np.hypot(x - 0.25, y + 0.5)
    assert (picture[distance < 0.24, 3] == 255).all() and (picture[distance > 0.26, 3] == 0).all()
    assert picture[..., 3].mean() / 255 == pytest.approx(np.pi * 0.25**2 / 4, rel=0.005)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_nearer_sphere_hides_the_farther_one(order):
    position, colour = np.array([[0, 0, 1.0], [0, 0, -1.0]]), np.array([[1.0, 0, 0], [0, 0, 1.0]])
    picture = (
        render(position[list(order)], [0.2, 0.6], colour[list(order)], 1.0, 101)
        if order == (0, 1)
        else (render(position[::-1], [0.6, 0.2], colour[::-1], 1.0, 101))
    )
    assert picture[50, 50, 0] > 0 and picture[50, 50, 2] == 0
    assert picture[50, 70, 2] > 0 and picture[50, 70, 0] == 0


def test_view_axes_are_right_handed_with_up_upwards():
    axes = view_axes((0.3, 0.5, 1.0), (1, 0, 0))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert (
        np.linalg.det(axes) == pytest.approx(1) and axes[1] @ (1, 0, 0) > 0 and axes[0] @ (1, 0, 0) == pytest.approx(0)
    )


@pytest.mark.parametrize(("greatest", "length"), [(1.0, 1), (199.0, 100), (200.0, 200), (730.0, 500)])
def test_scale_bars_have_round_lengths(greatest, length):
    assert scale_length(greatest) == length


def test_the_largest_fragment_is_blue_and_neighbours_differ():
    colours = fragment_colours([0, 1, 2, 0])
    np.testing.assert_allclose(colours[[0, 3]], [to_rgb(LARGEST)] * 2)
    assert len(np.unique(colours, axis=0)) == 3


def words(figure):
    return " | ".join(text.get_text() for text in figure.findobj(Text))


def test_figure1_names_each_grain_and_its_numbers():
    grain = Grain([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9, 20e-9], "q-S", type="BA", seed=3)
    text = words(figure1([grain]))
    assert "BA" in text and r"$N_\mathrm{con}$ = 1" in text and "seed 3" in text and "= 40 nm" in text
    with pytest.raises(InputError, match="no two of the same"):
        figure1([grain, grain])


def test_figure1_has_one_scale_for_all_grains():
    """Pairs of 20 nm and of 60 nm: the pictures of their spheres differ by a factor of 3, all in mm of the figure."""
    small, large = (Grain([[0, 0, 0], [0, 0, 1.9975 * a]], [a, a], "q-S", type="BA", seed=3) for a in (20e-9, 60e-9))
    figure = figure1([small, large])
    (axes,) = figure.axes
    widths = [image.get_extent()[1] - image.get_extent()[0] for image in axes.get_images()]
    assert widths[1] / widths[0] == pytest.approx(3.0, rel=1e-9)
    assert words(figure).count("for all grains") == 1 and words(figure).count("hat{a}_1") == 1


def test_displacements_are_beyond_the_motion_as_a_rigid_body():
    """A grain that turns and moves as a whole has none; one monomer that moves on its own has just its own."""
    rng = np.random.default_rng(8)
    start = rng.normal(0, 1e-7, (40, 3))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    end = start @ turn.T + [1e-7, -2e-7, 3e-7]
    end[0] += [3e-8, 0, 4e-8]
    places, fragment = np.stack([start, end, end]), np.zeros((3, 40), int)
    fragment[1:, 0] = 1  # the one that parts does not bias the fit of the others
    fragment[2, 5] = -1
    shape = ("snapshot", "monomer")
    run = xr.Dataset({f"snapshot_{axis}": (shape, places[..., k]) for k, axis in enumerate("xyz")})
    run = run.assign(snapshot_fragment=(shape, fragment), monomer_radius=("monomer", rng.uniform(1e-8, 3e-8, 40)))
    none, own, dropped = displacements(run, (0, 1, 2))
    np.testing.assert_allclose(none, 0.0, atol=1e-20)
    np.testing.assert_allclose(own[1:], 0.0, atol=1e-20)
    assert own[0] == pytest.approx(5e-8) and len(dropped) == 39


def test_figure5_takes_the_nearest_snapshots_and_says_which():
    run, mark = run_with_snapshots(), xr.Dataset({"omega_disr": 1.02e8})
    assert nearest_snapshots(run, 1.02e8) == [0, 2, 3]
    text = words(figure5(run, mark))
    assert "= 0.78" in text and "= 0.98" in text and "driven" in text and "flew off" not in text
    assert "moved since" in text and text.count("in one piece") == 3 and "67 % in one piece" in text


def test_figure5_has_no_colours_where_displacements_begin():
    run, mark = run_with_snapshots(), xr.Dataset({"omega_disr": 1.02e8})
    first, second, _ = figure5(run, mark).axes[:3]
    for axes, grey in ((first, True), (second, False)):
        picture = axes.get_images()[0].get_array()
        inside = picture[picture[..., 3] == 255][:, :3].astype(int)
        assert (np.ptp(inside, axis=1) < 3).all() == grey
        assert ("counted from here" in [text.get_text() for text in axes.texts]) == grey
    # where the first picture is of a later snapshot it has them
    later = figure5(run, xr.Dataset({"omega_disr": 6e8})).axes[0]
    assert "counted from here" not in [text.get_text() for text in later.texts]


def test_figure5_without_what_it_needs():
    with pytest.raises(InputError, match="no snapshots"):
        figure5(make_run(1e8), xr.Dataset({"omega_disr": 1e8}))
    assert "no peak of the stress" in words(figure5(run_with_snapshots(), xr.Dataset({"omega_disr": np.nan})))
