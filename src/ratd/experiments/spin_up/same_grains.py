"""The same grains spun up in several ways: with other constants of the material, at another rate or step.

A grain compared with itself has no scatter from its form, so that few grains show what a setting does. Each way is a
file of its own, like one of the ensemble, and all files of a job are made together, grain by grain.
"""

from dataclasses import replace
from pathlib import Path

from ratd.base.materials import Material
from ratd.engine.layout import DT
from ratd.engine.leapfrog import leapfrog
from ratd.engine.state import new_state
from ratd.experiments.spin_up.grow import grown
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run_files import run_row
from ratd.experiments.spin_up.spin import told, turn
from ratd.geometry.box import open_space
from ratd.laws.jkr_with_springs import jkr
from ratd.pipeline.jobs import failure_told
from ratd.pipeline.partial import Block

__all__ = ["calibrate", "first_step", "of_material", "spin_up_ways", "steps_to", "vary", "way_material"]


def of_material(grain, **changed):
    """The same grain with other constants of its material.

    Parameters
    ----------
    grain : ratd.Grain
    **changed
        Attributes of `ratd.Material`.

    Returns
    -------
    ratd.Grain
        Monomers, type and seed are those of the grain, which does not grow anew.
    """
    return grain.replace(material=replace(grain.material, **changed))


def way_material(way):
    """Material of the spun-up grains of a way, see `spin_up_ways`."""
    return replace(Material(**way["grain"]["material"]), **way["changed"])


def first_step(grain, timestep_factor):
    """Time step [s] with which a spin-up of a grain as grown begins, by Eq. 31."""
    parts = jkr(), open_space(), leapfrog(timestep_factor=timestep_factor)
    state = new_state(grain.position, grain.radius, grain.material, grain.contacts, *parts)
    return float(state.scalar[DT])


def steps_to(grain, reach, angular_acceleration, timestep_factor):
    """Number of steps dt in which Eq. 24 takes a grain to omega = reach (d omega/dt / dt)^(1/3), dt being the first.

    With the drive literal grains come apart at a certain `reach` (docs/model/drives.md, literal).
    """
    dt = first_step(grain, timestep_factor)
    return int(reach * (angular_acceleration / dt) ** (1.0 / 3.0) / angular_acceleration / dt)


def spin_up_ways(job, targets, ways, kind, row, *, law=None):
    """Write a file for each way in which the same grains are spun up; a killed job goes on where it was.

    Parameters
    ----------
    job : ratd.pipeline.jobs.Job
    targets : list of path-like
        The files.
    ways : list of dict
        One a file: ``grain`` (material, type, a_eff, radii, migration, from `Settings.grow` of the plan), ``changed``
        (constants of the material that the grains do not grow with), ``seeds``, ``spin_up`` (as
        `ratd.experiments.spin_up.spin.turn` takes it), and optionally ``reach``, after which runs with an angular
        acceleration end (`steps_to`).
    kind : str
        Kind of the files.
    row : callable
        Makes the row of a grain in such a file from the run that `ratd.spin_up` returns.
    law : part, optional
        Contact law of all runs, in place of the one that ``spin_up`` names.
    """
    own = {} if law is None else {"law": law}
    of_target = dict(zip(map(str, targets), ways, strict=True))
    blocks = [
        Block(Path(target), way_material(way), way["seeds"], job.provenance_of(way, []))
        for target, way in of_target.items()
    ]

    def make(waiting, done):
        for number, (block, seed) in enumerate(waiting):
            way = of_target[str(block.target)]
            grain = of_material(grown(way["grain"], seed), **way["changed"])
            how = way["spin_up"]
            if "reach" in way:
                acceleration, factor = how["angular_acceleration"], how["timestep_factor"]
                how = how | {"max_steps": steps_to(grain, way["reach"], acceleration, factor)}
            progress = told(job.progress(f"{block.target.stem} seed {seed}"))
            with failure_told(number, done):
                done(number, row(turn(grain, how, checkpoint=block.checkpoint(seed), progress=progress, **own)))

    job.blocks(blocks, kind, make)


def vary(job):
    """Spin up the same grains in several ways, and keep their marks: a stage of the pipeline."""
    spin_up_ways(job, job.output, job.settings, "disruption", disruption)


def calibrate(job):
    """Spin up the grains of the calibration, and keep their runs: a stage of the pipeline."""
    spin_up_ways(job, job.output, job.settings, "spinup", run_row)
