"""Whole runs of the engine on CUDA against those of the engine on the processor. Run by test_cuda.py, in a process of
its own: in numba's simulation, which has to be asked for before numba is imported, and on a GPU where there is one:

NUMBA_ENABLE_CUDASIM=1 python -m pytest tests/runs_cuda.py
python -m pytest tests/runs_cuda.py
"""

import sys

import numpy as np
import pytest
import xarray as xr
from numba.cuda.cudadrv.driver import CudaAPIError

import ratd
from ratd import spinup
from ratd.cuda import spin_up as cuda_spin_up
from ratd.cuda.spin_up import spin_up_many
from ratd.engine import layout
from ratd.engine.state import State, contact_blocks, monomer_rows
from ratd.errors import InputError
from ratd.growth import grow
from ratd.materials import MATERIALS, equilibrium_compression
from ratd.spinup import spin_up

MATERIAL = MATERIALS["q-S"]
SLACK = 1e4 if "watched_cuda" in sys.modules else 1.0
"""Factor of tolerances. Where accesses to memory are watched, functions of the engine on the processor run uncompiled
on the device only, and round a little otherwise."""
FIELDS = [name for name in State._fields if name != "force"]


def copy(state):
    return state._replace(**{name: array.copy() for name, array in state._asdict().items()})


def assert_close(found, expected, tolerance=1e-12):
    """Every array and every column of the monomers and every field of the contacts, relative to its greatest value."""
    for name in FIELDS:
        a, b = np.asarray(getattr(found, name)), np.asarray(getattr(expected, name))
        if name == "monomer":
            a, b = monomer_rows(found), monomer_rows(expected)
        elif name == "contact":
            a, b = (
                np.moveaxis(contact_blocks(state), 1, 2).reshape(-1, layout.N_FIELDS) for state in (found, expected)
            )
            a, b = a[: found.counter[layout.CONTACTS]], b[: expected.counter[layout.CONTACTS]]
        if a.dtype.kind in "iu":
            if name == "counter":  # the number of searches may differ
                a, b = a[: layout.SEARCHES], b[: layout.SEARCHES]
            if name == "fragment":
                a, b = a[: found.counter[layout.MONOMERS]], b[: expected.counter[layout.MONOMERS]]
            np.testing.assert_array_equal(a, b, err_msg=name)
        elif a.ndim == 2 and len(a):
            scale = np.abs(b).max(axis=0)
            for first in (0, 4, 8) if name == "monomer" else ():
                scale[first : first + 3] = scale[first : first + 3].max()
            assert (np.abs(a - b) <= SLACK * tolerance * scale).all(), (
                name,
                np.abs(a - b).max(axis=0) / (scale + 1e-300),
            )
        elif a.ndim == 1:
            if name == "scalar":  # what turns the grain back is a small rest of spins of 1e8 rad/s
                small = [layout.UNWIND, layout.EXCESS]
                np.testing.assert_allclose(a[small], b[small], rtol=tolerance, atol=1e-8)
                a, b = np.delete(a, small), np.delete(b, small)
            np.testing.assert_allclose(a, b, rtol=tolerance, atol=1e-12 * tolerance, err_msg=name)


FAST = dict(angular_acceleration=4e18, records=20)


@pytest.fixture(scope="module")
def grains():
    return [grow("BA", 55e-9, "q-S", 0), pressed_pair(20e-9), grow("BAM2", 55e-9, "q-S", 0)]


def pressed_pair(a):
    """Two monomers that overlap by more than in equilibrium, so that there is something to relax."""
    delta_0 = equilibrium_compression(a / 2, MATERIAL.surface_energy, MATERIAL.reduced_modulus)
    return ratd.Grain(np.array([[0.0, 0, 0], [2 * a - 1.1 * delta_0, 0, 0]]), np.array([a, a]), MATERIAL)


@pytest.fixture(scope="module")
def runs(grains):
    return spin_up_many(grains, snapshots=[0], snapshot_every=20, **FAST)


def assert_same_run(found, expected, tolerance):
    assert found.sizes == expected.sizes
    for name, value in expected.attrs.items():
        if not (isinstance(value, float) and np.isnan(value)):
            assert found.attrs[name] == (pytest.approx(value, rel=tolerance) if isinstance(value, float) else value), (
                name
            )
    for name in expected.data_vars:
        values = expected[name].values
        scale = np.nanmax(np.abs(values)) if values.size else 0.0
        np.testing.assert_allclose(found[name].values, values, rtol=0, atol=tolerance * scale, err_msg=name)


def test_whole_runs_are_those_of_the_processor(grains, runs):
    """Relaxation, records, snapshots, breaking, fragments lost: up to rounding, which has little time to grow here."""
    assert runs[0].sizes["fragment"] >= 1 and runs[0].sizes["snapshot"] >= 3
    for number, grain in enumerate(grains):
        expected = spin_up(grain, snapshot_every=20 if number == 0 else 0, **FAST)
        assert_same_run(runs[number], expected, 1e-8)


