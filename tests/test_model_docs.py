"""The pages of the model: what they name exists, and their example runs."""

import re
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = sorted((ROOT / "docs" / "model").glob("*.md"))
TEXT = {page.name: page.read_text(encoding="utf-8") for page in PAGES}


def found(pattern):
    """Page and text of each match on any page, each once."""
    return sorted({(name, match) for name, text in TEXT.items() for match in re.findall(pattern, text)})


def named(name):
    """The object of a dotted name: the longest module in it, then attributes."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        module = ".".join(parts[:count])
        try:
            value = import_module(module)
        except ModuleNotFoundError as error:
            # a module that exists but lacks something that it imports is an error
            if not module.startswith(error.name):
                raise
            continue
        for attribute in parts[count:]:
            value = getattr(value, attribute)
        return value
    raise ModuleNotFoundError(name)


def test_there_are_pages():
    assert set(TEXT) == {"README.md", "aggregates.md", "drives.md", "engine.md", "laws.md", "radiation.md"}


@pytest.mark.parametrize(("page", "name"), found(r"`(ratd(?:\.\w+)+)`"))
def test_names_exist(page, name):
    named(name)


def test_a_name_that_does_not_exist_is_noticed():
    with pytest.raises(AttributeError):
        named("ratd.laws.tangential.no_such_name")
    with pytest.raises(AttributeError):
        named("ratd.no_such_module.name")


@pytest.mark.parametrize(("page", "path"), found(r"`((?:src|tests|docs|config)/[\w./-]+)`"))
def test_files_exist(page, path):
    assert (ROOT / path).exists()


@pytest.mark.parametrize(
    ("page", "test", "path"), [(p, *m) for p, m in found(r"`(test_\w+)`\s+in\s+`(tests/[\w/]+\.py)`")]
)
def test_tests_exist(page, test, path):
    assert f"def {test}(" in (ROOT / path).read_text(encoding="utf-8")


@pytest.mark.parametrize(("page", "target"), found(r"\]\(([^)#]+)\)"))
def test_links_lead_somewhere(page, target):
    assert (ROOT / "docs" / "model" / target).exists()


def test_the_example_runs():
    (code,) = re.findall(r"```python\n(.*?)```", TEXT["README.md"], re.DOTALL)
    names = {}
    exec(code, names)
    run, grain = names["run"], names["grain"]
    assert run["n_contacts"].values[0] == grain.n_contacts and run["n_pieces"].values[0] == 2
    assert run["n_contacts"].values[-1] > grain.n_contacts and run["n_pieces"].values[-1] == 1
