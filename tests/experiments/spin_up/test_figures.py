"""Figures: what they show, that they can be read, and that their files repeat to the last byte."""

import hashlib
import os
import subprocess
import sys
import warnings
from itertools import combinations
from pathlib import Path

import matplotlib
import numpy as np
import pandas as pd
import pytest
from matplotlib import font_manager
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from ratd.aggregates.strength import tensile_strength_tatsuuma2019
from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.eq33 import eq33, eq33_omega, fit_ensemble
from ratd.experiments.spin_up.figures.figure2 import figure2
from ratd.experiments.spin_up.figures.figure4 import figure4
from ratd.experiments.spin_up.figures.figure6 import axis_ratios, figure6
from ratd.experiments.spin_up.figures.figure7 import figure7
from ratd.experiments.spin_up.figures.figure8 import figure8
from ratd.experiments.spin_up.figures.figure10 import figure10
from ratd.experiments.spin_up.figures.fragments import fragments
from ratd.experiments.spin_up.figures.law import law
from ratd.experiments.spin_up.figures.overview import overview
from ratd.experiments.spin_up.figures.style import (
    TYPE_COLOUR,
    TYPE_MARKER,
    mean_and_range,
    middle_and_most,
    offsets,
    type_style,
)
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.pairs import force_controlled_omega
from ratd.experiments.spin_up.printed import TABLE_3
from ratd.experiments.spin_up.tensile import predictions
from ratd.pictures.snapshots import drive_text
from ratd.pictures.style import (
    ONE_COLUMN,
    TWO_COLUMNS,
    label_ends,
    logarithmic,
    own_fonts_first,
    power_of_ten,
    save,
    styled,
)
from synthetic_runs import make_fragments, make_run, make_table

SIZES = (50e-9, 75e-9, 100e-9)
PANEL_SIZES = (200e-9, 350e-9, 500e-9)


def cell_of_runs(n=6, drive="prescribed"):
    """Runs of one cell that differ."""
    rng = np.random.default_rng(3)
    return [
        make_run(3e7 * rng.lognormal(0, 0.2), omega_1=5e7, gain=0.02 * seed, seed=seed, drive=drive)
        for seed in range(n)
    ]


def made_up_pairs(materials=("a-C", "q-S", "co-S"), number=80):
    """Pairs that part within 2 % of their reference."""
    rng = np.random.default_rng(4)
    rows = []
    for name in materials:
        for start, part in (("damped", 1.0), ("undamped", np.sqrt(5) / 3)):
            for a in np.linspace(10e-9, 100e-9, number):
                exact = force_controlled_omega(a, a, get_material(name))
                rows.append(
                    (name, start, a, part * exact * (1 + 0.02 * rng.uniform(-1, 1)), exact, exact * np.sqrt(5) / 3)
                )
    columns = ["material", "start", "monomer_radius", "parting_omega", "force_controlled_omega", "eq35_omega"]
    return pd.DataFrame(rows, columns=columns).assign(epsilon=0.005, timestep_factor=0.05)


def full_figures():
    """All figures of an ensemble like the paper's, with fewer seeds."""
    table = make_table(seeds=2)
    return {
        "figure2": figure2(table),
        "figure4": figure4(cell_of_runs()),
        "figure6": figure6(table),
        "figure7": figure7(table, fit_ensemble(table, n_bootstrap=5)),
        "figure8": figure8(table, fit=fit_ensemble(table, n_bootstrap=5)),
        "figure10": figure10(made_up_pairs()),
        "overview": overview(table),
        "overview of both": overview(table, table, table.assign(firm_bound=table["cut_bound"])),
        "law": law(table),
        "fragments": fragments(make_fragments(), "prescribed"),
    }


