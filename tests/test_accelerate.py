"""Flags and cache of compiled code."""

import ast
from pathlib import Path

import ratd
from ratd.base import jit as _accelerate

SOURCE = Path(ratd.__file__).parent


def test_every_compiled_function_has_the_flags_of_the_one_place():
    """No file of the package calls numba but _accelerate, one for GPUs, and two that compile nothing by themselves."""
    allowed = {SOURCE / name for name in ("_accelerate.py", "_rows.py", "formulae.py", "cuda/device.py")}
    for path in SOURCE.rglob("*.py"):
        imports = {
            name.split(".")[0]
            for node in ast.walk(ast.parse(path.read_text()))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for name in ([node.module or ""] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names])
        }
        assert "numba" not in imports or path in allowed, path


def test_cache_key_follows_what_compiled_code_imports(tmp_path, monkeypatch):
    """Also a file without compiled code, such as the layout, whose constants are compiled in; but not a figure."""
    copy = tmp_path / "ratd"
    for path in SOURCE.rglob("*.py"):
        target = copy / path.relative_to(SOURCE)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(path.read_bytes())
    monkeypatch.setattr(_accelerate, "__file__", str(copy / "_accelerate.py"))
    before = _accelerate._source_digest()
    assert before == _accelerate._source_digest()
    figure = copy / "figures" / "figure7.py"
    figure.write_text(figure.read_text() + "\nNEW = 1\n")
    assert _accelerate._source_digest() == before
    layout = copy / "engine" / "layout.py"
    layout.write_text(layout.read_text().replace("LANES = 56", "LANES = 72"))
    assert _accelerate._source_digest() != before
