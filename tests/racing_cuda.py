"""Kernels with each of the faults that watched_cuda.py looks for. Run by test_cuda.py, as simulated_cuda.py is:

NUMBA_ENABLE_CUDASIM=1 PYTHONPATH=tests python -m pytest -p watched_cuda tests/racing_cuda.py
"""

import numpy as np
import pytest

from ratd.cuda import block
from ratd.cuda.device import cuda, kernel
from watched_cuda import Race

THREADS = 4


@kernel
def neighbours(numbers, barriers, atomic):
    """Each thread writes its number and reads that of a thread `barriers[1]` away, after a barrier if at all."""
    shared = cuda.shared.array(THREADS, np.int64)
    thread = cuda.threadIdx.x
    shared[thread] = 0
    cuda.syncthreads()
    if atomic:
        cuda.atomic.add(shared, thread, thread)
    else:
        shared[thread] = thread
    if barriers[0] == 1:
        block.warp_barrier()
    if barriers[0] == 2:
        cuda.syncthreads()
    numbers[thread] = shared[thread ^ barriers[1]]


@pytest.mark.parametrize("atomic", [False, True])
@pytest.mark.parametrize("away", [1, 2])
@pytest.mark.parametrize("barrier", [0, 1, 2])
def test_a_barrier_orders_what_it_should(barrier, away, atomic):
    """None, that of a warp (of two threads in the simulation), that of the block; to the same warp and to another."""
    numbers = np.zeros(THREADS, dtype=np.int64)
    arguments = numbers, np.array([barrier, away]), atomic
    if barrier >= away:
        neighbours[1, THREADS](*arguments)
        np.testing.assert_array_equal(numbers, np.arange(THREADS) ^ away)
    else:
        with pytest.raises(Race, match="reads in neighbours .* too|in neighbours .* reads too"):
            neighbours[1, THREADS](*arguments)


@kernel
def same_number(numbers):
    numbers[0] = 1


@kernel
def read_unwritten(numbers):
    shared = cuda.shared.array(2, np.int64)
    if cuda.threadIdx.x == 0:
        shared[0] = 1
    cuda.syncthreads()
    numbers[cuda.threadIdx.x] = shared[1]


@kernel
def leave_early(numbers):
    if numbers[cuda.threadIdx.x] == 0:
        return
    cuda.syncthreads()


@kernel
def wait_elsewhere(numbers):
    if numbers[cuda.threadIdx.x] == 0:
        cuda.syncthreads()
    else:
        cuda.syncthreads()


@kernel
def beyond_the_end(numbers):
    numbers[cuda.threadIdx.x - 1] = 0


@pytest.mark.parametrize(
    ("faulty", "blocks", "threads", "said"),
    [
        (same_number, 1, 2, "writes too"),
        (same_number, 2, 1, "another block's"),
        (read_unwritten, 1, THREADS, "nobody has written"),
        (leave_early, 1, THREADS, "different barriers"),
        (wait_elsewhere, 1, THREADS, "different barriers"),
        (beyond_the_end, 1, THREADS, "in an array of"),
    ],
)
def test_a_fault_is_found(faulty, blocks, threads, said):
    with pytest.raises((Race, IndexError), match=said):
        faulty[blocks, threads](np.arange(THREADS))
