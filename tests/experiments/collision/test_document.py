"""docs/collision.md: it is its template filled from the committed collisions, and what its sentences say holds.

When a claim fails after further collisions: reread the sentence in docs/templates/collision.md, mend it and the claim.
"""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from pictures_alike import unlike
from ratd.experiments.collision import document_plan as page
from ratd.experiments.collision.claims import claims
from ratd.experiments.collision.document import _calibrated, values, with_error
from ratd.experiments.collision.tables import findings
from ratd.pictures.style import save
from ratd.pipeline import io
from ratd.pipeline.documents import fill
from tiny_pipeline import ROOT

DOCS = ROOT / "docs"
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
    template = (DOCS / "templates" / "collision.md").read_text(encoding="utf-8")
    wanted = fill(template, values(tables.table, tables.thresholds, tables.likeness))
    assert (DOCS / "collision.md").read_text(encoding="utf-8") == wanted, "snakemake --cores 1 collision_document"


def test_pictures_of_the_document_are_there():
    text = (DOCS / "collision.md").read_text(encoding="utf-8")
    targets = {part.split(")")[0] for part in text.split("](")[1:]}
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