def sparse_figures():
    """The same with the ensemble of a quick configuration, with one grain, and with nothing that was disrupted."""
    quick = make_table(sizes=SIZES, seeds=3)
    hole = quick[~((quick["material"] == "q-S") & (quick["type"] == "BAM1"))]
    one = make_table(("q-S",), ("BAM2",), (100e-9,), 1)
    whole = quick.assign(omega_disr=np.nan, axis_a_disr=np.nan, axis_b_disr=np.nan, axis_c_disr=np.nan)
    unknown = quick.assign(fractal_dimension=np.nan, drive="")
    long = make_run(4.2e8, omega_1=2e8, end=3e8, gain=0)
    return {
        "quick 2": figure2(quick),
        "quick 6": figure6(quick, sizes=SIZES),
        "quick 7": figure7(quick, fit_ensemble(quick, n_bootstrap=5)),
        "hole 7": figure7(hole, fit_ensemble(hole, n_bootstrap=5)),
        "one 2": figure2(one),
        "one 4": figure4([make_run(4.2e8, omega_1=2e8, steps=[(3e8, 0.6), (4e8, 0.3), (6e8, 0.1)], gain=0)]),
        "one 6": figure6(one, "q-S", (100e-9,)),
        "one 7": figure7(one, fit_ensemble(one, n_bootstrap=5)),
        "whole 4": figure4([long]),
        "whole 6": figure6(whole, sizes=SIZES),
        "whole 7": figure7(whole),
        "unknown 2": figure2(unknown),
        "quick 8": figure8(quick),
        "one 10": figure10(made_up_pairs(("q-S",), 3)),
        "one 8": figure8(one, "q-S", "BAM2", 100e-9),
        "whole 8": figure8(whole),
        "unknown 8": figure8(unknown),
        "other size 8": figure8(make_table(sizes=PANEL_SIZES, seeds=2)),
        "no cell 6": figure6(quick, sizes=PANEL_SIZES),
        "new type 6": figure6(quick.assign(type="RA"), sizes=SIZES),
        "new type 7": figure7(quick.assign(type="RA")),
    }


@pytest.fixture(scope="module")
def figures():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return full_figures() | sparse_figures()


def drawn_texts(figure, monkeypatch):
    """All texts that a figure really draws, with their boxes in pixels."""
    found = {}
    draw = Text.draw

    def record(text, renderer, *args, **kwargs):
        if text.get_visible() and text.get_text().strip():
            found[id(text)] = (text, text.get_window_extent(renderer))
        draw(text, renderer, *args, **kwargs)

    monkeypatch.setattr(Text, "draw", record)
    styled(figure.draw_without_rendering)()
    monkeypatch.undo()
    return list(found.values())


def words(figure):
    """All that a figure says, in one string."""
    return " | ".join(text.get_text() for text in figure.findobj(Text))


def lines(axes, **wanted):
    """Lines of a panel with these properties."""
    return [
        line for line in axes.get_lines() if all(getattr(line, f"get_{k}")() == value for k, value in wanted.items())
    ]


def test_texts_are_readable(figures, monkeypatch):
    """At print width: 7 points or more, nothing over another text, nothing over the edge."""
    for name, figure in figures.items():
        texts = drawn_texts(figure, monkeypatch)
        assert len(texts) > 5, name
        page = figure.bbox
        for text, box in texts:
            assert text.get_fontsize() >= 7, (name, text)
            inside = box.x0 >= page.x0 - 1 and box.x1 <= page.x1 + 1 and box.y0 >= page.y0 - 1 and box.y1 <= page.y1 + 1
            assert inside, (name, text)
        for (one, box), (other, other_box) in combinations(texts, 2):
            # Boxes that just touch (a pixel) do not disturb.
            apart = (
                box.x1 < other_box.x0 + 1
                or other_box.x1 < box.x0 + 1
                or box.y1 < other_box.y0 + 1
                or other_box.y1 < box.y0 + 1
            )
            assert apart, (name, one, other)


@pytest.mark.parametrize("style", ["normal", "italic"])
def test_fonts_of_the_system_do_not_matter(style, monkeypatch):
    """The same name in another file, in whatever order the system lists them."""
    fonts = font_manager.fontManager
    listed = list(fonts.ttflist)
    foreign = font_manager.FontEntry(fname="/elsewhere/DejaVuSans.ttf", name="DejaVu Sans", style=style)
    monkeypatch.setattr(fonts, "ttflist", [foreign, *reversed(listed)])
    own_fonts_first()
    found = fonts.findfont(font_manager.FontProperties(family="DejaVu Sans", style=style))
    assert Path(found).is_relative_to(matplotlib.get_data_path())


def test_figures_are_as_wide_as_the_columns(figures):
    width = {name: figure.get_figwidth() for name, figure in figures.items()}
    assert {width["figure2"], width["figure6"], width["figure7"], width["figure10"]} == {TWO_COLUMNS}
    assert {width["figure4"], width["one 7"], width["figure8"]} == {ONE_COLUMN}


