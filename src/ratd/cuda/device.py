"""What is compiled for the device and how, and whether there is one.

This is the only module of the package that imports numba's CUDA target. Without a device, numba's simulation
(environment variable NUMBA_ENABLE_CUDASIM=1, set before numba is imported) runs the kernels in Python threads: slow,
for tests. The functions of the CPU engine that a kernel calls are compiled for the processor then.
"""

import os
from contextlib import contextmanager

# Says so at each of the few launches of the last grains; there is nothing that a user could do.
os.environ.setdefault("NUMBA_CUDA_LOW_OCCUPANCY_WARNINGS", "0")

import numba
import numpy as np
from numba import cuda as numba_cuda
from numba.cuda.cudadrv.driver import CudaAPIError

from ratd.errors import InputError

__all__ = [
    "MAX_THREADS", "MIN_THREADS", "SIMULATED", "cuda", "device_function", "failure_in_words", "fetch", "kernel",
    "require", "send", "upload",
]  # fmt: skip

SIMULATED = bool(numba.config.ENABLE_CUDASIM)

if SIMULATED:
    import sys
    import threading

    from numba.cuda.simulator import kernel as simulation

    # Threads of the simulation wait for each other all the time; by default each turn lasts 5 ms.
    sys.setswitchinterval(1e-5)

    class _Shared:
        """`cuda.shared` of the simulation: one array for each line that asks for one, the same for a whole block.

        The simulation's own takes no lock between looking the array up and making it, so that threads that come at the
        same time get an array each (two in ten thousand launches on an idle machine, more on a busy one), and then
        read memory that nobody has written.
        """

        _making = threading.Lock()

        def array(self, shape, dtype):
            caller = sys._getframe(1)
            place = caller.f_code, caller.f_lineno
            block = vars(threading.current_thread()._manager)
            with self._making:
                arrays = block.setdefault("shared_arrays", {})
                if place not in arrays:
                    arrays[place] = np.empty(shape, dtype)
                return arrays[place]

    class _Cuda:
        """`numba.cuda` as the thread at work sees it.

        The simulation puts the thread's own numbers in the place of the name `cuda` of a module while one of its
        functions runs, which goes wrong where several threads are inside several modules.
        """

        shared = _Shared()

        def __getattr__(self, name):
            inside = simulation._kernel_context is not None
            return getattr(simulation._get_kernel_context() if inside else numba_cuda, name)

    cuda = _Cuda()
else:
    cuda = numba_cuda

MIN_THREADS, MAX_THREADS = (3, 3) if SIMULATED else (32, 512)
"""Threads of a block. The simulation makes each a Python thread, so it gets few."""
DRIVER, CAPABILITY = (13, 0), (7, 5)
"""Oldest version of CUDA that the driver may have (driver 580), and oldest compute capability that it compiles for."""


def device_function(function):
    """A function that only kernels call."""
    return function if SIMULATED else numba_cuda.jit(device=True)(function)


def kernel(function):
    """A kernel for blocks of up to `MAX_THREADS` threads, which limits the registers that a thread may take."""
    return numba_cuda.jit(function) if SIMULATED else numba_cuda.jit(launch_bounds=MAX_THREADS)(function)


def require():
    """Raise one clear sentence unless there is a device that kernels can run on.

    Raises
    ------
    InputError
    """
    if SIMULATED:
        return
    if getattr(numba_cuda, "implementation", "Built-in") != "NVIDIA":
        raise InputError("engine is cuda, but the package numba-cuda is missing: install environment-gpu.txt.")
    try:
        reason = _hindrance()
    except Exception as error:  # whatever the driver says, the user needs one sentence
        reason = _last_line(error)
    if reason:
        raise InputError(f"engine is cuda, but {reason}; a GPU of NVIDIA with its driver is needed, or engine: cpu.")


def _last_line(error):
    return (str(error).strip().splitlines() or [type(error).__name__])[-1]


def _hindrance():
    """Why kernels cannot run here, None if they can. Makes no context on the device."""
    from numba.cuda.cudadrv import driver, nvvm

    if not nvvm.is_available():
        return "its compiler was not found (environment-gpu.txt installs it)"
    if not numba_cuda.is_available() or not len(numba_cuda.gpus):
        return "no GPU, or no driver for it, was found"
    if driver.get_version() < DRIVER:
        return "the driver of the GPU is older than 580"
    gpu = numba_cuda.gpus[0]
    if tuple(gpu.compute_capability) < CAPABILITY:
        return f"the GPU has a compute capability below {CAPABILITY[0]}.{CAPABILITY[1]}"
    if gpu.KERNEL_EXEC_TIMEOUT:
        return "the GPU drives a display, whose time limit ends long kernels"
    return None


@contextmanager
def failure_in_words():
    """Turn what the driver says of a failure (no memory left, a device that was lost) into one sentence.

    Raises
    ------
    InputError
    """
    try:
        yield
    except CudaAPIError as error:
        raise InputError(
            f"the GPU failed ({_last_line(error)}): the same command goes on from what is kept, or engine: cpu."
        ) from error


def upload(array):
    """A copy of an array on the device."""
    return array.copy() if SIMULATED else numba_cuda.to_device(np.ascontiguousarray(array))


def fetch(target, source, part=slice(None)):
    """Copy one part (along the first axis) of an array on the device into the same part of one of the host."""
    if SIMULATED:
        target[part] = source[part]
    else:
        source[part].copy_to_host(target[part])


def send(target, source, part=slice(None)):
    """Copy one part (along the first axis) of an array of the host into the same part of one on the device."""
    if SIMULATED:
        target[part] = source[part]
    else:
        target[part].copy_to_device(source[part])
