"""Sums, greatest values and prefix sums over a thread block, in an order that depends on nothing but its size.

All threads of the block call these functions together and get the same result. `buffer` is shared memory with a
number for each thread.
"""

from ratd.cuda.device import SIMULATED, cuda, device_function

WARP = 2 if SIMULATED else 32
"""Threads that go together; the simulation gets small ones, so that its few threads are more than one."""

if SIMULATED:

    @device_function
    def warp_barrier():
        """Threads of a warp wait for each other (the simulation knows only the barrier of the whole block)."""
        cuda.syncthreads()

else:

    @device_function
    def warp_barrier():
        """Threads of a warp wait for each other."""
        cuda.syncwarp()


@device_function
def greater(a, b):
    """The greater of two numbers; NaN if one of them is."""
    return a if a > b or a != a else b


@device_function
def tree(buffer, sums, maxima):
    """Sums, or greatest values, over each warp, left at the place of its first thread.

    Parameters
    ----------
    buffer : array
        Parts of one number for each thread.
    sums, maxima : int
        Number of parts to sum up, and of those after them to take the greatest value of.
    """
    thread = cuda.threadIdx.x
    threads = cuda.blockDim.x
    lane = thread % WARP
    stride = WARP // 2
    warp_barrier()
    while stride > 0:
        if lane < stride and thread + stride < threads:
            for part in range(sums):
                buffer[part * threads + thread] += buffer[part * threads + thread + stride]
            for part in range(sums, sums + maxima):
                mine = buffer[part * threads + thread]
                buffer[part * threads + thread] = greater(mine, buffer[part * threads + thread + stride])
        warp_barrier()
        stride //= 2


@device_function
def over_warps(buffer, first, maximum):
    """Sum, or greatest value, of what `tree` has left; a barrier of the block stands between the two."""
    total = buffer[first]
    for place in range(WARP, cuda.blockDim.x, WARP):
        other = buffer[first + place]
        if maximum:
            total = greater(total, other)
        else:
            total += other
    return total


@device_function
def block_sum(value, buffer):
    """Sum of one number of each thread."""
    cuda.syncthreads()  # what was in the buffer has been read
    buffer[cuda.threadIdx.x] = value
    tree(buffer, 1, 0)
    cuda.syncthreads()
    return over_warps(buffer, 0, False)


@device_function
def block_max(value, buffer):
    """Greatest of one number of each thread; NaN if one of them is."""
    cuda.syncthreads()
    buffer[cuda.threadIdx.x] = value
    tree(buffer, 0, 1)
    cuda.syncthreads()
    return over_warps(buffer, 0, True)


@device_function
def chunk_of(n):
    """First of those of n numbers that this thread takes where each takes some in a row, and the first that is not."""
    chunk = (n + cuda.blockDim.x - 1) // cuda.blockDim.x
    first = min(cuda.threadIdx.x * chunk, n)
    return first, min(first + chunk, n)


@device_function
def sum_before(value, counts):
    """Sum of one integer of each thread before this one, and of all threads.

    `counts` is an integer array in shared memory with a number for each thread.
    """
    cuda.syncthreads()  # what was in the counts has been read
    counts[cuda.threadIdx.x] = value
    cuda.syncthreads()
    before = 0
    total = 0
    for place in range(cuda.blockDim.x):
        if place == cuda.threadIdx.x:
            before = total
        total += counts[place]
    return before, total


@device_function
def prefix_sum(values, n, counts):
    """Replace values[k], k < n, by the sum of those before it.

    Parameters
    ----------
    values : integer array
    n : int
    counts : integer array
        As of `sum_before`.

    Returns
    -------
    int
        The sum of all.
    """
    first, last = chunk_of(n)
    cuda.syncthreads()  # other threads may have written the values of this chunk
    inside = 0
    for k in range(first, last):
        inside += values[k]
    before, total = sum_before(inside, counts)
    for k in range(first, last):
        value = values[k]
        values[k] = before
        before += value
    cuda.syncthreads()
    return total