@pytest.mark.parametrize("drive", ["prescribed", "literal"])
def test_each_figure_names_its_drive(drive):
    table = make_table(sizes=SIZES, seeds=2, drive=drive)
    for figure in (
        figure2(table),
        figure4(cell_of_runs(2, drive)),
        figure6(table, sizes=SIZES),
        figure7(table),
        figure8(table),
    ):
        assert drive_text(drive) in figure.get_suptitle()
    assert "drive: mine" in figure2(table, drive="mine").get_suptitle()


def test_types_differ_in_more_than_colour():
    assert len(set(TYPE_MARKER.values())) == len(TYPE_MARKER) == 3
    grey = [np.dot(to_rgb(colour), (0.299, 0.587, 0.114)) for colour in TYPE_COLOUR.values()]
    assert set(TYPE_COLOUR) == set(TYPE_MARKER) and len(set(np.round(grey, 3))) == 3
    style = type_style(["RA", "BA", "XY"])
    assert len({look["color"] for look in style.values()}) == len({look["marker"] for look in style.values()}) == 3


def test_a_mean_beside_equal_values_by_rounding_is_drawn():
    """The mean of three equal numbers may lie an ulp below them: matplotlib refuses bars of negative length."""
    value = 0.1
    mean = np.nextafter(value, 0)
    cells = pd.DataFrame({"x_mean": [mean, 0.2], "x_minimum": [value, 0.1], "x_maximum": [value, 0.4]})
    axes = Figure().subplots()
    mean_and_range(axes, [1, 2], cells, "x", type_style(["BA"])["BA"])
    (bars,) = axes.containers[0][2]
    np.testing.assert_allclose([segment[:, 1] for segment in bars.get_segments()], [[0.1, 0.1], [0.1, 0.4]])


def test_figure2_shows_means_and_ranges():
    table = make_table(sizes=SIZES, seeds=3)
    cells = cell_statistics(table, by=("type", "a_eff")).set_index(["type", "a_eff"])
    for axes, name in zip(figure2(table).axes[:3], ("n_monomers", "n_contacts", "porosity"), strict=True):
        shift = offsets(SIZES, 3) * 1e9
        for k, (kind, container) in enumerate(zip(("BA", "BAM1", "BAM2"), axes.containers, strict=True)):
            points, _, (bars,) = container
            np.testing.assert_allclose(points.get_xdata(), np.array(SIZES) * 1e9 + shift[k])
            np.testing.assert_allclose(points.get_ydata(), cells.loc[kind][f"{name}_mean"])
            ends = np.array([segment[:, 1] for segment in bars.get_segments()])
            np.testing.assert_allclose(ends[:, 0], cells.loc[kind][f"{name}_minimum"])
            np.testing.assert_allclose(ends[:, 1], cells.loc[kind][f"{name}_maximum"])


def test_figure4_puts_the_dots_at_the_marks():
    runs = cell_of_runs()
    marks = [disruption(run) for run in runs]
    mass, contacts, stress = figure4(runs, marks).axes
    for axes, name in ((mass, "omega_mass_75"), (contacts, "omega_contacts_75"), (stress, "omega_disr")):
        dots = [line.get_xdata()[0] for line in lines(axes, marker="o") if len(line.get_xdata())]
        np.testing.assert_allclose(dots, [float(mark[name]) for mark in marks])
        grains = lines(axes, marker="None", color=TYPE_COLOUR["BAM2"])
        assert len(grains) == 2 * len(runs)  # up to half of the mass, and what is left
        assert sum(line.get_alpha() == 1 for line in grains) == 1  # the grain of median omega_disr
        # the paper's grains: where it has a constant mass
        assert [line.get_xdata()[0] for line in lines(axes, color="black", linestyle="--")] == [3e8]
    heights = [line.get_ydata()[0] for line in lines(mass, marker="o")]
    np.testing.assert_allclose(heights, 0.75 * 4.76)
    assert "10^{-16}" in mass.get_ylabel() and "kg" in mass.get_ylabel()
    assert "paper: mass" in words(mass.figure)
    np.testing.assert_allclose(lines(mass, marker="None")[0].get_ydata()[0], 4.76)


def test_figure4_points_at_the_greatest_gain_of_contacts():
    runs = cell_of_runs()
    (note,) = [text for text in figure4(runs).axes[1].texts]
    last = disruption(runs[-1])  # it gains most
    assert note.xy == (float(last["omega_contacts_max"]), float(last["n_contacts_max"]))
    assert "+10 %" in note.get_text()
    assert "no grain\ngains contacts" in words(figure4([make_run(1e8, gain=0)]))


