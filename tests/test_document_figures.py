"""Figures of docs/reproduction.md that the paper does not have, and the captions of all its figures."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text
from ratd.reproduction import figures
from ratd.reproduction.bounds import ratios, table3_omega
from ratd.reproduction.captions import CAPTIONS
from ratd.reproduction.data import DRAWN_STUDIES
from ratd.validation.show import lammps, literal

from ratd.base.statistics import median_of
from ratd.experiments.spin_up.calibration import CALIBRATION_COLUMNS, calibrate
from ratd.experiments.spin_up.cells import cell_of
from ratd.experiments.spin_up.figures import calibration
from ratd.experiments.spin_up.figures.calibration import SPREAD
from ratd.experiments.spin_up.fragmentation import STAGES
from ratd.pictures.style import TYPE_MARKER
from ratd.validation.lammps import COLUMNS as LAMMPS_COLUMNS
from ratd.validation.lammps import TURNING
from ratd.validation.literal import COLUMNS as LITERAL_COLUMNS
from synthetic_runs import make_table

REPORT = Path(__file__).parents[1] / "workflow" / "report"


def words(figure):
    """All that a figure says, in one string."""
    return " | ".join(text.get_text() for text in figure.findobj(Text))


def made_up_fragments(types=("BA", "BAM1", "BAM2"), number=200):
    """Fragments of one drive, with a few that are far smaller than the others."""
    rng = np.random.default_rng(5)
    mass = np.where(np.arange(number) == 0, 1e-9, 0.5 * rng.uniform(0.02, 1, number))
    return pd.concat(
        pd.DataFrame({"type": kind, "mass_fraction": mass, "weight": 1.0} | dict.fromkeys(STAGES, True))
        for kind in types
    )


@pytest.mark.parametrize(
    ("draw", "column"), [(figures.bound, "found_over_bound"), (figures.overview, "found_over_printed")]
)
def test_cells_count_alike_in_the_medians_of_ratios(draw, column):
    """Not the grains, of which one material has ten times as many."""
    grown = make_table(sizes=(100e-9, 150e-9), seeds=10)
    few = grown[(grown["material"] == "a-C") | (grown["seed"] == 0)].reset_index(drop=True)
    few.loc[few["material"] == "a-C", "omega_disr"] *= 5
    panel = draw(grown, {"prescribed": few}).axes[0]
    (drawn,) = [c for c in panel.containers if c[0].get_marker() == figures.DRIVE_LOOK["prescribed"]["marker"]]
    table = ratios(few)
    for size, y in zip((100e-9, 150e-9), drawn[0].get_ydata(), strict=True):
        part = table[(table["type"] == "BA") & np.isclose(table["a_eff"], size)]
        expected = median_of(part[column], cell=cell_of(part))
        assert y == expected["median"] != part[column].median()
        (segment,) = [s for s in drawn[2][0].get_segments() if np.isclose(s[0, 0], size * 1e9)]
        np.testing.assert_allclose(segment[:, 1], [expected["low"], expected["high"]])


def test_the_firm_bound_is_drawn_where_it_is_known():
    """In the overview as the printed Eq. 33 goes into it."""
    grown = make_table(sizes=(100e-9, 150e-9), seeds=3)
    firm = grown.assign(firm_bound=0.5 * table3_omega(grown))
    for draw in (figures.overview, figures.bound):
        assert "firm bound" in words(draw(firm, {})) and "firm bound" not in words(draw(grown, {"prescribed": grown}))
    for axes in figures.overview(firm, {}).axes:
        (drawn,) = axes.containers
        np.testing.assert_allclose(drawn[0].get_xydata(), [[100, 0.5], [150, 0.5]])


def test_lines_of_fragments_differ_in_more_than_colour():
    table = made_up_fragments()
    drawn = figures.fragments({"prescribed": table, "literal": table})
    assert r"up to $\omega_\mathrm{disr}$" in words(drawn) and "omega_disr" not in words(drawn)
    for axes in drawn.axes:
        looks = [(line.get_marker(), line.get_linestyle(), line.get_markerfacecolor()) for line in axes.lines]
        assert len(set(looks)) == len(looks) == 6
        assert {line.get_marker() for line in axes.lines} == set(TYPE_MARKER.values())
        # the smallest fragment alone would leave most of the axis empty
        assert 1e-3 < axes.get_xlim()[0] < 0.05 and axes.get_xlim()[1] > table["mass_fraction"].max()


def test_runs_with_one_rate_stand_side_by_side():
    rows = [
        dict.fromkeys(CALIBRATION_COLUMNS, 1.0)
        | {"material": "q-S", "type": "BAM2", "end_reason": "", "seed": seed, "a_eff": 350e-9}
        | {"printed_acceleration": rate, "timestep_factor": f}
        | {name: (1 + 0.02 * seed) * rate**0.3 * 3e4 for name in figures_marks()}
        for seed in range(4)
        for rate, f in ((2e13, 0.05), (2e13, 0.125), (4e13, 0.125))
    ]
    table = pd.DataFrame(rows)
    figure = calibration(table, calibrate(table, 3e8))
    assert "12 runs of 4 grains" in figure.get_suptitle()
    (line,) = [one for one in figure.axes[0].get_lines() if one.get_label() == "1 % of the mass lost"]
    x = np.sort(line.get_xdata())
    assert len(x) == 12 and min(b / a for a, b in pairwise(x)) > SPREAD - 1e-6
    np.testing.assert_allclose([x[:8].prod() ** (1 / 8), x[8:].prod() ** (1 / 4)], [2e13, 4e13])
    figure.draw_without_rendering()
    shown = [text.get_text() for text in figure.axes[0].get_xticklabels(which="both") if text.get_text()]
    assert len(shown) > 2


def figures_marks():
    """Columns with the marks of a run of the calibration."""
    return [name for name in CALIBRATION_COLUMNS if name.startswith("omega")]


def made_up_lammps():
    """Both studies, a grain of each of two types; all codes give the same."""
    row = dict.fromkeys(LAMMPS_COLUMNS, np.nan) | {"material": "q-S", "version": "1"}
    force = {"study": "force", "path": "withdrawal", "equilibrium_overlap": 1.0, "pull_off_force": 1.0}
    rows = [
        row | force | {"code": code, "radius_1": 1e-8, "radius_2": 1e-8, "overlap": x, "normal_force": x}
        for code in ("ratd", "LAMMPS")
        for x in (0.0, 1.0)
    ]
    rows += [
        row | {"study": "rotation", "path": path, "code": code, "type": kind, "a_eff": 1e-7, "seed": 0}
        | {"omega": omega, "mass_left": left, "mass_half_way": left, "cut_bound": 1e8, "rotations": 1.0}
        for path, codes in (("sudden", ("ratd", "LAMMPS", TURNING)), ("driven", ("ratd", TURNING)))
        for code in codes
        for kind in ("BA", "BAM2")
        for omega, left in ((1e8, 1.0), (1.02e8, 0.9), (1.2e8, 0.9), (1.22e8, 0.5))
    ]  # fmt: skip
    return pd.DataFrame(rows)


def test_panels_of_lammps_say_what_is_done():
    drawn = lammps.draw(made_up_lammps())
    titles = [axes.get_title() for axes in drawn.axes[1:]]
    assert len(set(titles)) == 3 and not any("sudden" in title or "driven;" in title for title in titles)
    assert "set into rotation at once" in titles[0] and "inertial frame" in titles[0]
    assert "outer torque" in titles[2] and "frame that turns" in titles[2]


def made_up_literal():
    """One grain of each of two types with the consistent drive and, in all ways, with the literal one."""
    grains = [{"material": "q-S", "type": kind, "a_eff": 1e-7, "seed": 0} for kind in ("BA", "BAM2")]
    marks = dict.fromkeys(("omega_disr", "omega_first_loss", "omega_mass_75"))
    rows = []
    for grain in grains:
        row = dict.fromkeys(LITERAL_COLUMNS, np.nan) | grain
        row |= {"spin_share": 0.05, "timestep_factor": 0.1, "turned": 9e7, "stretched": 1.5}
        rows.append(row | {"drive": "prescribed"} | dict.fromkeys(marks, 1e8))
        rows += [
            row | {"drive": "literal", "coriolis": term, "angular_acceleration": rate, "timestep": 1e-12}
            | dict.fromkeys(marks, (rate / 1e-12) ** (1 / 3))
            for term in ("explicit", "exact")
            for rate in (1e14, 1e15)
        ]  # fmt: skip
    return pd.DataFrame(rows)


def test_figure_of_the_literal_drive_has_the_symbols_of_its_text():
    drawn = literal.draw(made_up_literal())
    labels = [drawn.axes[0].get_xlabel(), drawn.axes[0].get_ylabel()]
    assert all(r"\mathrm{d}\omega/\mathrm{d}t" in label for label in labels)
    assert r"\dot" not in words(drawn) and r"\Delta" not in words(drawn)
    (legend,) = drawn.legends
    shown = dict(zip([text.get_text() for text in legend.texts], legend.legend_handles, strict=True))
    (solid,) = [handle for label, handle in shown.items() if label.startswith("solid grain")]
    assert solid.get_color() == "black" and "as fast as in the consistent model" in shown


def test_figure_of_the_literal_drive_sets_what_turns_a_grain_beside_how_it_stretches():
    right = literal.draw(made_up_literal()).axes[1]
    (dashed,) = [line for line in right.lines if line.get_linestyle() == "--"]
    np.testing.assert_allclose(dashed.get_xdata(), dashed.get_ydata())
    markers = np.concatenate([line.get_xydata() for line in right.lines if line.get_marker() in TYPE_MARKER.values()])
    np.testing.assert_allclose(markers, [[1.5, 1.5 * 0.9]] * 4)


def test_text_of_the_literal_drive_tells_how_fast_grains_turn():
    text = literal.tell(made_up_literal())
    assert "| 0.0500 | 7.32 | 1.35 | 1.5 | 0.9 |" in text
    assert ": BA 0.9 (0.90–0.90), 1.35 (1.35–1.35); BAM2 0.9" in text
    table = made_up_literal()
    kept = table.assign(omega_first_loss=table["omega_first_loss"].where(table["drive"] == "prescribed"))
    assert literal.tell(kept).endswith("No grain lost mass in these runs.")
    assert not [line for line in literal.draw(kept).axes[1].lines if line.get_linestyle() == "--"]


def test_every_figure_that_the_paper_does_not_have_has_a_caption():
    assert set(CAPTIONS) == {"overview", "bound", "fragments", "calibration", "formulae", *DRAWN_STUDIES}
    for name, caption in CAPTIONS.items():
        drawn, see = caption.split("\n\n")
        assert see.startswith("What to see: ") and see.endswith(".") and drawn.endswith("."), name
        assert len(drawn) > 200 and "  " not in caption and "{" not in caption, name


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("figure2", "come from grains of a few monomers"),
        ("figure5", "the grain lags behind"),
        ("figure6", "the paper finds that BAM grains, which hold together longer, deform more"),
        ("figure6", "sizes with few of them, as the titles say, show few crosses"),
        ("figure7", "the grown grains that the legend counts"),
        ("figure8", "median fractal dimension"),
        ("figure8", "fractal dimensions of 3 and more"),
        ("figure9", "Where grains of several sizes were spun up"),
        ("figure9", "with the paper's values"),
    ],
)
def test_captions_say_what_a_reader_may_stumble_over(name, said):
    text = " ".join((REPORT / f"{name}.rst").read_text(encoding="utf-8").split())
    assert said in text and "What to see: " in text
