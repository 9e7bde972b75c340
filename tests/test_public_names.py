"""The public names: their types agree with what they are, and the package says which version it is."""

import ast
import inspect
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

import ratd

ROOT = Path(__file__).parents[1]


def stubs(path):
    """Functions of a stub file by name."""
    return {node.name: node for node in ast.parse(path.read_text()).body if isinstance(node, ast.FunctionDef)}


def arguments(function):
    """Names, kinds and defaults of the arguments of a function of a stub."""
    plain, named = function.args.args, function.args.kwonlyargs
    defaults = [None] * (len(plain) - len(function.args.defaults)) + function.args.defaults
    return [
        *((a.arg, "plain", d and value_of(d)) for a, d in zip(plain, defaults, strict=True)),
        *((a.arg, "named", d and value_of(d)) for a, d in zip(named, function.args.kw_defaults, strict=True)),
    ]


def value_of(default):
    """Value of a default, a literal or made with a public name."""
    return eval(ast.unparse(default), {name: getattr(ratd, name) for name in ("LongSteps",)})


def real_arguments(function):
    kinds = {inspect.Parameter.POSITIONAL_OR_KEYWORD: "plain", inspect.Parameter.KEYWORD_ONLY: "named"}
    return [
        (name, kinds[p.kind], None if p.default is inspect.Parameter.empty else p.default)
        for name, p in inspect.signature(function).parameters.items()
    ]


@pytest.mark.parametrize("module", [ratd, ratd.laws], ids=["ratd", "laws"])
def test_types_of_the_public_names_are_those_of_the_functions(module):
    found = stubs(Path(module.__file__).with_suffix(".pyi"))
    functions = {name for name in module.__all__ if inspect.isfunction(getattr(module, name))}
    assert set(found) == functions
    for name, stub in found.items():
        assert arguments(stub) == real_arguments(getattr(module, name)), name
        assert all(a.annotation for a in (*stub.args.args, *stub.args.kwonlyargs)) and stub.returns


def test_every_public_name_has_a_type():
    text = (ROOT / "src" / "ratd" / "__init__.pyi").read_text()
    names = {node.name for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)}
    for node in ast.parse(text).body:
        if isinstance(node, ast.ImportFrom):
            names |= {alias.asname for alias in node.names if alias.asname}
        elif isinstance(node, ast.AnnAssign):
            names.add(node.target.id)
    assert names - {"__version__"} == set(ratd.__all__)


def test_every_public_name_is_on_the_page_of_python():
    text = (ROOT / "docs" / "api.md").read_text()
    shown = {line.removeprefix("::: ").rpartition(".")[2] for line in text.splitlines() if line.startswith("::: ")}
    assert set(ratd.__all__) - {"laws"} <= shown
    assert set(ratd.laws.__all__) <= shown


def test_the_version_is_the_same_everywhere():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == ratd.__version__ and citation["license"] == "MIT"
    assert {"cff-version", "message", "title", "authors"} <= set(citation)
    assert f"## {ratd.__version__}" in (ROOT / "CHANGELOG.md").read_text()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["dynamic"] == ["version"] and project["license"] == citation["license"]
    assert (ROOT / "LICENSE").read_text().startswith("MIT License")


def test_everything_that_is_imported_is_asked_for():
    """So that a wheel brings what it needs; LAMMPS is asked for where it is missing."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    asked = {name.lower().replace("-", "_") for name in project["dependencies"]} | {"yaml"}
    imported = set()
    for path in (ROOT / "src").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                imported |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                imported.add(node.module.split(".")[0])
    others = {name.lower() for name in imported} - set(sys.stdlib_module_names) - {"ratd", "lammps"}
    assert others - asked == set()
    assert asked - others <= {"pyyaml", "snakemake"}