def test_figures_of_other_grains_have_no_line_of_the_paper():
    run = make_run(3e7, omega_1=5e7, a_eff=200e-9)
    assert "paper: mass" not in words(figure4([run]))
    low, high = figure4([run]).axes[0].get_xlim()
    assert high == pytest.approx(1.1 * run["omega"].values.max()) and low < 3e7


def test_figure4_without_marks_in_the_run():
    figure = figure4([make_run(1e8, end=0.5e8)])
    assert all(np.isnan(line.get_xdata()).all() for axes in figure.axes for line in lines(axes, marker="o"))


def test_figure4_needs_runs():
    with pytest.raises(InputError, match="at least one run"):
        figure4([])
    with pytest.raises(InputError, match="2 runs, but 1 sets of marks"):
        figure4(cell_of_runs(2), [disruption(make_run())])


def test_figure6_counts_oblate_grains():
    table = make_table(seeds=5)
    table.loc[(table["seed"] == 4) & (table["type"] == "BA"), "axis_b_disr"] = np.nan
    figure = figure6(table, "q-S", (350e-9,))
    for kind in ("BA", "BAM1", "BAM2"):
        here = table[(table["material"] == "q-S") & (table["a_eff"] == 350e-9) & (table["type"] == kind)]
        start = sum(
            row.axis_b_start / row.axis_a_start > row.axis_c_start / row.axis_b_start for row in here.itertuples()
        )
        known = here[here["axis_b_disr"].notna()]
        end = sum(row.axis_b_disr / row.axis_a_disr > row.axis_c_disr / row.axis_b_disr for row in known.itertuples())
        (panel,) = [axes for axes in figure.axes if axes.get_title().startswith(f"{kind},")]
        said = [text.get_text() for text in panel.texts]
        assert f"oblate: {start}/5 \N{RIGHTWARDS ARROW} {end}/{4 if kind == 'BA' else 5}" in said
        assert "350 nm, 5 grains" in panel.get_title() and "prolate" in said


def test_figure6_joins_the_axis_ratios_of_a_grain():
    table = make_table(seeds=2)
    figure = figure6(table)
    for row in range(3):
        assert len({(axes.get_xlim(), axes.get_ylim()) for axes in figure.axes[3 * row : 3 * row + 3]}) == 1
    panel = figure.axes[4]
    assert panel.get_title().startswith("BAM1, ") and "350 nm" in panel.get_title()
    here = table[(table["material"] == "a-C") & (table["a_eff"] == 350e-9) & (table["type"] == "BAM1")]
    ratios = {when: axis_ratios(here, when) for when in ("start", "disr")}
    for when, face in (("start", "white"), ("disr", TYPE_COLOUR["BAM1"])):
        (line,) = lines(panel, marker="s", markerfacecolor=face)
        np.testing.assert_allclose(line.get_xdata(), here[f"axis_b_{when}"] / here[f"axis_a_{when}"])
        np.testing.assert_allclose(line.get_ydata(), here[f"axis_c_{when}"] / here[f"axis_b_{when}"])
        np.testing.assert_array_equal(line.get_xydata().T, ratios[when])
        (low, high), (left, right) = panel.get_ylim(), panel.get_xlim()
        assert (line.get_ydata() > low).all() and (line.get_ydata() < high).all()
        assert (line.get_xdata() > left).all() and (line.get_xdata() < right).all()
    joined = [line.get_xydata() for line in lines(panel, marker="None", color=TYPE_COLOUR["BAM1"])]
    np.testing.assert_allclose(joined, np.stack([ratios["start"].T, ratios["disr"].T], axis=1))


def test_the_words_of_figure6_stand_where_no_grain_is(monkeypatch):
    table = make_table(seeds=10)
    # grains all along the diagonal, and some far to either side of it
    ratio = np.linspace(1, 4, len(table))
    table = table.assign(axis_a_disr=1.0, axis_b_disr=ratio, axis_c_disr=ratio**2)
    table.loc[table["seed"] == 0, "axis_c_disr"] = ratio[table["seed"] == 0]
    table.loc[table["seed"] == 1, "axis_b_disr"] = 1.0
    figure = figure6(table)
    texts = drawn_texts(figure, monkeypatch)
    for axes in figure.axes:
        inside = [box for text, box in texts if text.axes is axes and text.get_text().endswith("late")]
        assert len(inside) == 2
        points = np.concatenate([line.get_xydata() for line in axes.get_lines() if line.get_marker() != "None"])
        for x, y in axes.transData.transform(points):
            marker = Bbox.from_extents(x - 4, y - 4, x + 4, y + 4)
            assert not any(marker.overlaps(box) for box in inside)
    prolate, oblate = (next(text for text in axes.texts if text.get_text() == word) for word in ("prolate", "oblate"))
    (x, y), (other_x, other_y) = (
        axes.transData.inverted().transform(axes.transAxes.transform(t.get_position())) for t in (prolate, oblate)
    )
    assert y > x and other_y < other_x  # c/b and b/a


