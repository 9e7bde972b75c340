"""Which source, settings and versions a file was made with.

A stage of the pipeline has to run again when something that its results depend on has changed, and only then. Its
source is one script in `workflow/scripts`, the module of the function that its rule names, and every module of ratd
that these import, directly or through other modules. `source_hash` hashes the text of exactly these, without comments
and docstrings, so that touching or explaining a file changes nothing, a change of a figure concerns figures only, and a
change of a contact law concerns the runs and what follows but not the growth.

The plumbing (`PLUMBING`: reading and writing files, checking the config, running jobs) is imported by every stage and
decides no number, so it stays outside the hash. What the layout of a file decides enters as
`ratd.pipeline.kinds.fingerprint`, stage by stage.
"""

import ast
import hashlib
import json
import os
import re
from functools import cache
from importlib import metadata
from pathlib import Path

from ratd import __version__
from ratd.base.errors import InputError

PLUMBING = ("ratd", "ratd.pipeline")
"""The package itself, which loads what is asked for, and all that carries numbers from a file to a function and back:
outside every source hash, the second with all its modules."""

NUMERICAL_PACKAGES = ("numpy", "numba", "pandas", "xarray", "netCDF4")
"""Packages whose versions are written into every file, next to that of ratd."""
_OF_EACH = ("code_hash", "versions")

_ROOT = Path(__file__).parent.parent
_PACKAGE = "__init__.py"
_PAGES = (".html", ".js", ".css")
_STRING_OR_COMMENT = re.compile(
    r'''"""(?:\\.|[^\\])*?"""|\'{3}(?:\\.|[^\\])*?\'{3}|"(?:\\.|[^\\"\n])*"|'(?:\\.|[^\\'\n])*'|#[^\n]*''', re.DOTALL
)


def module_files(root=_ROOT):
    """Source files of all modules of ratd.

    Parameters
    ----------
    root : Path, optional
        Folder of the package.

    Returns
    -------
    dict of str to Path
        Dotted name, e.g. ``"ratd.laws.chosen"``, -> file; ``"ratd"`` is the package itself, and stands for its
        ``__init__.py`` as every package does.
    """
    return {name: Path(path) for name, path in _module_paths(root).items()}


def _module_paths(root):
    """`module_files` with paths as text, which is fast enough to be done for each hash."""
    # The names are those of a listing, also on a file system that ignores case: `ratd.Engine` is no module.
    files = {}
    for folder, _, names in os.walk(root):
        package = os.path.relpath(folder, root).replace(os.sep, ".")
        package = "ratd" if package == "." else f"ratd.{package}"
        for name in names:
            if name == _PACKAGE:
                files[package] = os.path.join(folder, name)
            elif name.endswith(".py"):
                files.setdefault(f"{package}.{name[:-3]}", os.path.join(folder, name))
    return files


def imported_modules(source, name=None, root=_ROOT):
    """Modules of ratd that a piece of Python source imports itself, anywhere in it.

    Parameters
    ----------
    source : str
        Text of a script or a module.
    name : str, optional
        Dotted name of the module, needed to resolve its relative imports.
    root : Path, optional
        Folder of the package.

    Returns
    -------
    set of str
        Dotted names. A package counts together with its modules: ``from ratd.laws import chosen`` gives
        ``ratd.laws`` and ``ratd.laws.chosen``.

    Raises
    ------
    InputError
        If it imports from a module of ratd that does not exist.
    """
    return _imported(source, name, _module_paths(root))


def _imported(source, name, files):
    """`imported_modules` among the modules of `files`, see `_module_paths`."""
    is_package = name is not None and os.path.basename(files[name]) == _PACKAGE
    needed, candidates = _imports(source, name if is_package or name is None else name.rpartition(".")[0])
    for module in needed:
        if module not in files:
            raise InputError(f"{name or 'a script'} imports {module}, but there is no such module")
    return candidates & files.keys()


# Snakemake takes the hashes of all scripts at each start; most of them are of the same modules.
@cache
def _imports(source, package):
    """What a piece of source in a package imports: modules of ratd that must exist, and names that may be some."""
    needed, found = [], set()
    for node in _statements(source)[0]:
        if isinstance(node, ast.Import):
            modules = candidates = [alias.name for alias in node.names]
        else:
            base = node.module or ""
            if node.level:
                above = package
                for _ in range(node.level - 1):
                    above = above.rpartition(".")[0]
                base = f"{above}.{base}" if base else above
            modules, candidates = [base], [base, *(f"{base}.{alias.name}" for alias in node.names)]
        needed += [module for module in modules if module.split(".")[0] == "ratd"]
        for candidate in candidates:
            parts = candidate.split(".")
            # importing a.b.c runs a and a.b too
            found.update(".".join(parts[:depth]) for depth in range(1, len(parts) + 1))
    return needed, found


@cache
def _statements(source):
    """Statements of import, and strings that stand alone, in a piece of Python source: two lists of nodes."""
    imports, strings = [], []
    waiting = [ast.parse(source)]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import | ast.ImportFrom):
            imports.append(node)
        elif isinstance(node, ast.Expr):
            if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
                strings.append(node)
        else:
            # expressions, by far the most of all nodes, hold no statements
            waiting += [child for child in ast.iter_child_nodes(node) if not isinstance(child, ast.expr)]
    return imports, strings


