"""A pytest plugin that watches every access to memory in kernels that numba simulates, and fails on a race.

Threads of a block are ordered by barriers alone. Two threads that touch the same number between two barriers, one of
them writing it, are a race, also where the simulation happens to run them in an order that does no harm; so what is
found does not depend on how the threads were scheduled. Found are also

* two blocks that touch the same number, one of them writing it;
* shared memory that is read before it was written;
* threads that come to different barriers, or not to as many.

Atomic operations do not race with each other. A barrier of a warp orders the threads of that warp only. Arrays of one
thread (`cuda.local`) are not watched. Functions that the processor's engine shares with the kernels run uncompiled, so
that what they read and write is seen.
"""

import sys
import threading
from contextlib import contextmanager
from operator import index as whole

import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher
from numba.cuda.simulator import kernel as simulation
from numba.cuda.simulator import kernelapi

from ratd.cuda import block

READ, WRITE, ATOMIC = "reads", "writes", "updates"


class Race(Exception):
    """Threads get in each other's way."""


class Element:
    """What was done to one number: by which block, whether it wrote, and all since the last barrier of the block."""

    __slots__ = "accesses", "block", "epoch", "written"

    def __init__(self):
        self.block, self.epoch, self.written, self.accesses = None, -1, False, {}


class Launch:
    """All accesses to memory of one launch of a kernel.

    Attributes
    ----------
    elements : dict
        `Element` by address.
    unwritten : set
        Addresses in shared memory that nobody has written yet.
    kept : list
        Shared arrays, kept so that no address comes twice.
    """

    def __init__(self):
        self.lock, self.elements, self.unwritten, self.kept = threading.RLock(), {}, set(), []

    def note(self, address, kind):
        """Note an access of the thread at work; raise if it races with one before."""
        thread = threading.current_thread()
        if thread.in_atomic:
            kind = ATOMIC
        if kind == READ and address in self.unwritten:
            raise Race(f"{_who(thread, kind, _stack())}, which is shared memory that nobody has written")
        self.unwritten.discard(address)
        element = self.elements.get(address)
        if element is None:
            element = self.elements[address] = Element()
        if element.block is not thread._manager:
            if element.block is not None and (element.written or kind != READ):
                raise Race(f"{_who(thread, kind, _stack())}, which is another block's")
            element.block, element.epoch = thread._manager, -1
        if element.epoch != thread.epoch:
            element.epoch, element.accesses = thread.epoch, {}
        element.written |= kind != READ
        mine = thread.thread_id, thread.warp_epoch, kind
        if mine in element.accesses:
            return
        stack = _stack()
        for (other, warp_epoch, done), where in element.accesses.items():
            ordered = other // block.WARP == thread.thread_id // block.WARP and warp_epoch != thread.warp_epoch
            if other != thread.thread_id and not ordered and not kind == done != WRITE:
                raise Race(f"{_who(thread, kind, stack)}, which thread {other} {done} too: {_at(where)}")
        element.accesses[mine] = stack


def _who(thread, kind, stack):
    return f"block {thread.blockIdx.x}, thread {thread.thread_id} {kind} {_at(stack)}"


def _at(stack):
    return "in " + ", ".join(f"{name} (line {line})" for name, line in stack)


def _stack():
    """Functions and lines of the package and the tests in which the thread is, innermost first."""
    frame, places = sys._getframe(1), []
    while frame is not None:
        if frame.f_globals["__name__"].split(".")[0] not in ("threading", "numba", __name__):
            places.append((frame.f_code.co_name, frame.f_lineno))
        frame = frame.f_back
    return places


class Watched:
    """An array of a kernel; single numbers are read and written under the eyes of a `Launch`, parts are watched too."""

    __slots__ = "array", "begin", "launch", "strides"

    def __init__(self, array, launch):
        self.array, self.launch, self.strides = array, launch, array.strides
        self.begin = array.__array_interface__["data"][0]

    @property
    def shape(self):
        return self.array.shape

    def _address(self, index):
        """Address of one number; None if `index` is that of a part."""
        index = index if isinstance(index, tuple) else (index,)
        if len(index) < self.array.ndim or any(isinstance(i, slice) for i in index):
            return None
        places = [whole(i) for i in index]
        for place, length in zip(places, self.array.shape, strict=True):
            if not 0 <= place < length:  # nothing would notice on a device
                raise IndexError(f"{index} in an array of {self.array.shape}")
        return self.begin + sum(i * stride for i, stride in zip(places, self.strides, strict=True))

    def __getitem__(self, index):
        address = self._address(index)
        if address is None:
            return Watched(self.array[index], self.launch)
        with self.launch.lock:
            self.launch.note(address, READ)
            return self.array[index]

    def __setitem__(self, index, value):
        address = self._address(index)
        assert address is not None, "kernels write one number at a time"
        with self.launch.lock:
            self.launch.note(address, WRITE)
            self.array[index] = value