def test_figure7_draws_the_fit_and_the_printed_table():
    table = make_table(seeds=3, scatter=0.0)
    fit = fit_ensemble(table, "own", n_bootstrap=5)
    figure = figure7(table, fit)
    assert [axes.get_title() for axes in figure.axes[:3]] == ["a-C", "q-S", "co-S"]
    panel, m = figure.axes[1], get_material("q-S")
    here = table[(table["material"] == "q-S") & (table["type"] == "BAM2")]
    groups = here.assign(x=np.log(here["n_contacts"] * here["filling_factor"])).groupby("a_eff")
    contacts = np.exp(groups["x"].mean())
    sizes = contacts.index.to_numpy()
    solid, printed = (
        line
        for line in lines(panel, color=TYPE_COLOUR["BAM2"], marker="None")
        if line.get_linestyle() != "None" and len(line.get_xdata()) == len(sizes)
    )
    # Grains on the law: the fitted line is the geometric mean of their omega.
    expected = np.exp(here.assign(y=np.log(here["omega_disr"])).groupby("a_eff")["y"].mean())
    np.testing.assert_allclose(solid.get_ydata(), expected, rtol=1e-9)
    args = (sizes, m.surface_energy, m.density, 20e-9, contacts, 1.0)
    np.testing.assert_allclose(printed.get_ydata(), eq33(*args, *TABLE_3["q-S", "BAM2"]))
    assert (solid.get_linestyle(), printed.get_linestyle()) == ("-", "--")
    (signs,) = lines(panel, color=TYPE_COLOUR["BAM2"], markerfacecolor="white")  # of the printed line
    assert signs.get_marker() == TYPE_MARKER["BAM2"] and len(signs.get_xdata()) > 2
    on_it = np.exp(np.interp(signs.get_xdata(), printed.get_xdata(), np.log(printed.get_ydata())))
    np.testing.assert_allclose(signs.get_ydata(), on_it)


def test_figure7_has_the_ratio_to_the_printed_table_below():
    table = make_table(seeds=5)
    figure = figure7(table)
    panel, m = figure.axes[4], get_material("q-S")
    here = table[(table["material"] == "q-S") & (table["type"] == "BAM1")]
    args = here["a_eff"], m.surface_energy, m.density, 20e-9, here["n_contacts"], here["filling_factor"]
    ratio = (here["omega_disr"] / eq33(*args, *TABLE_3["q-S", "BAM1"])).groupby(here["a_eff"])
    points, _, (bars,) = panel.containers[1]
    np.testing.assert_allclose(points.get_ydata(), ratio.median())
    ends = np.array([segment[:, 1] for segment in bars.get_segments()])
    for k, part in enumerate((1 / 6, 5 / 6)):
        np.testing.assert_allclose(ends[:, k], ratio.quantile(part))
    other = figure7(table.assign(material="forsterite"))
    assert "no grain that Table 3 has" in words(other)


def test_figure7_numbers_both_ends_of_ratios_that_differ_little(monkeypatch):
    table = make_table(seeds=2, scatter=0.0)
    paper = eq33_omega(table, TABLE_3, 20e-9)
    few = {"BA": 0.35, "BAM1": 1.0, "BAM2": 1.8}
    figure = figure7(table.assign(omega_disr=paper * table["type"].map(few)))
    axes = figure.axes[3]
    shown = {
        text.get_text() for text, _ in drawn_texts(figure, monkeypatch) if text in axes.get_yticklabels(minor=True)
    }
    shown |= {text.get_text() for text in axes.get_yticklabels()}
    assert {"0.5", "0.7", "1", "2"} <= shown


