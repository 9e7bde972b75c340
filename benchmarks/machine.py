"""What the benchmarks run on: processor, memory, one core, versions."""

import os
import platform
import resource
import subprocess
import sys
from functools import cache
from pathlib import Path

from ratd.pipeline.provenance import source_hash, versions


def processor():
    """Name of the processor with what tells it from others of that name, and the number of cores, as one phrase."""
    name = platform.processor() or platform.machine()
    if sys.platform == "darwin":
        name = subprocess.run(
            ["sysctl", "-n", "machdep.cpu.brand_string"], capture_output=True, text=True, check=False
        ).stdout.strip()
    elif Path("/proc/cpuinfo").exists():
        text = Path("/proc/cpuinfo").read_text().split("\n\n")[0]
        about = dict(part.split(":", 1) for part in text.splitlines() if ":" in part)
        about = {key.strip(): value.strip() for key, value in about.items()}
        name = about.get("model name", name)
        if "cpu family" in about:
            name += f" (family {about['cpu family']}, model {about.get('model', '?')})"
        if "avx512f" in about.get("flags", ""):
            name += " with AVX-512"
    return f"{name}, {plural_cores(os.cpu_count())}"


def plural_cores(n):
    """Such as '1 core', '2 cores'."""
    return f"{n} core" if n == 1 else f"{n} cores"


def pin(core):
    """Keep this process, and those that it starts, on one core.

    Parameters
    ----------
    core : int
        Number of the core; the last one that is allowed where this one is not.

    Returns
    -------
    str
        A phrase for the report.
    """
    if not hasattr(os, "sched_setaffinity"):
        return "not pinned to a core (this system has no call for it)"
    allowed = sorted(os.sched_getaffinity(0))
    chosen = core if core in allowed else allowed[-1]
    os.sched_setaffinity(0, {chosen})
    return f"pinned to core {chosen}"


def peak_memory():
    """Greatest resident memory of this process so far [byte]."""
    status = Path("/proc/self/status")
    if status.exists():
        # Not ru_maxrss: on Linux that starts with what the parent process held.
        for line in status.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024
    scale = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * scale


@cache
def source():
    """Hash of all source of ratd that decides what a spin-up computes, and so what it costs."""
    return source_hash(modules=["ratd.experiments.spin_up.run", "ratd.aggregates.growth"])[:12]


def software():
    """Versions as one phrase."""
    return f"{versions()}; source {source()}"


def load():
    """Load of the machine over the last minute, in cores: what else was running [1]."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