@cache
def essential_text(source):
    """Python source without what decides no number: comments, docstrings, blank lines.

    Parameters
    ----------
    source : str

    Returns
    -------
    str
        The remaining lines as they stand. (They are not parsed and written anew, because what that gives differs
        between versions of Python.)
    """
    lines = source.splitlines()
    row, within = 0, set()
    last = 0
    # as `tokenize` finds them, in a twentieth of its time
    for found in _STRING_OR_COMMENT.finditer(source):
        row += source.count("\n", last, found.start())
        last = found.start()
        if found[0].startswith("#"):
            lines[row] = lines[row][: last - source.rfind("\n", 0, last) - 1].rstrip()
        else:
            within.update(range(row + 1, row + 1 + found[0].count("\n")))
    left_out = {row for row, line in enumerate(lines) if row not in within and not line.strip()}
    for node in _statements(source)[1]:
        first, last = node.lineno - 1, node.end_lineno
        if not lines[first].encode()[: node.col_offset].strip():
            left_out.update(range(first, last))
    return "\n".join(line for row, line in enumerate(lines) if row not in left_out)


def is_plumbing(name):
    """Whether a module is outside every source hash, see `PLUMBING`."""
    return name in PLUMBING or name.startswith("ratd.pipeline.")


def closure(modules, root=_ROOT):
    """Modules together with every module of ratd that they import, directly or not, without the plumbing.

    Parameters
    ----------
    modules : iterable of str
        Dotted names.
    root : Path, optional
        Folder of the package.

    Returns
    -------
    list of str
        Sorted dotted names.

    Raises
    ------
    InputError
        If ratd has no module of one of the names.
    """
    return sorted(_texts(modules, _module_paths(root)))


def _texts(modules, files):
    """Source of every module of `closure`: dict of dotted name to text."""
    waiting = list(modules)
    found = {}
    while waiting:
        name = waiting.pop()
        if name in found or is_plumbing(name):
            continue
        if name not in files:
            raise InputError(f"there is no module {name!r} in ratd to take a source hash of")
        found[name] = _text(files[name])
        waiting.extend(_imported(found[name], name, files) - found.keys())
    return found


def _beside(path):
    """Files of other types that have the name of a module and lie beside it: they belong to it."""
    folder, name = os.path.split(path)
    start = name.removesuffix("py")
    return [
        os.path.join(folder, other)
        for other in sorted(os.listdir(folder))
        if other.endswith(_PAGES) and other.startswith(start)
    ]


def _text(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def source_hash(script=None, modules=(), extra=(), root=_ROOT):
    """Content hash of a script, of some modules, of every module of ratd that these import, and of pages beside them.

    Parameters
    ----------
    script : path-like, optional
        A script, e.g. of `workflow/scripts`.
    modules : iterable of str, optional
        Dotted names of modules of ratd.
    extra : iterable of str, optional
        Further text that the result depends on, e.g. the fingerprint of the kind of file that is written.
    root : Path, optional
        Folder of the package.

    Returns
    -------
    str
        16 hexadecimal digits. Comments, docstrings, the time at which a file was changed and the place where it lies
        do not enter.

    Raises
    ------
    InputError
        If ratd has no module of one of the names.
    """
    digest = hashlib.sha256()
    files = _module_paths(root)
    start = set(modules)
    if script is not None:
        text = _text(script)
        start |= _imported(text, None, files)
        digest.update(f"script\0{essential_text(text)}\0".encode())
    for name, text in sorted(_texts(start, files).items()):
        digest.update(f"{name}\0{essential_text(text)}\0".encode())
        for path in _beside(files[name]):
            digest.update(f"{os.path.basename(path)}\0{_text(path)}\0".encode())
    for text in extra:
        digest.update(f"extra\0{text}\0".encode())
    return digest.hexdigest()[:16]


def canonical(settings):
    """Settings as one line of JSON that depends on their content alone.

    Parameters
    ----------
    settings : dict
        Numbers, strings, booleans, None, lists and dictionaries of these.

    Returns
    -------
    str
    """
    return json.dumps(settings, sort_keys=True, separators=(",", ":"), allow_nan=False)


def settings_hash(settings):
    """Hash of settings, whatever the order of their keys.

    Parameters
    ----------
    settings : dict
        See `canonical`.

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    return hashlib.sha256(canonical(settings).encode()).hexdigest()[:16]


def file_hash(*paths):
    """Hash of the bytes of some files, in the order given.

    Parameters
    ----------
    *paths : path-like

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    digest = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as handle:
            digest.update(hashlib.file_digest(handle, "sha256").digest())
    return digest.hexdigest()[:16]


def versions():
    """Versions of ratd and of the packages that its numbers come from.

    Returns
    -------
    str
        ``"ratd 1.0.0, numpy 2.4.6, ..."``.
    """
    return ", ".join([f"ratd {__version__}", *(f"{name} {metadata.version(name)}" for name in NUMERICAL_PACKAGES)])


def together(every):
    """What the attributes of some files tell of a table that was joined from them.

    Parameters
    ----------
    every : iterable of dict

    Returns
    -------
    dict
        ``code_hash`` and ``versions``, each that there is once and parted by "; ", and an empty ``input_hash``.
    """
    every = list(every)
    parts = {name: [part for own in every for part in own.get(name, "").split("; ")] for name in _OF_EACH}
    return {name: "; ".join(dict.fromkeys(filter(None, found))) for name, found in parts.items()} | {"input_hash": ""}


def provenance(code, settings, inputs=()):
    """Global attributes that tell where the content of a file comes from.

    Parameters
    ----------
    code : str
        From `source_hash`.
    settings : dict
        Everything in the config that the content depends on.
    inputs : iterable of path-like, optional
        Files that the content was computed from.

    Returns
    -------
    dict
        ``code_hash``, ``settings`` (JSON), ``settings_hash``, ``input_hash`` (empty where there are no inputs) and
        ``versions``. The same inputs give the same attributes: no time, no host, no path.
    """
    inputs = list(inputs)
    return {
        "code_hash": code,
        "settings": canonical(settings),
        "settings_hash": settings_hash(settings),
        "input_hash": file_hash(*inputs) if inputs else "",
        "versions": versions(),
    }