class SharedArrays(dict):
    """Shared arrays of a block by the place that asks for them, see `ratd.cuda.device`; watched as soon as made."""

    def __init__(self, launch):
        super().__init__()
        self.launch = launch

    def __setitem__(self, place, array):
        watched = Watched(array, self.launch)
        self.launch.kept.append(watched)
        self.launch.unwritten.update(range(watched.begin, watched.begin + array.nbytes, array.itemsize))
        super().__setitem__(place, watched)


def _watch(argument, launch):
    """An argument of a kernel with its arrays watched."""
    if isinstance(argument, np.ndarray):
        return Watched(argument, launch)
    if isinstance(argument, tuple):
        return type(argument)(*(_watch(part, launch) for part in argument))
    return argument


@contextmanager
def _uncompiled():
    """The functions that the engine of the processor compiles, as Python runs them."""
    places = [
        (vars(module), name, value)
        for module_name, module in list(sys.modules.items())
        if module_name.split(".")[0] == "ratd"
        for name, value in vars(module).items()
        if isinstance(value, Dispatcher)
    ]
    for names, name, value in places:
        names[name] = value.py_func
    try:
        yield
    finally:
        for names, name, value in places:
            names[name] = value


def _atomic(function):
    """An atomic operation of the simulation, whose reading and writing count as one."""

    def marked(*arguments):
        thread = threading.current_thread()
        thread.in_atomic = True
        try:
            return function(*arguments)
        finally:
            thread.in_atomic = False

    return marked


def _wait(thread, stack):
    """Wait until all threads of the block have come to their next barrier, which has to be the same one."""
    manager = thread._manager
    with manager.launch.lock:
        if thread.barriers == len(manager.barriers):
            manager.barriers.append(stack)
    expected = manager.barriers[thread.barriers]
    if expected != stack:
        raise Race(f"threads of a block wait at different barriers: {_at(expected)}; {_at(stack)}")
    thread.barriers += 1
    manager.meeting.wait()


def _block_barrier(thread):
    _wait(thread, _stack())
    thread.epoch += 1


def _warp_barrier():
    thread = threading.current_thread()
    _wait(thread, _stack())
    thread.warp_epoch += 1


def _run_block(launch, manager, grid_point, *arguments):
    """Run the threads of a block; the simulation's own looks after them all the time, which takes most of it."""
    places = list(np.ndindex(*manager._block_dim))
    manager.launch, manager.barriers, manager.shared_arrays = launch, [], SharedArrays(launch)
    manager.meeting = threading.Barrier(len(places))

    def target():
        try:
            manager._f(*arguments)
            _wait(threading.current_thread(), [("end", 0)])
        except BaseException:
            manager.meeting.abort()
            raise

    threads = [simulation.BlockThread(target, manager, grid_point, place, False) for place in places]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    failures = [thread.exception[0] for thread in threads if thread.exception]
    failures.sort(key=lambda failure: isinstance(failure, threading.BrokenBarrierError))  # these only follow
    if failures:
        raise failures[0]


@pytest.fixture(autouse=True)
def watched(monkeypatch):
    """Every kernel of every test is watched."""
    launches = []
    call = simulation.FakeCUDAKernel.__call__

    def watched_call(kernel, *arguments):
        launches.append(Launch())
        with _uncompiled():
            call(kernel, *(_watch(argument, launches[-1]) for argument in arguments))

    monkeypatch.setattr(simulation.FakeCUDAKernel, "__call__", watched_call)
    monkeypatch.setattr(simulation.BlockManager, "run", lambda *arguments: _run_block(launches[-1], *arguments))
    for name in ("epoch", "warp_epoch", "barriers", "in_atomic"):
        monkeypatch.setattr(simulation.BlockThread, name, 0, raising=False)
    monkeypatch.setattr(simulation.BlockThread, "syncthreads", _block_barrier)
    monkeypatch.setattr(block, "warp_barrier", _warp_barrier)
    # The threads need not take turns: what is found does not depend on it.
    interval = sys.getswitchinterval()
    sys.setswitchinterval(5e-3)
    for name in ("add", "min"):
        monkeypatch.setattr(kernelapi.FakeCUDAAtomic, name, _atomic(getattr(kernelapi.FakeCUDAAtomic, name)))
    yield
    sys.setswitchinterval(interval)
