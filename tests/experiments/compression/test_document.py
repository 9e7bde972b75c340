"""docs/compression.md: what is committed is what its data give, and a sentence that no longer holds is an error."""

from pathlib import Path

import pytest

import ratd
from pictures_alike import unlike
from ratd.base.measured import Measured
from ratd.experiments.compression import document
from ratd.experiments.compression.findings import findings
from ratd.experiments.compression.tables import joined
from ratd.pipeline import io
from ratd.pipeline.documents import fill, slots

TEMPLATE = document.TEMPLATE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def values():
    return findings(*document.read_data())


def test_the_committed_document_is_what_its_data_give(values):
    assert fill(TEMPLATE, values) == document.DOCUMENT.read_text(encoding="utf-8")


def test_the_committed_figures_are_those_of_the_data(tmp_path):
    document.redraw(into=tmp_path)
    assert unlike(tmp_path / document.FIGURES, document.FIGURES) == [], "redraw the document"


def test_every_figure_of_the_document_is_there():
    text = document.DOCUMENT.read_text(encoding="utf-8")
    shown = [line.split("(compression/")[1].rstrip(")") for line in text.splitlines() if line.startswith("![")]
    assert len(shown) >= 12
    assert [name for name in shown if not (document.FIGURES / name).is_file()] == []


def test_a_sentence_that_no_longer_holds_is_an_error(values):
    verdicts = [name for name in slots(TEMPLATE) if isinstance(values.get(name), str)]
    assert {"exponent", "line_0.1", "silicate_300", "leader_0.48"} <= set(verdicts)
    for name in verdicts:
        with pytest.raises(ratd.InputError, match=f"the verdict {name} is 'other'"):
            fill(TEMPLATE, values | {name: "other"})


def test_a_number_that_changes_flips_the_verdict_on_it(values):
    sets, *_ = document.read_data()
    assert values["line_0.03"] == "below" and values["exponent"] == "above 3"
    base = sets["base"].copy(deep=True)
    base["pressure"] = base["pressure"] * 1.5
    changed = findings({"base": base, "n_16384": base}, None, None)
    assert changed["line_0.03"] == "on"
    base["pressure"] = base["pressure"] / base["phi"]
    assert findings({"base": base}, None, None)["exponent"] == "below 3"


def test_it_lies_where_an_independent_code_finds_it(values):
    """Of ice, 1024 monomers, explicit steps; what that code found stands in the document."""
    for name in ("beside_3e-6", "beside_1e-5"):
        assert values[f"{name}.n"] >= 5 and values[f"{name}.N"] == 1024
        assert values[f"{name}.ratio_0.1"].value == pytest.approx(0.95, abs=0.20)
        assert values[f"{name}.exponent"].value == pytest.approx(3.1, abs=0.3)
    assert values["beside_3e-6.gyration"].value == pytest.approx(37.0, abs=2.0)


def test_missing_data_are_one_sentence(tmp_path):
    with pytest.raises(ratd.FileError, match="holds no base.nc"):
        document.read_data(tmp_path)
    with pytest.raises(ratd.FileError, match="holds no tables of the compression"):
        document.collect(tmp_path)


def test_clusters_that_are_made_later_are_added_to_their_set(tmp_path):
    whole = io.read(document.DATA / "sets/n_1024.nc", "compression_set")
    for name, seeds in (("first", [0, 2, 4, 6, 7, 8, 9]), ("later", [5, 1, 3])):
        part = whole.isel(seed_number=seeds)
        filled = part["pressure"].notnull().any("seed_number")
        io.write(tmp_path / name / "compression/n_1024.nc", part.isel(phi_bin=filled.values), "compression_set")
        document.collect(tmp_path / name, tmp_path / "data")
    found = io.read(tmp_path / "data/sets/n_1024.nc", "compression_set")
    assert found["seed"].values.tolist() == list(range(10))
    for name in whole.variables:
        assert found[name].values == pytest.approx(whole[name].values, rel=1e-12, nan_ok=True), name
    # a seed that is there already: the new table takes the place of the old one
    document.collect(tmp_path / "later", tmp_path / "data")
    assert io.read(tmp_path / "data/sets/n_1024.nc", "compression_set")["seed"].values.tolist() == [5, 1, 3]


def test_tables_of_other_sets_are_not_joined():
    one, other = (io.read(document.DATA / f"sets/{name}.nc", "compression_set") for name in ("n_1024", "rate_1e-6"))
    with pytest.raises(ratd.InputError, match="they differ in .*strain_rate"):
        joined(one, other)
    with pytest.raises(ratd.InputError, match="both tables have the seed 0"):
        joined(one, one)


def test_the_command_says_how_it_is_used(capsys):
    assert document.main([]) == 2 and "redraw" in capsys.readouterr().out
    assert document.main(["collect", "nowhere"]) == 1 and "nowhere" in capsys.readouterr().err


def test_parts_without_data_are_left_out():
    text = "a\n<!-- if x -->\nb {{x.n}}\n<!-- if not y -->\nc\n<!-- end -->\n<!-- end -->\nd\n"
    assert fill(text, {"x.n": 2}) == "a\nb 2\nc\nd\n"
    assert fill(text, {"y.n": 2.0}) == "a\nd\n"
    with pytest.raises(ratd.InputError, match="an 'if' without an 'end'"):
        fill("<!-- if x -->\n", {"x.n": Measured(1.0)})
    assert Path("docs/compression/data/sets/base.nc").is_file()
