"""The figures of documents: what is drawn from made-up grains and fragments with known answers."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from ratd.base.errors import InputError
from ratd.base.materials import get_material
from ratd.experiments.spin_up.eq33 import eq33_omega
from ratd.experiments.spin_up.figures.fragments import GREATEST, cumulative, fragments
from ratd.experiments.spin_up.figures.law import law
from ratd.experiments.spin_up.figures.overview import over_the_paper, overview
from ratd.experiments.spin_up.figures.style import TYPE_COLOUR, TYPE_MARKER, open_markers
from ratd.experiments.spin_up.findings.law import of_curve
from ratd.experiments.spin_up.fragmentation import mass_shares, size_class
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS, TABLE_3
from ratd.experiments.spin_up.size_law import SPLIT, size_law_unit
from ratd.pictures.style import ONE_COLUMN, TWO_COLUMNS
from synthetic_runs import make_fragments, make_table

FACTOR = {"BA": 0.02, "BAM1": 0.05, "BAM2": 0.1}


@pytest.fixture(scope="module")
def table():
    """Grains whose omega is a known part of that of the paper, with a scatter by seed that leaves the median alone."""
    made = make_table(seeds=7)
    scatter = np.exp(0.1 * (made["seed"] - 3))
    paper = eq33_omega(made, TABLE_3, PAPER_MEAN_RADIUS)
    return made.assign(omega_mass_75=paper * made["type"].map(FACTOR) * scatter)


def bounds(table, factor=2.0):
    keys = table[["material", "type", "a_eff", "seed"]]
    paper = eq33_omega(table, TABLE_3, PAPER_MEAN_RADIUS)
    # in another order, and with the last digits of another computation
    return keys.assign(firm_bound=factor * paper * table["type"].map(FACTOR), a_eff=keys["a_eff"] * (1 + 1e-12))[::-1]


def markers(axes, kind):
    """Line and bars of one type."""
    (found,) = [c for c in axes.containers if c[0].get_marker() == TYPE_MARKER[kind]]
    return found[0], found[2][0]


def test_overview_has_the_median_and_two_thirds_over_the_paper(table):
    (axes,) = overview(table).axes
    for kind, factor in FACTOR.items():
        points, bars = markers(axes, kind)
        np.testing.assert_allclose(points.get_ydata().astype(float), factor)
        ends = np.array([segment[:, 1] for segment in bars.get_segments()]) / factor
        assert (ends[:, 0] < np.exp(-0.1)).all() and (ends[:, 1] > np.exp(0.1)).all()
        assert (ends[:, 0] > np.exp(-0.3)).all() and (ends[:, 1] < np.exp(0.3)).all()
    assert {text.get_text() for text in axes.texts} == set(FACTOR)


def test_bars_of_overview_do_not_overlap_and_its_axis_is_labelled_below_a_tenth(table):
    figure = overview(table)
    (axes,) = figure.axes
    places = np.sort(np.concatenate([markers(axes, kind)[0].get_xdata() for kind in FACTOR]))
    assert np.diff(places).min() > 8  # nm, of 50 from size to size
    figure.draw_without_rendering()
    low, high = axes.get_ylim()
    ticks = zip(axes.get_yticks(minor=True), axes.get_yticklabels(minor=True), strict=True)
    named = {text.get_text() for value, text in ticks if low < value < high}
    assert {"0.02", "0.05", "0.2", "0.5"} <= named


def test_overview_has_a_bound_a_type_and_a_panel_for_the_other_drive(table):
    literal = table.assign(drive="literal", omega_mass_75=10 * table["omega_mass_75"])
    figure = overview(table, literal, bounds(table), table)
    left, right = figure.axes
    assert left.get_ylim() == right.get_ylim() and figure.get_figwidth() == TWO_COLUMNS
    assert "driven" in left.get_title() and "printed terms" in right.get_title()
    for kind, factor in FACTOR.items():
        np.testing.assert_allclose(markers(right, kind)[0].get_ydata().astype(float), 10 * factor)
        for axes in (left, right):
            (line,) = [x for x in axes.get_lines() if x.get_color() == TYPE_COLOUR[kind] and x.get_linestyle() == "--"]
            np.testing.assert_allclose(line.get_ydata(), 2 * factor)
            # told apart without colour, and by no sign that hides a point
            (sign,) = [
                x for x in axes.get_lines() if x.get_markerfacecolor() == "white" and x.get_color() == line.get_color()
            ]
            assert sign.get_marker() == TYPE_MARKER[kind] and len(sign.get_xdata()) > 2
            np.testing.assert_allclose(sign.get_ydata(), 2 * factor)
            assert np.abs(np.subtract.outer(sign.get_xdata(), markers(axes, kind)[0].get_xdata())).min() > 20
    (legend,) = figure.legends
    assert sum("bound" in text.get_text() for text in legend.texts) == 1
    assert not any("bound" in text.get_text() for text in overview(table, literal).legends[0].texts)


def test_open_markers_lie_on_the_line_whatever_its_length():
    for n in range(5):
        axes = Figure().subplots()
        x = np.arange(1.0, n + 1.0)
        open_markers(axes, x, 10.0**x, {"marker": "o", "color": "black"})
        (signs,) = axes.get_lines()
        np.testing.assert_allclose(np.log10(signs.get_ydata()), signs.get_xdata())
        assert len(signs.get_xdata()) == (n > 1)


def test_overview_needs_a_grain_that_the_paper_has(table):
    assert over_the_paper(table.assign(material="forsterite"), "omega_mass_75").isna().all()
    with pytest.raises(InputError, match="omega_mass_75"):
        overview(table.assign(material="forsterite"))


def test_law_draws_the_curve_that_made_the_grains():
    table = make_table(seeds=3)
    x = np.log(table["a_eff"] / SPLIT)
    bend = table["type"].map({"BA": -0.2, "BAM1": 0.0, "BAM2": 0.1})
    omega = 0.5 * size_law_unit(table) * np.exp(-1.5 * x - bend * x**2)
    figure = law(table.assign(omega_mass_75=omega))
    top, *strips = figure.axes
    assert figure.get_figwidth() == ONE_COLUMN and len(strips) == 3
    said = [text.get_text() for text in top.texts]
    assert any("BA\n" in text and "−0.20 ± 0.00" in text for text in said)
    assert any("BAM1\n" in text and "$q$ = 0.00" in text for text in said)
    sizes = np.unique(table["a_eff"])
    for strip, kind in zip(strips, FACTOR, strict=True):
        points = markers(strip, kind)[0].get_ydata()
        straight = kind == "BAM1"
        assert (np.abs(points - 1).max() < 1e-9) == straight  # what the straight law leaves
        (curve,) = [line for line in strip.get_lines() if len(line.get_xdata()) == 60]
        np.testing.assert_allclose(np.interp(sizes * 1e9, *curve.get_data()), points, rtol=2e-3)
    assert len({strip.get_ylim() for strip in strips}) == 1


def test_q_is_told_of_larger_grains_too():
    """The means of 50 nm are off the curve of the others."""
    table = make_table(seeds=3).assign(nm=lambda own: own["a_eff"] * 1e9, n_contacts=100.0)
    x = np.log(table["a_eff"] / SPLIT)
    small = table["nm"].round() == table["nm"].round().min()
    omega = 0.5 * size_law_unit(table) * np.exp(-1.5 * x + 0.2 * x**2) * np.where(small, 0.7, 1.0)
    values = of_curve(table.assign(omega_mass_75=omega), table)
    assert values["curve.BA q from 100"].value == pytest.approx(-0.2)
    assert values["curve.BA q from 150"].value == pytest.approx(-0.2)
    assert values["curve.BA q"].value > -0.15


def test_law_needs_three_sizes():
    with pytest.raises(InputError, match="three sizes"):
        law(make_table(sizes=(100e-9, 200e-9), seeds=3))


def test_fragments_are_counted_by_the_grain():
    table = pd.DataFrame(
        {
            "grain": [0, 0, 0, 1],
            "mass_fraction": [0.01, 0.2, 0.3, 0.5],
            "fragment_n_monomers": [1, 10, 11, 2],
            "weight": [1.0, 1.0, 1.0, 1.0],
        }
    )
    found = cumulative(table)
    assert found["mass_fraction"].tolist() == [0.01, 0.2, 0.3, 0.5]
    assert found["number"].tolist() == [2.0, 1.5, 1.0, 0.5]
    assert cumulative(table.assign(weight=[1.5, 1.5, 1.5, 0.5]))["number"].tolist() == [2.5, 1.75, 1.0, 0.25]
    found = [share.value for share in mass_shares(table, GREATEST).values()]
    assert found == pytest.approx([0.01 / 1.01, 0.7 / 1.01, 0.3 / 1.01])


def test_fragments_tell_the_greatest_error_of_their_bars():
    table = make_fragments()
    part = table[table["half"] & (size_class(table["a_eff"]) == "50 to 150 nm")]
    most = max(error for kind in FACTOR for _, error in mass_shares(part[part["type"] == kind], GREATEST).values())
    assert f"standard errors up to {100 * most:.2g}" in fragments(table, "prescribed").axes[3].get_xlabel()


def test_fragments_have_a_column_a_class_and_the_slope_of_the_power_law():
    table = make_fragments()
    figure = fragments(table, "prescribed")
    top, bottom = figure.axes[:3], figure.axes[3:]
    assert [axes.get_title().split(",")[0] for axes in top] == ["50 to 150 nm", "200 to 350 nm", "400 to 550 nm"]
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in top}) == 1
    for axes in top:
        (slope,) = [line for line in axes.get_lines() if len(line.get_xdata()) == 2]
        (x, end), (y, last) = slope.get_data()
        assert np.log(last / y) / np.log(end / x) == pytest.approx(-5 / 6)
        assert sum(line.get_color() in TYPE_COLOUR.values() for line in axes.get_lines()) == 3
    for axes in bottom:
        lengths = np.array([bar.get_width() for bar in axes.patches]).reshape(3, 3)
        np.testing.assert_allclose(lengths.sum(axis=1), 100)
    assert "driven" in figure.get_suptitle() and "first half" in figure.get_suptitle()
    one = fragments(table[table["a_eff"] < 100e-9])
    assert len(one.axes) == 2 and "drive" not in one.get_suptitle()
    with pytest.raises(InputError, match="at least one fragment"):
        fragments(table.assign(half=False))


def test_the_unit_of_the_law_is_that_of_the_material():
    table = make_table(seeds=1)
    for name, part in table.groupby("material"):
        material = get_material(name)
        expected = np.sqrt(material.surface_energy / (material.density * 300e-9**3))
        np.testing.assert_allclose(size_law_unit(part), expected)