def test_figure7_takes_what_needs_no_spin_up_from_all_grown_grains():
    grown = make_table(seeds=6)
    table = grown[grown["seed"] < 2]
    panel = figure7(table, grown=grown).axes[1]
    here = grown[(grown["material"] == "q-S") & (grown["type"] == "BA")]
    m = get_material("q-S")
    contacts = np.exp(np.log(here["n_contacts"] * here["filling_factor"]).groupby(here["a_eff"]).mean())
    (printed,) = lines(panel, color=TYPE_COLOUR["BA"], linestyle="--")
    args = (contacts.index.to_numpy(), m.surface_energy, m.density, 20e-9, contacts, 1.0)
    np.testing.assert_allclose(printed.get_ydata(), eq33(*args, *TABLE_3["q-S", "BA"]))
    # the markers are those of the grains that were spun up
    (bars,) = [c for c in panel.containers if c[0].get_marker() == "o"]
    expected = table[(table["material"] == "q-S") & (table["type"] == "BA")].groupby("a_eff")["omega_disr"].mean()
    np.testing.assert_allclose(bars[0].get_ydata(), expected)
    assert f"{len(grown)} grown grains" in words(figure7(table, grown=grown))
    assert f"{len(table)} grown grains" in words(figure7(table))


def test_figure7_goes_without_a_fit():
    table = make_table(sizes=SIZES, seeds=2)
    n = [
        sum(line.get_linestyle() == "-" for line in lines(figure7(table, fit).axes[0], marker="None"))
        for fit in (None, fit_ensemble(table, n_bootstrap=5))
    ]
    assert n == [0, 3]


def test_figure8_scales_what_has_no_absolute_value():
    table = make_table(("co-S",), ("BAM2",), seeds=4)
    cells, material = cell_statistics(table), get_material("co-S")
    curves, anchor = predictions(cells, material, 100e-9)
    at = cells["a_eff"] == 100e-9
    phi = cells["filling_factor_mean"]
    for name, exponent in (("S13 low", 1.6), ("S13 high", 1.9), ("T19", 1.8)):
        assert anchor[name] == 100e-9
        np.testing.assert_allclose(curves[name][at], cells["omega_disr_mean"][at])
        unit = curves[name] * cells["a_eff"] / phi ** (exponent / 2)  # omega ~ sqrt(S)/a_eff
        np.testing.assert_allclose(unit, unit.iloc[0])
    strength = tensile_strength_tatsuuma2019(
        material.surface_energy, cells["mean_monomer_radius_mean"].to_numpy(), phi.to_numpy()
    )
    np.testing.assert_allclose(curves["absolute"], 2 / cells["a_eff"] * np.sqrt(strength / material.density))
    panel = figure8(table).axes[0]
    (black,) = lines(panel, color="#000000")
    np.testing.assert_allclose(black.get_ydata(), curves["absolute"])
    (band,) = panel.collections[:1]
    low, high = curves[["S13 low", "T19", "S13 high"]].min(axis=1), curves[["S13 low", "T19", "S13 high"]].max(axis=1)
    drawn = band.get_paths()[0].vertices
    assert np.isclose(drawn[:, 1], low.iloc[-1]).any() and np.isclose(drawn[:, 1], high.iloc[-1]).any()


def test_figure8_has_eq_33_as_fitted_and_as_printed():
    table = make_table(("co-S",), ("BAM2",), seeds=4, scatter=0.0)
    figure = figure8(table, fit=fit_ensemble(table, "own", n_bootstrap=5))
    panel, m = figure.axes[0], get_material("co-S")
    (fitted,) = lines(panel, color=TYPE_COLOUR["BAM2"], linestyle="-")
    groups = table.assign(y=np.log(table["omega_disr"])).groupby("a_eff")
    np.testing.assert_allclose(fitted.get_ydata(), np.exp(groups["y"].mean()), rtol=1e-9)
    (printed,) = lines(panel, color=TYPE_COLOUR["BAM2"], linestyle="--")
    args = table["a_eff"], m.surface_energy, m.density, 20e-9, table["n_contacts"], table["filling_factor"]
    own = pd.Series(np.log(eq33(*args, *TABLE_3["co-S", "BAM2"]))).groupby(table["a_eff"]).mean()
    np.testing.assert_allclose(printed.get_ydata(), np.exp(own))
    assert {"Eq. 33 fitted", "Eq. 33 as printed"} <= {text.get_text() for text in panel.texts}
    assert "Eq. 33 fitted" not in words(figure8(table)) and not figure.legends


def test_figure8_says_where_it_scales_instead():
    table = make_table(("co-S",), ("BAM2",), (100e-9, 150e-9, 200e-9), 3)
    table.loc[table["a_eff"] == 100e-9, "fractal_dimension"] = np.nan
    _, anchor = predictions(cell_statistics(table), get_material("co-S"), 100e-9)
    assert anchor["T19 fractal"] == 150e-9 and anchor["T19"] == 100e-9
    assert words(figure8(table)).count("scaled at 150 nm") == 1
    nothing, anchor = predictions(cell_statistics(table.assign(omega_disr=np.nan)), get_material("co-S"), 100e-9)
    assert nothing["T19"].isna().all() and np.isnan(anchor["T19"]) and nothing["absolute"].notna().all()


