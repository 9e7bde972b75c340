"""The arrays of a state."""

import numpy as np

from ratd.base.materials import MATERIALS
from ratd.engine.checkpoint import load, save
from ratd.engine.forces import working_space
from ratd.engine.layout import CONTACTS
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import LINE, aligned, copied, new_state, with_room
from ratd.geometry.box import periodic
from ratd.laws import jkr
from systems import lattice


def test_arrays_begin_where_lines_of_the_cache_do(tmp_path):
    law, box = jkr(), periodic(1e-6)
    state = new_state(lattice(3, 60e-9), np.full(27, 30e-9), MATERIALS["q-S"], np.array([[0, 1]]), law, box, leapfrog())
    save(tmp_path / "state.npz", "key", state)
    larger = with_room(state, law, box, 10 * len(state.pair_i))
    for each in (state, larger, copied(state), load(tmp_path / "state.npz", "key")[0]):
        assert each.counter[CONTACTS] == 1
        assert all(array.ctypes.data % LINE == 0 for array in each)
    assert working_space().ctypes.data % LINE == 0


def test_an_aligned_copy_is_a_copy():
    array = np.arange(12, dtype=np.int64).reshape(3, 4)
    copy = aligned(array)
    assert copy.dtype == array.dtype and (copy == array).all()
    copy[0, 0] = 7
    assert array[0, 0] == 0
