"""The house: which layer may import from which, and how long modules and functions may be."""

import ast

import pytest

from ratd.pipeline.provenance import imported_modules, module_files

LAYERS = (
    "base",
    "pipeline",
    "laws",
    "geometry",
    "engine",
    "observables",
    "drives",
    "aggregates",
    "pictures",
    "experiments",
    "validation",
    "command",
    "__main__",
)
"""Each imports from itself and those before it."""
COMMON = ("relax", "evolve", "command", "intervals", "leapfrog_for", "made_with", "saved", "unfinished")
"""Modules of `experiments` that all experiments may import."""
LONGEST_MODULE, LONGEST_FUNCTION = 500, 80

MODULES = {name: path for name, path in module_files().items() if "." in name}


def layer(name):
    return name.split(".")[1]


def experiment(name):
    """The experiment that a module belongs to, if it belongs to one alone."""
    parts = name.split(".")
    return parts[2] if parts[1:2] == ["experiments"] and len(parts) > 2 and parts[2] not in COMMON else None


@pytest.mark.parametrize("name", MODULES)
def test_every_module_is_in_a_layer_and_imports_from_those_before(name):
    assert layer(name) in LAYERS
    below = LAYERS[: LAYERS.index(layer(name)) + 1]
    imported = [other for other in imported_modules(MODULES[name].read_text(), name) if "." in other]
    assert [other for other in imported if layer(other) not in below] == []


@pytest.mark.parametrize("name", [name for name in MODULES if layer(name) == "experiments"])
def test_experiments_do_not_import_each_other(name):
    imported = imported_modules(MODULES[name].read_text(), name)
    assert {experiment(other) for other in imported} <= {None, experiment(name)}


@pytest.mark.parametrize("name", MODULES)
def test_modules_and_functions_are_short(name):
    source = MODULES[name].read_text()
    assert source.count("\n") <= LONGEST_MODULE
    long = [
        node.name
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.FunctionDef) and not is_compiled(node) and length(node) > LONGEST_FUNCTION
    ]
    assert long == []


def is_compiled(function):
    """Whether a function is a kernel, which is compiled as a whole and is faster in one piece."""
    names = [decorator.func if isinstance(decorator, ast.Call) else decorator for decorator in function.decorator_list]
    return any(isinstance(name, ast.Name) and name.id == "jit" for name in names)


def length(function):
    """Lines of the body of a function; what explains it does not count."""
    first, *rest = function.body
    if ast.get_docstring(function) is not None:
        if not rest:
            return 0
        first = rest[0]
    return function.end_lineno - first.lineno + 1