def test_figure8_draws_the_lines_of_the_grown_grains():
    grown = make_table(("co-S",), ("BA", "BAM2"), seeds=6)
    table = grown[grown["seed"] < 2]
    panel = figure8(table, grown=grown).axes[0]
    here, constants = (every[every["type"] == "BAM2"] for every in (table, grown)), get_material("co-S")
    few, every = here
    for drawn, rows in ((panel, every), (figure8(table).axes[0], few)):
        curves, _ = predictions(cell_statistics(few), constants, 100e-9, rows)
        (black,) = lines(drawn, color="#000000")
        np.testing.assert_allclose(black.get_ydata(), curves["absolute"])
    assert f"{len(every)} grown grains" in words(figure8(table, grown=grown))


def test_figure10_has_the_materials_in_the_order_of_the_other_figures():
    pairs = made_up_pairs(("q-S", "co-S", "a-C"), 3)
    assert [axes.get_title() for axes in figure10(pairs).axes[:3]] == ["a-C", "q-S", "co-S"]


def test_the_lines_of_figure10_are_not_hidden():
    pairs = made_up_pairs(("q-S",))
    figure = figure10(pairs)
    top, bottom = figure.axes
    # that few are shown is told, and how the pairs were spun up
    assert "80 pairs" in figure.get_suptitle() and "above 9 of them" in figure.get_suptitle()
    assert "$f$ = 0.05" in figure.get_suptitle() and words(figure).count(r"$\epsilon$ = 0.005") == 2
    for marker, start in (("o", "damped"), ("s", "undamped")):
        (few,), (every,) = (lines(axes, marker=marker) for axes in (top, bottom))
        here = pairs[pairs["start"] == start]
        assert len(few.get_xdata()) == 9 and len(every.get_xdata()) == len(here) == 80
        radius = here["monomer_radius"].to_numpy() * 1e9
        place = [np.argmin(np.abs(radius - x)) for x in few.get_xdata()]
        np.testing.assert_allclose(few.get_ydata(), here["parting_omega"].to_numpy()[place])
        assert all(line.get_zorder() > few.get_zorder() for line in lines(top, marker="None"))


def test_figure2_shows_fractal_dimensions_of_grains_with_monomers_enough():
    table = make_table(seeds=3)
    table.loc[table["n_monomers"] < 30, "fractal_dimension"] = 8.0
    panel = figure2(table).axes[3]
    assert panel.get_ylim()[1] < 4 and "30 monomers" in words(panel.figure)
    drawn = np.concatenate([container[0].get_ydata() for container in panel.containers])
    assert len(drawn) and drawn.max() < 3.5
    few = figure2(make_table(sizes=(50e-9,), seeds=2))
    assert "no grain of 30 monomers" in words(few)


def test_names_at_the_ends_of_lines_stand_apart_and_in_order():
    axes = Figure().subplots()
    axes.set_ylim(0, 1)
    label_ends(axes, [("a", 0.5, "k"), ("b", 0.505, "k"), ("c", 0.9, "k"), ("d", np.nan, "k"), ("e", 0.495, "k")], 0.1)
    heights = {text.get_text(): text.get_position()[1] for text in axes.texts}
    assert heights == {text: pytest.approx(y) for text, y in (("e", 0.4), ("a", 0.5), ("b", 0.6), ("c", 0.9))}


def test_medians_and_two_thirds():
    rng, axes = np.random.default_rng(2), Figure().subplots()
    a_eff = pd.Series(np.repeat([50e-9, 100e-9], 200)) * (1 + 1e-9 * rng.uniform(-1, 1, 400))
    values = pd.Series(rng.lognormal(0, 0.3, 400))
    values[3] = np.nan
    found = middle_and_most(axes, a_eff, values, type_style(["BA"])["BA"])
    np.testing.assert_allclose(found["a_eff"], [50e-9, 100e-9], rtol=1e-3)
    for row, part in zip(found.itertuples(), (values[:200].dropna(), values[200:]), strict=True):
        assert row.middle == np.median(part) and (part < row.low).mean() == pytest.approx(1 / 6, abs=0.01)
        assert (part > row.high).mean() == pytest.approx(1 / 6, abs=0.01)
    nothing = middle_and_most(axes, a_eff, values * np.nan, {})
    assert list(nothing) == ["a_eff", "low", "middle", "high"] and not len(nothing)


