"""docs/collision.md and its appendix: they are their templates filled from the committed collisions, and hold.

When a claim fails after further collisions: reread the sentences in docs/templates/collision*.md, and mend both.
"""

import re
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy.stats import norm

from pictures_alike import unlike
from ratd.base.errors import InputError
from ratd.experiments.collision import document_plan as page
from ratd.experiments.collision.claims import claims
from ratd.experiments.collision.document import (
    _below_ceiling,
    _by_v_frag,
    _calibrated,
    _exponents,
    _on_all_three,
    _same_collisions,
    document,
    values,
)
from ratd.experiments.collision.document_samples import (
    at_own_v_frag,
    by_sample,
    chance_of_change,
    halved,
    largest,
    together,
    with_and_without,
)
from ratd.experiments.collision.document_texts import with_error
from ratd.experiments.collision.printed import PRINTED_THRESHOLDS
from ratd.experiments.collision.tables import findings
from ratd.pictures.style import save
from ratd.pipeline import io
from ratd.pipeline.documents import fill
from ratd.pipeline.kinds import as_dataset
from tiny_pipeline import ROOT

DOCS = ROOT / "docs"
PAGES = ("collision.md", "collision_appendix.md")
DATA = sorted(path for path in (DOCS / "collision" / "data").glob("*/*.nc") if path.parent.name != "pictures")


@pytest.fixture(scope="module")
def found():
    return findings({"runs": DATA}, {"bootstrap": 2000}, lambda text: None)


@pytest.fixture(scope="module")
def tables(found):
    return SimpleNamespace(**{name: found[f"collision_{name}_csv"] for name in ("table", "thresholds", "likeness")})


def test_what_the_sentences_say_holds(tables):
    found = claims(tables.table, tables.thresholds, tables.likeness)
    assert len(found) > 8 and [claim for claim, holds in found.items() if not holds] == []


def shuffled(table, labels, rng):
    """A table whose rows keep their labels and have the numbers of other rows."""
    numbers = table.drop(columns=list(labels))
    return table[list(labels)].join(numbers.iloc[rng.permutation(len(table))].set_index(table.index))[table.columns]


def test_every_claim_can_fail(tables):
    """With numbers of other collisions, or with an open balance, each of them fails at least once."""
    rng = np.random.default_rng(1)
    cell = ("law", "cluster", "impact_parameter", "friction")
    failed, known = set(), claims(tables.table, tables.thresholds, tables.likeness)
    worlds = [tables.table.assign(balance=0.5, N_s=1.0)]
    worlds += [shuffled(tables.table, (*cell, "sample", "velocity", "seed"), rng) for _ in range(12)]
    for table in worlds:
        thresholds = shuffled(tables.thresholds, (*cell, "damping_time"), rng)
        likeness = shuffled(tables.likeness, ("law", "cluster", "quantity"), rng)
        failed |= {claim for claim, holds in claims(table, thresholds, likeness).items() if not holds}
    assert set(known) - failed == set()


def test_the_document_is_its_template_filled(tables):
    found = values(tables.table, tables.thresholds, tables.likeness)
    for name in PAGES:
        wanted = fill((DOCS / "templates" / name).read_text(encoding="utf-8"), found)
        assert (DOCS / name).read_text(encoding="utf-8") == wanted, "snakemake --cores 1 collision_document"


def test_a_document_whose_sentences_no_longer_hold_is_not_written(tables, tmp_path):
    files = {f"{name}_template": tmp_path / f"{name}.md" for name in ("document", "appendix")}
    for path in files.values():
        path.write_text("{{collisions}}", encoding="utf-8")
    for name in ("table", "thresholds", "likeness"):
        files[name] = tmp_path / f"{name}.nc"
        io.write(files[name], as_dataset(getattr(tables, name)), f"collision_{name}")
    assert document(files, {}, None)["document"] == values(*vars(tables).values())["collisions"]
    known = claims(tables.table, tables.thresholds, tables.likeness)
    open_ended = tables.table.assign(balance=0.5)
    wrong = [claim for claim, holds in claims(open_ended, tables.thresholds, tables.likeness).items() if not holds]
    assert 0 < len(wrong) < len(known)
    io.write(files["table"], as_dataset(open_ended), "collision_table")
    with pytest.raises(InputError, match="says what the data no longer do") as refused:
        document(files, {}, None)
    assert all(claim in str(refused.value) for claim in wrong)


def test_pictures_of_the_document_are_there():
    page, appendix = ((DOCS / name).read_text(encoding="utf-8") for name in PAGES)
    # as many lines as the page of the spin-up may have
    assert page.count("\n") <= 250
    targets = {part.split(")")[0] for part in (page + appendix).split("](")[1:]}
    assert targets and all((DOCS / target).exists() for target in targets)


