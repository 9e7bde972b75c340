"""docs/collision.md: it is its template filled from the committed collisions, and what its sentences say holds.

When a claim fails after further collisions: reread the sentence in docs/templates/collision.md, mend it and the claim.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from ratd.experiments.collision.document import claims, values, with_error
from ratd.experiments.collision.tables import findings
from ratd.pipeline.documents import fill
from tiny_pipeline import ROOT

DOCS = ROOT / "docs"
DATA = sorted(path for path in (DOCS / "collision" / "data").glob("*/*.nc") if path.parent.name != "pictures")


@pytest.fixture(scope="module")
def tables():
    found = findings({"runs": DATA}, {"bootstrap": 2000}, lambda text: None)
    return SimpleNamespace(**{name: found[f"collision_{name}_csv"] for name in ("table", "thresholds", "likeness")})


def test_what_the_sentences_say_holds(tables):
    found = claims(tables.table, tables.thresholds, tables.likeness)
    assert len(found) > 8 and [claim for claim, holds in found.items() if not holds] == []


def test_claims_can_fail(tables):
    """With N_s of all clusters set to that of dust, the ceiling and what follows from it are gone."""
    dust = tables.table.assign(N_s=1.0)
    found = claims(dust, tables.thresholds, tables.likeness)
    assert not found["N_s never exceeds one less the share of the largest sphere"]
    assert not found["at 30 m/s N_s of MRN is far below that of equal spheres"]


def test_the_document_is_its_template_filled(tables):
    template = (DOCS / "templates" / "collision.md").read_text(encoding="utf-8")
    wanted = fill(template, values(tables.table, tables.thresholds, tables.likeness))
    assert (DOCS / "collision.md").read_text(encoding="utf-8") == wanted, "snakemake --cores 1 collision_document"


def test_pictures_of_the_document_are_there():
    text = (DOCS / "collision.md").read_text(encoding="utf-8")
    targets = {part.split(")")[0] for part in text.split("](")[1:]}
    assert targets and all((DOCS / target).exists() for target in targets)


def test_digits():
    assert with_error(0.1634, 0.0312) == "0.163 ± 0.031" and with_error(12.34, 1.7) == "12.3 ± 1.7"
    assert (
        with_error(0.5, np.nan) == "0.50"
        and with_error(np.nan, 1.0) == "–"
        and with_error(6.35, 0.222, 1) == "6.3 ± 0.2"
    )
