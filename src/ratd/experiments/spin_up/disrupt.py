"""The marks of disruption of all grains of some files: the stage `disrupt` of the pipeline."""

from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run_files import runs
from ratd.pipeline import io
from ratd.pipeline.blocks import block, material_of

__all__ = ["disrupt"]


def disrupt(files, settings, say):
    """Where the grains of one material, type and size are disrupted.

    Parameters
    ----------
    files : sequence of path-like
        Spin-ups.
    settings : dict
        Empty.
    say : callable
        Called with a sentence.

    Returns
    -------
    dict
        Name of an output -> what it holds.
    """
    opened = [io.read(path, "spinup") for path in files]
    marks = [disruption(run) for file in opened for run in runs(file)]
    for mark in marks:
        if mark.attrs["missing_marks"]:
            say(f"seed {mark.attrs['seed']}: {mark.attrs['missing_marks']}")
    say(f"{len(marks)} grains")
    return {"disruption": block(marks, "disruption", material_of(opened[0]))}
