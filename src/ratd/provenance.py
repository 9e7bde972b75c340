"""Which source, settings and versions a file was made with.

A stage of the pipeline has to run again when something that its results depend on has changed, and only then. Its
source is one script in `workflow/scripts` and every module of ratd that the script imports, directly or through other
modules. `source_hash` hashes the text of exactly these, without comments and docstrings, so that touching or explaining
a file changes nothing, a change of a figure concerns figures only, and a change of a contact law concerns the spin-ups
and what follows but not the growth.

The plumbing (`PLUMBING`: reading and writing files, checking the config, running jobs) is imported by every script
and decides no number, so it stays outside the hash. What it does decide, the variables of each kind of file, enters as
`ratd.schema.fingerprint(kind)`, stage by stage.
"""

import ast
import hashlib
import json
import os
import tokenize
from functools import cache
from importlib import metadata
from io import StringIO
from pathlib import Path

from ratd.errors import InputError

PLUMBING = frozenset({"ratd", "ratd.schema", "ratd.io", "ratd.provenance", "ratd.config", "ratd.jobs", "ratd.partial"})
"""Modules outside every source hash: they carry numbers from a file to a function and back."""

NUMERICAL_PACKAGES = ("ratd", "numpy", "numba", "pandas", "xarray", "netCDF4")
"""Packages whose versions are written into every file."""

_ROOT = Path(__file__).parent


def module_path(name, root=_ROOT):
    """Source file of a module of ratd.

    Parameters
    ----------
    name : str
        Dotted name, e.g. ``"ratd.laws.jkr"``; ``"ratd"`` is the package itself.
    root : Path, optional
        Folder of the package.

    Returns
    -------
    Path or None
        None where no module has this name (it may be a function or a class of a module).
    """
    below = root.joinpath(*name.split(".")[1:])
    for path in (below / "__init__.py", below.with_suffix(".py")):
        # the case must agree as well: on a file system that ignores it, `ratd.Grain` is not the module `ratd.grain`
        if path.is_file() and path.name in os.listdir(path.parent):
            return path
    return None


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
        Dotted names. A package counts together with its modules: ``from ratd.laws import jkr`` gives ``ratd.laws``
        and ``ratd.laws.jkr``.

    Raises
    ------
    InputError
        If it imports from a module of ratd that does not exist.
    """
    found = set()
    for node in _imports(source):
        if isinstance(node, ast.Import):
            modules = candidates = [alias.name for alias in node.names]
        else:
            base = node.module or ""
            if node.level:
                package = name if module_path(name, root).name == "__init__.py" else name.rpartition(".")[0]
                for _ in range(node.level - 1):
                    package = package.rpartition(".")[0]
                base = f"{package}.{base}" if base else package
            modules, candidates = [base], [base, *(f"{base}.{alias.name}" for alias in node.names)]
        for module in modules:
            if module.split(".")[0] == "ratd" and module_path(module, root) is None:
                raise InputError(f"{name or 'a script'} imports {module}, but there is no such module")
        for candidate in candidates:
            parts = candidate.split(".")
            if parts[0] != "ratd":
                continue
            # importing a.b.c runs a and a.b too
            for depth in range(1, len(parts) + 1):
                prefix = ".".join(parts[:depth])
                if module_path(prefix, root) is not None:
                    found.add(prefix)
    return found


# Snakemake takes the hashes of all scripts at each start; most of them are of the same modules.
@cache
def _imports(source):
    """Statements of import in a piece of Python source, list of ast.Import and ast.ImportFrom."""
    return [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Import | ast.ImportFrom)]


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
    left_out = set()
    for token in tokenize.generate_tokens(StringIO(source).readline):
        row, column = token.start[0] - 1, token.start[1]
        if token.type == tokenize.COMMENT:
            lines[row] = lines[row][:column].rstrip()
        # a row that holds nothing else ends in NL, one that ends a statement in NEWLINE
        if token.type == tokenize.NL and not lines[row].strip():
            left_out.add(row)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            first, last = node.lineno - 1, node.end_lineno
            if not lines[first].encode()[: node.col_offset].strip():
                left_out.update(range(first, last))
    return "\n".join(line for row, line in enumerate(lines) if row not in left_out)


def closure(modules, root=_ROOT, leave_out=PLUMBING):
    """Modules together with every module of ratd that they import, directly or not.

    Parameters
    ----------
    modules : iterable of str
        Dotted names.
    root : Path, optional
        Folder of the package.
    leave_out : collection of str, optional
        Modules that are neither counted nor followed.

    Returns
    -------
    list of str
        Sorted dotted names.

    Raises
    ------
    InputError
        If ratd has no module of one of the names.
    """
    waiting = [name for name in modules if name not in leave_out]
    found = set()
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        path = module_path(name, root)
        if path is None:
            raise InputError(f"there is no module {name!r} in ratd to take a source hash of")
        found.add(name)
        waiting.extend(imported_modules(path.read_text(), name, root) - found - set(leave_out))
    return sorted(found)


def source_hash(script=None, modules=(), extra=(), root=_ROOT):
    """Content hash of a script, of some modules, and of every module of ratd that these import.

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
    start = set(modules)
    if script is not None:
        text = Path(script).read_text()
        start |= imported_modules(text, root=root)
        digest.update(f"script\0{essential_text(text)}\0".encode())
    for name in closure(start, root):
        digest.update(f"{name}\0{essential_text(module_path(name, root).read_text())}\0".encode())
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
        ``"ratd 0.1.0, numpy 2.4.6, ..."``.
    """
    return ", ".join(f"{name} {metadata.version(name)}" for name in NUMERICAL_PACKAGES)


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