def test_the_committed_figures_are_those_of_the_data(found, tmp_path):
    for name in ("table", "thresholds"):
        io.write(tmp_path / f"{name}.nc", found[f"collision_{name}"], f"collision_{name}")
    files = {name: tmp_path / f"{name}.nc" for name in ("table", "thresholds")} | {"runs": DATA}
    drawn = [name for name, (_, source, _) in page.FIGURES.items() if source in files]
    for name in drawn:
        module = import_module(f"ratd.experiments.collision.figures.{page.figure_module(name)}")
        save(module.draw(files, page.figure_settings(name)), tmp_path / "drawn" / f"{name}.png")
    assert len(drawn) >= 8 and unlike(tmp_path / "drawn", DOCS / "collision") == [], "redraw the document"


def test_the_samples_of_the_document_are_those_of_its_collisions_whatever_the_config(monkeypatch):
    monkeypatch.chdir(ROOT)
    settings = page.samples_settings()
    assert (settings["number"], settings["drop_below"], settings["samples"]) == (5000, 0.0, [1, 2, 3])
    # the plan of what Snakemake was given
    assert "COLLISIONS" not in (ROOT / "workflow" / "rules" / "collision_document.smk").read_text(encoding="utf-8")


def test_digits():
    assert with_error(0.1634, 0.0312) == "0.163 ± 0.031" and with_error(12.34, 1.7) == "12.3 ± 1.7"
    assert (
        with_error(0.5, np.nan) == "0.50"
        and with_error(np.nan, 1.0) == "–"
        and with_error(6.35, 0.222, 1) == "6.3 ± 0.2"
    )


def test_the_damping_time_is_fixed_on_one_radius_and_predicts_the_others():
    """v_frag as a power of A: at which A 0.57 um has the printed 12.5 m/s, and what 0.453 um has there."""
    rows = [
        dict(
            law=f"A{time}", cluster=cluster, friction="velocity", damping_time=time * 1e-9, impact_parameter=0.0,
            surface_energy=0.025, velocity=level * time**0.5, error=0.01 * level * time**0.5,
        )
        for cluster, level in (("570nm", 10.0), ("453nm", 16.0))
        for time in (0.5, 1.0, 2.0)
    ]  # fmt: skip
    table = pd.DataFrame([*rows, rows[0] | {"law": "slide_4", "velocity": 99.0}])
    found = _calibrated(table)
    assert float(found["A velocity"].split(" ± ")[0]) == pytest.approx(1.25**2, rel=0.01)
    value, error = map(float, found["predicted velocity 453nm"].split(" ± "))
    assert value == pytest.approx(16.0 * 1.25, rel=0.01) and 0.1 < error < 0.5
    assert _calibrated(table[table["damping_time"] < 1.5e-9]) == {}


def test_the_radius_that_has_a_fragmentation_velocity():
    """v_frag goes as 1/radius: MRN with 20 m/s is like the radius between those of 25 and 15 m/s."""
    rows = [
        dict(law="velocity", cluster=f"{nm}nm", impact_parameter=0.0, radius=nm * 1e-9, velocity=7500 / nm, error=0.75)
        for nm in (250, 300, 500)
    ]
    thresholds = pd.DataFrame([*rows, rows[0] | {"cluster": "mrn", "radius": np.nan, "velocity": 20.0, "error": 1.0}])
    speeds = [10.0, 20.0, 30.0]
    table = pd.DataFrame(
        [
            dict(law="velocity", cluster=name, impact_parameter=0.0, sample=sample, velocity=speed, X=X)
            for name in ("mrn", "353nm")
            for sample, fall in ((1, 0.3), (2, 0.2))
            for speed, X in zip(speeds, (0.9, fall, 0.0), strict=True)
        ]
    )
    found = _by_v_frag(table, thresholds)
    middle, low, high = map(float, re.findall(r"\d+", found["radius velocity mrn v_frag"]))
    assert middle == 375 and 340 < low < 365 and 385 < high < 420
    assert found["by sample v_frag velocity 353nm"] == "25.0, 22.5"


