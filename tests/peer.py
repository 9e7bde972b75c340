"""LAMMPS in tests, which are skipped where it is not installed."""

import pytest

from ratd.base.errors import InputError
from ratd.validation import peer_lammps


def installed():
    """Whether LAMMPS is there and loads."""
    try:
        peer_lammps.load()
    except InputError:
        return False
    return True


needs_lammps = pytest.mark.skipif(not installed(), reason="LAMMPS is not installed")


def need_lammps():
    """The same for a fixture."""
    if not installed():
        pytest.skip("LAMMPS is not installed")
