"""Flags and cache of compiled code."""

import ast
from pathlib import Path

import ratd
from ratd.base import jit

SOURCE = Path(ratd.__file__).parent


def test_every_compiled_function_has_the_flags_of_the_one_place():
    """No file of the package calls numba but those that say how code is compiled, and one that names its version."""
    allowed = {
        SOURCE / name
        for name in (
            "base/jit.py",
            "base/own_cache.py",
            "base/parts.py",
            "base/rows.py",
            "base/vectors.py",
        )
    }
    assert all("numba" in path.read_text() for path in allowed)
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
    monkeypatch.setattr(jit, "__file__", str(copy / "base" / "jit.py"))
    before = jit._source_digest()
    assert before == jit._source_digest()
    figure = copy / "experiments" / "spin_up" / "figures" / "figure7.py"
    figure.write_text(figure.read_text() + "\nNEW = 1\n")
    assert jit._source_digest() == before
    for name, constant in (("laws/contact_fields.py", "LANES = 48"), ("engine/layout.py", "ROW = 16")):
        file = copy / name
        text = file.read_text()
        assert constant in text
        file.write_text(text.replace(constant, "NEW = 1"))
        assert jit._source_digest() != before
        file.write_text(text)