def test_exponents_hold_the_errors_of_the_velocities():
    """v_frag is 1/radius without scatter, each known to a tenth; v_stick falls faster between small radii."""
    radii = np.array([298, 314, 353, 396, 453, 570]) * 1e-9
    rows = [
        dict(
            law=f"law {energy}", cluster=f"{radius * 1e9:.0f}nm", friction="velocity", damping_time=0.5e-9,
            radius=radius, impact_parameter=0.0, surface_energy=energy, velocity=energy / radius,
            error=0.1 * energy / radius,
            sticking_velocity=energy / radius**2 if radius > 3e-7 else 2.0 * energy / radius**2,
        )
        for energy, radius in [(0.025, radius) for radius in radii] + [(0.05, radii[-1]), (0.0125, radii[-1])]
    ]  # fmt: skip
    found = _exponents(pd.DataFrame(rows))
    at = np.log(radii)
    power, error = map(float, found["exponent radius"].split(" ± "))
    assert power == pytest.approx(-1.0, abs=0.01)
    assert error == pytest.approx(0.1 / np.sqrt(np.sum((at - at.mean()) ** 2)), rel=0.05)
    low, high = map(float, found["exponent radius stick"].split(" to "))
    assert low < -5.0 and high == pytest.approx(-2.0, abs=0.01)
    assert float(found["exponent energy"].split(" ± ")[0]) == pytest.approx(1.0, abs=0.01)


def test_collisions_that_were_done_once_more_stand_beside_the_same_ones():
    """Of four collisions two were done once more."""
    both = dict(cluster="353nm", impact_parameter=0.0, velocity=15.0)
    rows = [dict(law="velocity", sample=s, seed=k, X=s + 0.1 * k, N_s=0.5) | both for s in (1, 2) for k in (0, 1)]
    rows += [dict(law="half_step", sample=s, seed=0, X=9.0, N_s=0.5) | both for s in (1, 2)]
    found = _same_collisions(pd.DataFrame(rows))
    assert found["same X half_step 353nm 15"] == "1.50 ± 0.50" and found["same N_s half_step 353nm 15"] == "0.50"
    assert found["change X half_step 353nm 15"] == "7.50 ± 0.50" and found["change N_s half_step 353nm 15"] == "0.00"


def test_a_velocity_at_the_ceiling_says_nothing_of_the_radius():
    """At 15 m/s MRN has the N_s of 300 nm; at 30 m/s it is at its ceiling, which 250 nm has."""
    cell = dict(law="velocity", impact_parameter=0.0, sample=1, seed=0, X=0.1, energy_half=0.1, second_contact=0.5)
    equal = [
        dict(cluster=f"{nm}nm", largest_radius=nm * 1e-9, mean_sphere_radius=nm * 1e-9, largest_share=0.01,
             velocity=speed, N_s=0.001 * nm + extra) | cell
        for nm in (250, 300, 400) for speed, extra in ((15.0, 0.0), (30.0, 0.4))
    ]  # fmt: skip
    one = dict(cluster="mrn", largest_radius=2e-6, mean_sphere_radius=1e-7, largest_share=0.35) | cell
    table = pd.DataFrame([*equal, one | {"velocity": 15.0, "N_s": 0.3}, one | {"velocity": 30.0, "N_s": 0.65}])
    found = _below_ceiling(table)
    assert found["ceiling velocity 30"] == "100 %" and found["ceiling velocity 15"] == "46 %"
    assert found["radius below velocity N_s"].startswith("300 ")


def test_samples_are_compared_one_by_one():
    """Both samples gain 0.2 by their small spheres, however much they differ; a rotation without a twin is left out."""
    rows = [
        dict(
            law="velocity", cluster=cluster, velocity=20.0, impact_parameter=0.0, sample=sample, seed=seed, X=X,
            largest_share=0.1 * sample, mass=(3.0 + sample) * 1e-13,
        )
        for sample, level in ((1, 0.1), (2, 0.6))
        for seed, cluster, X in (
            (0, "mrn", level + 0.3), (0, "mrn100", level + 0.1), (1, "mrn", level + 0.25), (1, "mrn100", level + 0.05),
            (2, "mrn", 0.99),
        )
    ]  # fmt: skip
    found = with_and_without(pd.DataFrame(rows), ("X",))
    assert found["both velocity 20"] == "4" and found["both X velocity mrn 20"] == "0.62 ± 0.25"
    assert float(found["gain X velocity 20"].split(" ± ")[0]) == pytest.approx(0.2)
    ends = largest(pd.DataFrame(rows))
    assert ends["shares velocity mrn"] == "0.10 to 0.20" and ends["ceilings velocity mrn"] == "0.80 to 0.90"
    assert ends["mass velocity mrn"] == "4.00 to 5.00" and ends["samples velocity mrn"] == "2"