@pytest.mark.parametrize(
    "values, expected",
    [([4.76e-16, 1e-17], -16), ([2e12], 12), ([500.0], 0), ([0.0, np.nan], 0), ([], 0), ([1e5], 5)],
)
def test_power_of_ten(values, expected):
    exponent, text = power_of_ten(values)
    assert exponent == expected and (f"{{{expected}}}" in text) == (expected != 0)


@pytest.mark.parametrize("at", [0.03, 0.5, 0.97])
def test_arrow_and_its_text_stay_in_the_panel(at, monkeypatch):
    run = make_run(1e8, gain=0)
    k = np.flatnonzero(run["omega"].values < 0.4e8)[-1] if at < 0.1 else int(at * (run.sizes["record"] - 1))
    run["n_contacts"].values[k] = 2 * run.attrs["initial_n_contacts"]
    figure = figure4([run])
    (box,) = [box for text, box in drawn_texts(figure, monkeypatch) if "greatest" in text.get_text()]
    panel = figure.axes[1].bbox
    assert panel.x0 <= box.x0 and box.x1 <= panel.x1 and panel.y0 <= box.y0 and box.y1 <= panel.y1


@pytest.mark.parametrize("values, expected", [([15.0], "10"), ([3e8, 9e8], r"$5\times10^{8}$"), ([1, 1e4], "$10^{4}$")])
def test_logarithmic_axes_have_room_and_numbers(values, expected, monkeypatch):
    figure = Figure()
    axes = figure.subplots()
    axes.set_yscale("log")
    axes.plot(range(len(values)), values, "o")
    logarithmic(axes.yaxis)
    low, high = axes.get_ylim()
    assert low < min(values) and high > max(values) and np.log10(high / low) >= 0.6 - 1e-9
    assert expected in [text.get_text() for text, _ in drawn_texts(figure, monkeypatch)]


def test_half_a_decade_has_more_numbers(monkeypatch):
    axes = (figure := Figure()).subplots()
    axes.set_yscale("log")
    axes.plot([2.6e8, 4.2e8], "o")
    logarithmic(axes.yaxis, least=0.4)
    texts = [text.get_text() for text, _ in drawn_texts(figure, monkeypatch)]
    assert {rf"${digit}\times10^{{8}}$" for digit in (3, 4, 5)} <= set(texts)


def test_settings_of_the_user_stay(tmp_path):
    with matplotlib.rc_context({"font.size": 31, "axes.facecolor": "red"}):
        figure = figure2(make_table(sizes=SIZES, seeds=1))
        save(figure, tmp_path / "a.png")
        assert matplotlib.rcParams["font.size"] == 31
        assert figure.axes[0].get_facecolor()[:3] == (1.0, 1.0, 1.0)


def test_save_names_the_suffix_it_does_not_know(tmp_path):
    with pytest.raises(InputError, match="must end in .pdf, .png or .svg"):
        save(figure4([make_run()]), tmp_path / "figure.bmp")
    assert not list(tmp_path.iterdir())


def save_some(folder):
    """Two figures that between them use all that the others use."""
    table = make_table(sizes=SIZES, seeds=2)
    for name, figure in {
        "figure4": figure4(cell_of_runs(2)),
        "figure7": figure7(table, fit_ensemble(table, n_bootstrap=5)),
    }.items():
        save(figure, Path(folder) / f"{name}.pdf", Path(folder) / f"{name}.png")


SCRIPT = """
import sys
sys.path[:0] = sys.argv[1:3]
from test_figures import save_some
save_some(sys.argv[3])
"""


def test_files_repeat_to_the_last_byte(tmp_path):
    """Also in another process, with other hashes of strings."""
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    there.mkdir()
    environment = os.environ | {"PYTHONHASHSEED": "4711", "SOURCE_DATE_EPOCH": "1"}
    arguments = [sys.executable, "-c", SCRIPT, str(Path(__file__).parent), str(Path(__file__).parents[2]), str(there)]
    subprocess.run(arguments, check=True, env=environment)
    save_some(here)
    digests = [
        {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}
        for folder in (here, there)
    ]
    assert digests[0] == digests[1] and len(digests[0]) == 4
    content = (here / "figure7.pdf").read_bytes()
    assert content.startswith(b"%PDF-") and b"CreationDate" not in content
