"""The command `python -m benchmarks`."""

import argparse
import sys
from contextlib import nullcontext
from pathlib import Path

from benchmarks import (
    agreement,
    answer,
    collision,
    compression,
    cost,
    kernel,
    machine,
    peer,
    pipeline,
    profile,
    report,
    scaling,
)
from benchmarks.before import Before
from ratd.base.errors import FileError, InputError
from ratd.drives.rotating import DRIVES
from ratd.experiments.spin_up import plan as spin_up
from ratd.pipeline import config
from ratd.validation import peer_lammps

HERE = Path(__file__).parent
ROOT = HERE.parent
PARTS = ("kernel", "cost", "scaling", "pipeline")
ON_REQUEST = ("profile", "agreement", "answer", "compression", "collision")
"""Parts that are done only when they are named."""

PROFILED = ("150", "300")
"""Sizes [nm] of the profile."""


def parser():
    """The arguments."""
    result = argparse.ArgumentParser(
        prog="python -m benchmarks",
        description="Measure the speed of ratd. Nothing else should run on the machine meanwhile.",
    )
    words = f"{', '.join(PARTS + ON_REQUEST)}; {', '.join(PARTS)} if not given"
    result.add_argument("parts", nargs="*", metavar="PART", help=words)
    result.add_argument("--pairs", type=int, default=5, help="runs of each code in alternation (default 5)")
    result.add_argument("--steps", type=int, default=10_000, help="steps of each run (default 10000)")
    result.add_argument("--aggregate", type=Path, action="append", default=[], metavar="FILE",
                        help="take this aggregate, one line 'x y z a' in metres a monomer, instead of grown ones; "
                        "may be given several times")  # fmt: skip
    result.add_argument("--lammps", metavar="PROGRAM", help="LAMMPS (default: lmp on the PATH or beside this Python)")
    result.add_argument("--no-lammps", action="store_true", help="measure ratd alone")
    result.add_argument("--before", type=Path, metavar="FOLDER",
                        help="another checkout of the repository: the kernel times its engine by turns with this one, "
                        "the agreement compares the marks of both")  # fmt: skip
    result.add_argument("--grains", type=int, default=60, help="grains of the agreement (default 60)")
    result.add_argument("--core", type=int, default=1, help="core to run on (default 1)")
    result.add_argument("--drive", action="append", choices=DRIVES, help="drive of the cost (default: every one)")
    result.add_argument("--config", type=Path, action="append", default=[],
                        help="config that stands over those in config/, for the cost")  # fmt: skip
    result.add_argument("--coarse", type=int, default=30,
                        help="how much faster than the config says the cost spins up (default 30)")  # fmt: skip
    result.add_argument("--full-below", type=float, default=10.0,
                        help="cells that take less than so many seconds are also run in full (default 10)")  # fmt: skip
    result.add_argument("--seeds", type=int, default=10, help="seeds whose bounds are compared per cell (default 10)")
    result.add_argument("--minutes", type=float, default=30.0,
                        help="the cost begins no run after so long; the same command goes on (default 30)")  # fmt: skip
    result.add_argument("--small", type=float, default=150.0,
                        help="the pipeline is measured over sizes up to this one, in nm (default 150)")  # fmt: skip
    result.add_argument("--quick", action="store_true", help="tiny runs that show that it works")
    result.add_argument("--out", type=Path, help="folder of the results (default benchmarks/results; not with --quick)")
    return result


def main(words=None):
    """Measure and report.

    Parameters
    ----------
    words : list of str, optional
        Arguments; those of the command line when not given.

    Returns
    -------
    int
        Exit status: 0, 1 for bad input, 3 when the time was up before the cost was complete.
    """
    arguments = parser().parse_args(words)
    try:
        return _measure(arguments)
    except (InputError, FileError, peer.PeerError) as error:
        say(f"error: {error}")
        return 1


def say(text):
    """Tell how far it is."""
    print(text, file=sys.stderr, flush=True)


def _measure(arguments):
    """Measure the parts that are asked for, then write the report; returns the exit status."""
    parts = arguments.parts or PARTS
    _check(arguments, parts)
    out = arguments.out or HERE / "results"
    about = {
        "machine": machine.processor(),
        "software": machine.software(),
        "load": round(machine.load(), 2),
        # what a quick run measures means nothing, so that it need not have a core to itself
        "pinned": "not pinned to a core" if arguments.quick else machine.pin(arguments.core),
        "quick": "yes" if arguments.quick else "no",
    }
    say(f"{about['machine']}, {about['pinned']}, load {about['load']}; {about['software']}")
    # only the cost tells whether it is complete
    complete = [_MEASURE[part](arguments, out, about) for part in _MEASURE if part in parts]
    if set(parts) == {"agreement"}:
        return 0
    report.write(out)
    if arguments.out is None:
        report.quote(out, ROOT / "docs" / "speed.md")
    say(f"written: {out / 'README.md'}")
    return 3 if False in complete else 0