def test_half_the_step_is_told_by_the_same_collisions():
    """Each is 0.1 lower with half the step, whatever it is; what was not done again does not count."""
    how = dict(cluster="mrn100", impact_parameter=0.0, N_s=0.5)
    rows = [
        dict(how, law=law, velocity=velocity, sample=sample, seed=seed, X=X - 0.1 * (law == "half_step"))
        for sample in (1, 2)
        for velocity, seed, X in ((15.0, 0, 0.9), (20.0, 1, 0.3 * sample), (30.0, 0, 0.4))
        for law in ("velocity", "half_step")
        if not (law == "half_step" and velocity == 30.0)
    ]
    found = halved(pd.DataFrame(rows))
    assert found["halved n mrn100"] == "4" and float(found["halved X mrn100"].split(" ± ")[0]) == pytest.approx(-0.1)
    assert float(found["halved N_s mrn100"].split(" ± ")[0]) == 0.0 and found["halved chance N_s mrn100"] == "1"
    # X of 0.9, 0.45 and 0.4, less 0.1 at 15 and 20 m/s: it never falls through 0.15
    assert found["halved v_frag mrn100"] == "nan" and found["halved chance together"] == "1"
    # means of two samples that are two errors from 0; with one degree of freedom t is a tangent
    assert found["halved v_frag each mrn100"] == "nan"
    pairs = pd.DataFrame({"sample": [1, 1, 2], "change": [0.0, 0.2, 0.3]})
    assert chance_of_change(pairs) == pytest.approx(1.0 - 2.0 / np.pi * np.arctan(2.0))


def test_tests_that_agree_are_surer_together():
    """1.96 standard deviations each: four make 3.92, and those of other sign cancel."""
    assert together([(0.1, 0.05)]) == pytest.approx(0.05)
    assert together([(0.1, 0.05)] * 4) == pytest.approx(2.0 * norm.sf(2.0 * norm.isf(0.025)))
    assert together([(0.1, 0.05), (-0.3, 0.05)]) == pytest.approx(1.0)


def test_what_a_cluster_is_at_its_own_fragmentation_velocity():
    rows = [
        dict(
            law="velocity", cluster="mrn", impact_parameter=0.0, velocity=v, sample=sample, N_s=v / 40, n_pieces=v,
            X=0.15 + 0.01 * (own - v), seed=0,
        )
        for v in (20.0, 30.0)
        for sample, own in ((1, 24.0), (2, 28.0))
    ]  # fmt: skip
    found = at_own_v_frag(pd.DataFrame(rows), ("mrn", "353nm"))
    assert found == {"own N_s mrn": "0.65 ± 0.05", "own n_pieces mrn": "26 ± 2"}


def test_the_damping_time_that_fits_all_printed_velocities_is_found():
    """Powers of A that meet the printed velocities at 1.3 ns, all three."""
    rows = [
        dict(
            law=f"law {time}", cluster=f"{radius * 1e9:.0f}nm", friction="velocity", damping_time=time * 1e-9,
            impact_parameter=0.0, surface_energy=0.025, velocity=printed * (time / 1.3) ** power, error=0.1,
        )
        for (radius, printed), power in zip(PRINTED_THRESHOLDS.items(), (0.5, 0.6, 0.7), strict=True)
        for time in (0.5, 1.0, 2.0)
    ]  # fmt: skip
    found = _on_all_three(pd.DataFrame(rows))
    assert found["A common"] == found["A alone 453nm"] == "1.30"
    assert found["common off"] == "0 %" and found["common 570nm"] == "12.5"


def test_a_sample_is_told_with_its_own_moments(tables):
    """Its radii are those that its collisions were made with, as the share of its largest sphere says."""
    # as the table comes from its file
    found = by_sample(tables.table.assign(sample=tables.table["sample"].astype(float)), "velocity", "mrn")
    for sample, part in tables.table[tables.table["cluster"] == "mrn"].groupby("sample"):
        assert found[f"sample {sample} share"] == f"{part['largest_share'].iloc[0]:.2f}"
    assert float(found["sample 1 L_4.6"]) < float(found["sample 1 L_5"])
    # of two radii the greater has the higher moment
    assert float(found["sample 2 radius N_s"]) < float(found["sample 2 radius X"])
    assert float(found["sample 2 q N_s"]) < float(found["sample 2 q X"])


def test_shares_of_pieces(tables):
    """What is in large pieces and in single spheres is a part of the mass; a piece of less is in neither."""
    both = tables.table["large_share"] + tables.table["single_share"]
    assert both.between(0.0, 1.0 + 1e-9).all() and (tables.table["large_share"] > 0.0).any()
    stuck = tables.table[(tables.table["X"] > 0.99)]
    assert len(stuck) and (stuck["large_share"] > 0.98).all()