def test_literal_drive_and_explicit_damping(grains):
    settings = dict(drive="literal", damping="explicit", timestep_factor=0.02, max_steps=100, **FAST)
    (found,) = spin_up_many(grains[:1], **settings)
    expected = spin_up(grains[0], **settings)
    assert found.attrs["end_reason"] == "max_steps reached" and found.attrs["steps"] == 100
    assert_same_run(found, expected, 1e-8)


def test_killed_runs_go_on_with_the_same_bits(grains, tmp_path, monkeypatch):
    """Killed twice between launches, with short segments."""
    monkeypatch.setattr(cuda_spin_up, "SEGMENT", 1)
    monkeypatch.setattr(cuda_spin_up, "CHECKPOINT_INTERVAL", 0.0)
    settings = dict(max_steps=60, **FAST)
    undisturbed = spin_up_many(grains[:2], **settings)
    paths = [tmp_path / f"{number}.checkpoint" for number in range(2)]
    launch, launches = cuda_spin_up._launch, []

    def dying(*arguments):
        launches.append(1)
        if len(launches) in (4, 6):
            raise KeyboardInterrupt
        launch(*arguments)

    monkeypatch.setattr(cuda_spin_up, "_launch", dying)
    kept = {}
    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            spin_up_many(grains[:2], checkpoints=paths, done=kept.__setitem__, **settings)
    assert any(path.exists() for path in paths)
    resumed = spin_up_many(grains[:2], checkpoints=paths, **settings)
    for found, expected in zip(resumed, undisturbed, strict=True):
        xr.testing.assert_identical(found, expected)
    for number, found in kept.items():
        xr.testing.assert_identical(found, undisturbed[number])


def test_a_grain_that_fails_does_not_stop_the_others(grains, monkeypatch):
    begin = cuda_spin_up.Run.begin

    def spoilt(run, state):
        begin(run, state)
        if run.grain is grains[1]:
            monomer_rows(run.state)[0, 4] = np.nan

    monkeypatch.setattr(cuda_spin_up.Run, "begin", spoilt)
    finished, failures = {}, {}
    with pytest.raises(RuntimeError, match="grain 0: the integration failed"):
        spin_up_many([grains[1], grains[0]], done=finished.__setitem__, max_steps=50, **FAST)
    assert list(finished) == [1]
    found = spin_up_many([grains[1], grains[0]], failed=failures.__setitem__, max_steps=50, **FAST)
    assert found[0] is None and failures[0].startswith("the integration failed")
    xr.testing.assert_identical(found[1], finished[1])


def test_a_failure_of_the_driver_is_one_sentence(grains, monkeypatch):
    def failing(*arguments):
        raise CudaAPIError(2, "CUDA_ERROR_OUT_OF_MEMORY")

    monkeypatch.setattr(cuda_spin_up, "_launch", failing)
    with pytest.raises(InputError, match=r"^the GPU failed \([^\n]*OUT_OF_MEMORY[^\n]*\): [^\n]*[.]$"):
        spin_up_many(grains[:1], **FAST)


def test_relaxation_ends_where_that_of_the_processor_ends(grains, monkeypatch):
    """The pair was pressed: it takes the same number of steps until it rests, and then looks the same."""
    rested = []
    settle = spinup.settle

    def noted(state, timestep_factor):
        rested.append(copy(state))
        settle(state, timestep_factor)

    monkeypatch.setattr(spinup, "settle", noted)
    monkeypatch.setattr(cuda_spin_up, "settle", noted)
    (found,) = spin_up_many(grains[1:2], max_steps=1, **FAST)
    expected = spin_up(grains[1], max_steps=1, **FAST)
    assert rested[0].counter[layout.STEPS] == rested[1].counter[layout.STEPS] > 0
    assert_close(rested[0], rested[1], 1e-9)
    assert_same_run(found, expected, 1e-9)


def test_relaxation_does_not_depend_on_the_company(grains, monkeypatch):
    """Another grain asks for more room while the pressed pair relaxes, so that both go on in a new batch."""
    monkeypatch.setattr(cuda_spin_up, "SEGMENT", 1)
    (alone,) = spin_up_many(grains[1:2], max_steps=20, **FAST)
    take, asked = cuda_spin_up.Spinning.take, []

    def asking(one, batch, place):
        full = take(one, batch, place)
        if one.number == 1 and len(asked) < 2:
            asked.append(one)
            return True
        return full

    monkeypatch.setattr(cuda_spin_up.Spinning, "take", asking)
    found, _ = spin_up_many([grains[1], grains[0]], max_steps=20, **FAST)
    assert len(asked) == 2
    xr.testing.assert_identical(found, alone)
