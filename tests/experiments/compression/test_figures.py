"""Figures of the compression: what is drawn thin, in which colours, and what is left out."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from ratd.experiments.compression import document
from ratd.experiments.compression.figures import common, figure4, figure6, figure8, isotropy, tension
from ratd.experiments.spin_up.figures.style import TYPE_COLOUR
from ratd.pictures.style import ENERGY_COLOURS
from ratd.pipeline import io


@pytest.fixture(scope="module")
def sets():
    names = ("base", "n_1024", "n_16384", "high_16384", "loose_16384", "slow_16384", "slow_65536", "silicate_16384")
    return {name: io.read(document.DATA / f"sets/{name}.nc", "compression_set") for name in names}


def curves(axes, colour, thin):
    """Lines of a colour, those that are thin or those that are not."""
    own = [line for line in axes.get_lines() if line.get_color() == colour]
    return [line.get_xydata() for line in own if (line.get_linewidth() == common.THIN) is thin]


def drawn(line):
    return line[np.isfinite(line).all(axis=1)]


def changed(table, factor, noise):
    """A table whose mean pressure is P_0 phi^3 times a factor, with a standard error of `noise` of it."""
    phi, n = table["phi"].values, table.sizes["seed_number"]
    mean = table["rolling_pressure"].values[0] * phi**3 * factor(phi)
    own = np.linspace(-1.0, 1.0, n)
    own *= noise * np.sqrt(n) / own.std(ddof=1)
    table = table.copy(deep=True)
    table["pressure"] = (("seed_number", "phi_bin"), mean * (1.0 + own[:, None]))
    return table


def test_a_set_has_the_same_look_in_all_figures(sets):
    orders = (
        ("n_16384", "high_16384"), ("n_1024", "base", "n_16384", "slow_16384"),
        ("n_16384", "loose_16384", "slow_16384", "slow_65536"),
    )  # fmt: skip
    found = {}
    for order in orders:
        looks = common.looks_of([sets[name] for name in order])
        assert len(set(looks)) == len({dash for _, dash in looks}) == len(order)
        for name, look in zip(order, looks, strict=True):
            assert found.setdefault(name, look) == look
    sizes = [found[name] for name in ("n_1024", "base", "n_16384")]
    assert sizes == [common.OF_SIZE[n] for n in (1024, 4096, 16384)]


def test_sets_of_no_known_size_or_rate_are_told_apart_too(sets):
    other = sets["base"].assign(n_monomers=300)
    looks = common.looks_of([other, sets["base"], other, other])
    assert len({dash for _, dash in looks}) == 4 and looks[1] == common.OF_SIZE[4096]


def test_a_curve_begins_right_of_the_last_mean_that_is_not_above_its_error(sets):
    below = changed(sets["base"], lambda phi: np.where((phi > 0.01) & (phi < 0.011), -0.3, 0.8), 0.1)
    axes = Figure().subplots()
    axes.set(xscale="log", yscale="log")
    common.draw_curves(axes, None, [below], ["x"], [("red", "-")])
    every = np.concatenate([drawn(line) for thin in (False, True) for line in curves(axes, "red", thin)])
    assert 0.011 < every[:, 0].min() < 0.012 and (every[:, 1] > 0.0).all()


def test_a_curve_is_thin_where_it_is_not_static_or_unsure_and_nowhere_else(sets):
    for noise, sure in ((0.1, True), (0.6, False)):
        table = changed(sets["base"], np.ones_like, noise)
        start = table["static_from"].values[0]
        axes = Figure().subplots()
        axes.set(xscale="log", yscale="log")
        common.draw_curves(axes, None, [table], ["x"], [("red", "--")])
        (bold,), (thin,) = (drawn(line) for line in curves(axes, "red", False)), curves(axes, "red", True)
        thin = drawn(thin)
        assert thin[0, 0] == pytest.approx(common.BEFORE * start, rel=0.05)
        if sure:
            # the two meet in one bin
            assert bold[0, 0] == thin[-1, 0] == pytest.approx(start, rel=0.05)
        else:
            assert not len(bold) and thin[-1, 0] == table["phi"].values[-1]


def test_ratios_that_say_nothing_are_left_out(sets):
    base = changed(sets["base"], np.ones_like, 0.05)
    noisy = base.copy(deep=True)
    loose = noisy["phi"].values < 0.02
    noisy["pressure"] = noisy["pressure"] * (1.0 + np.linspace(-1.0, 1.0, 10)[:, None] * 2.0 * loose)
    axes = Figure().subplots()
    axes.set(xscale="log", xlim=(0.001, 0.2))
    common.draw_over(axes, [base, noisy], [("black", "-"), ("red", "-")], 0, "ratio")
    (line,) = curves(axes, "red", False)
    assert 0.02 < line[0, 0] < 0.022 and line[:, 1] == pytest.approx(1.0)


def test_two_clusters_have_no_band(sets):
    axes = Figure().subplots(1, 2)
    for each, table in zip(axes, (sets["silicate_16384"], sets["base"]), strict=True):
        each.set(xscale="log", yscale="log")
        common.draw_curves(each, None, [table], ["x"], [("red", "-")])
    areas = [np.concatenate([path.vertices for path in each.collections[0].get_paths() or []] or [[]]) for each in axes]
    assert areas[0].size == 0 < areas[1].size


def test_the_pressure_says_how_far_each_mean_goes(sets):
    figure = figure4.figure4([sets["n_16384"], sets["high_16384"]])
    texts = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert texts[0].endswith("= 0.13") and texts[1].endswith("= 0.5")


def test_no_band_reaches_into_the_energies_from_below(sets):
    axes = Figure().subplots()
    figure8.panel(axes, sets["high_16384"], "x")
    for way, band in zip(ENERGY_COLOURS, axes.collections, strict=True):
        (line,) = [one for one in axes.get_lines() if one.get_label() == figure8.NAMES.get(way, way)]
        told = drawn(line.get_xydata())
        least = told[told[:, 1] > figure8.LOWEST][0, 0]
        assert min(path.vertices[:, 0].min() for path in band.get_paths()) >= least


def test_strengths_are_over_the_formula_and_grains_have_the_colours_of_their_types():
    entries = io.read(document.DATA / "tension.nc", "tension_set")
    spun = {"phi": np.full(3, 0.3), "strength": np.full(3, 2.0 * 0.6 * 0.3**1.8), "type": np.array(list(TYPE_COLOUR))}
    figure = tension.tension(entries, spun)
    (axes,) = figure.axes
    for kind, colour in TYPE_COLOUR.items():
        (line,) = [one for one in axes.get_lines() if one.get_label() == f"{kind} spun up"]
        assert line.get_color() == colour and line.get_ydata() == pytest.approx([2.0])
    # moved to the side alone: the height is that of the document
    held = {container.get_label(): container[0].get_ydata() for container in axes.containers}
    assert held["one axis, N = 4096"] == pytest.approx([0.847], abs=1e-3)
    assert held["unloaded first, one axis"][-1] == pytest.approx(1.24, abs=0.01)


def test_small_clusters_have_one_curve_without_gaps(sets):
    figure = figure6.figure6([sets["n_1024"]])
    colour = common.OF_SIZE[1024][0]
    for thin in (False, True):
        (line,) = curves(figure.axes[1], colour, thin)
        there = np.flatnonzero(np.isfinite(line[:, 1]))
        assert len(there) == there[-1] - there[0] + 1


def test_sets_without_a_pressure_have_a_figure_without_curves(sets):
    empty = changed(sets["base"], lambda phi: np.full(len(phi), -1.0), 0.1)
    for draw in (figure4.figure4, figure6.figure6, isotropy.isotropy):
        figure = draw([empty])
        figure.draw_without_rendering()
