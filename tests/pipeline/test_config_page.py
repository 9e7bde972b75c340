"""config/README.md says what the schemas say."""

import re

import pytest
import yaml

from ratd.pipeline.config_page import page, tables
from tiny_pipeline import ROOT

SCHEMAS = ROOT / "config" / "schema"


def test_the_page_is_that_of_the_schemas():
    text = (ROOT / "config" / "README.md").read_text()
    assert page(text, SCHEMAS) == text, "run: python -m ratd.pipeline.config_page"


def test_every_key_says_what_it_is_and_what_it_may_hold():
    rows = re.findall(r"^\| `(.*?)` \| (.*?) \| (.*?) \|$", tables(SCHEMAS), re.M)
    assert len(rows) > 50 and [key for key, title, allowed in rows if not title or not allowed] == []


def test_every_key_of_the_files_stands_on_the_page():
    keys = set(re.findall(r"^\| `(.*?)` ", tables(SCHEMAS), re.M))
    found = set()
    for path in (ROOT / "config").rglob("*.yaml"):
        if path.parent.name != "schema":
            content = yaml.safe_load(path.read_text())
            for experiment in {"spin_up", "compression", "collision"} & set(content or {}):
                found.add(experiment)
                assert set(content[experiment] or {}) <= keys, path
    assert found == {"spin_up", "compression", "collision"}


def test_another_experiment_has_a_table_of_its_own(tmp_path):
    write = {
        "config.schema.yaml": {"properties": {"results": {"title": "a"}, "melting": {"type": "object"}}},
        "melting.schema.yaml": {
            "properties": {"heat": {"title": "how hot", "$ref": "#/$defs/number"}},
            "$defs": {"number": {"description": "a number"}},
        },
    }
    for name, content in write.items():
        (tmp_path / name).write_text(yaml.safe_dump(content))
    assert tables(tmp_path).endswith(
        "## `melting`\n\n| key | what it is | allowed |\n|---|---|---|\n| `heat` | how hot | a number |\n"
    )


@pytest.mark.parametrize("text", ["a\n", "a\n<!-- keys"])
def test_what_stands_around_the_tables_stays(text):
    whole = (ROOT / "config" / "README.md").read_text()
    assert page(text + whole, SCHEMAS) == text + whole