def _check(arguments, parts):
    unknown = [part for part in parts if part not in PARTS + ON_REQUEST]
    if unknown:
        raise InputError(f"part is {unknown[0]!r}; allowed are {', '.join(PARTS + ON_REQUEST)}.")
    for name in ("pairs", "steps", "grains", "coarse", "seeds"):
        if getattr(arguments, name) < 1:
            raise InputError(f"--{name} is {getattr(arguments, name)}; it must be at least 1.")
    if arguments.before and not (arguments.before / "benchmarks" / "engine.py").exists():
        raise InputError(f"--before is {str(arguments.before)!r}, which is no checkout with benchmarks/engine.py.")
    if "agreement" in parts and not arguments.before:
        raise InputError("The agreement needs --before FOLDER, another checkout of the repository.")
    if arguments.quick and arguments.out is None:
        raise InputError("--quick needs --out FOLDER, so that real results are not written over.")


def _kernel(arguments, out, about):
    program = None if arguments.no_lammps else peer.find(arguments.lammps)
    if arguments.lammps and program is None:
        raise InputError(f"--lammps is {arguments.lammps!r}, which is no program that can be run.")
    if program is None and not arguments.no_lammps:
        say(peer.NOT_FOUND)
    quick = arguments.quick
    with Before(arguments.before) if arguments.before else nullcontext() as before:
        kernel.measure(
            out,
            pairs=2 if quick else arguments.pairs,
            steps=100 if quick else arguments.steps,
            monomers=60 if quick else 2000,
            numbers=(60, 120) if quick else kernel.NUMBERS,
            small_steps=1000 if quick else 50 * arguments.steps,
            files=arguments.aggregate,
            program=program,
            before=before,
            about=about,
            say=say,
        )


def _cost(arguments, out, about):
    return cost.measure(
        out,
        _plan(arguments),
        drives=arguments.drive or list(DRIVES),
        coarse=dict.fromkeys(DRIVES, arguments.coarse),
        full_below=arguments.full_below,
        seeds=2 if arguments.quick else arguments.seeds,
        minutes=arguments.minutes,
        about=about,
        say=say,
    )


def _scaling(arguments, out, about):
    quick = arguments.quick
    scaling.measure(
        out,
        numbers=scaling.NUMBERS[:3] if quick else scaling.NUMBERS,
        repeats=2 if quick else 5,
        updates=1e4 if quick else 4e7,
        about=about,
        say=say,
    )


def _pipeline(arguments, out, about):
    plan = _plan(arguments)
    small = [size for size in plan.sizes[::-1] if float(size) <= arguments.small]
    if not small:
        raise InputError(f"--small is {arguments.small:g}; it must be at least the smallest size, {plan.sizes[-1]}.")
    pipeline.measure(out, plan, root=ROOT, sizes=small, warm=not arguments.quick, about=about, say=say)


def _profile(arguments, out, about):
    plan = _plan(arguments)
    profile.measure(out, plan, sizes=plan.sizes if arguments.quick else PROFILED, about=about, say=say)


def _answer(arguments, out, about):
    peer_lammps.load()  # a sentence where it is missing, before anything is timed
    size, repeats = (50e-9, 1) if arguments.quick else (200e-9, 5)
    answer.measure(out, size=size, repeats=repeats, about=about, say=say)


def _compression(arguments, out, about):
    peer_lammps.load()
    numbers, steps = ((64,), 400) if arguments.quick else ((1024, 16384), 2 * arguments.steps)
    compression.measure(out, numbers=numbers, steps=steps, about=about, say=say)


def _collision(arguments, out, about):
    peer_lammps.load()
    number, duration = (200, 2e-8) if arguments.quick else (collision.NUMBER, 3e-6)
    steps = 400 if arguments.quick else 2 * arguments.steps
    collision.measure(out, number=number, steps=steps, duration=duration, about=about, say=say)


def _agreement(arguments, out, about):
    agreement.main(arguments.before, 3 if arguments.quick else arguments.grains, ROOT, say)


_MEASURE = {
    "kernel": _kernel,
    "cost": _cost,
    "scaling": _scaling,
    "pipeline": _pipeline,
    "profile": _profile,
    "agreement": _agreement,
    "answer": _answer,
    "compression": _compression,
    "collision": _collision,
}


def _plan(arguments):
    """The plan of the spin-up, whose config the files stand over; paths in it are meant from this repository."""
    settings = config.load(ROOT / "config" / "config.yaml", ROOT / "config" / "spin_up.yaml", *arguments.config)
    settings["materials_file"] = str(ROOT / settings["materials_file"])
    if arguments.quick:
        own = {
            "materials": ["q-S"],
            "sizes_nm": [50],
            "seeds": {"first": 0, "number": 2},
            "run": {"stretch": None, "epsilon": 0.5, "timestep_factor": 0.05, "records": 30},
            "literal": {"angular_acceleration": 1e17},
            "snapshots": {"grains": []},
            "figures": dict.fromkeys(settings["spin_up"]["figures"]),
        }
        settings = config.merge(settings, {"spin_up": own})
    return spin_up.check(settings, ROOT / "config" / "schema")


if __name__ == "__main__":
    sys.exit(main())
