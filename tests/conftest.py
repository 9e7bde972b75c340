"""Order of the test files, and how numbers are compared in them."""

import pytest

LONGEST = (
    "test_pipeline.py", "test_benchmarks.py", "test_tutorial.py", "test_slurm.py", "test_document.py", "test_plan.py",
    "test_collision.py", "test_compression.py",
)  # fmt: skip
"""Started first, so that no worker is left alone with it at the end. The first two need other parts of the time loop:
two workers do not compile the same."""


def pytest_collection_modifyitems(items):
    """Put the files of `LONGEST` before the others, which keep their order."""
    items.sort(key=lambda item: LONGEST.index(item.path.name) if item.path.name in LONGEST else len(LONGEST))


_approx = pytest.approx


def approx(expected, rel=None, abs=None, nan_ok=False):
    """`pytest.approx` without the 1e-12 that it allows beside `rel`: most numbers in SI units are smaller than that."""
    rel = 1e-6 if rel is None and abs is None else rel
    return _approx(expected, rel=rel, abs=0.0 if abs is None else abs, nan_ok=nan_ok)


pytest.approx = approx
