# What all other files of rules need, the config read with a word on where it is wrong, and functions for their params.
import atexit
import sys
from functools import partial
from pathlib import Path

from snakemake.utils import min_version

from ratd.base.errors import FileError, InputError
from ratd.experiments.collision.plan import check as collision_plan
from ratd.experiments.compression.plan import check as compression_plan
from ratd.experiments.spin_up.plan import check as spin_up_plan
from ratd.pipeline import first_error, jobs, unrecorded
from ratd.pipeline.config import read_yaml, together
from ratd.pipeline.partial import tidy
from ratd.pipeline.places import any_of
from ratd.pipeline.report import figure_labels
from ratd.validation.plan import Checks

min_version("9.27")

# Not so in a job on a cluster, which is a Snakemake of its own and may outlive the one that sent it.
if workflow.is_main_process:
    jobs.release_stale_locks()
# A dry run may be beside one that is at work.
if workflow.is_main_process and not workflow.output_settings.dryrun:
    # told again at the very end, below all that Snakemake says of it
    first_error.begin()
    atexit.register(first_error.tell_again)


def checked(read, *arguments):
    """What a function gives, or the end of Snakemake with one sentence where it finds the config wrong."""
    try:
        return read(*arguments)
    except (FileError, InputError) as error:
        sys.exit(str(error))


def task(script, function, *writes):
    """The param that says what is to be done, see `ratd.pipeline.jobs.task`."""
    return jobs.task(
        Path(workflow.basedir, "workflow", "scripts", f"{script}.py"), function, *writes
    )


def results_folder(config):
    """Folder of all results."""
    return str(Path(config["results"]))


def figure_input(name):
    """Function of the wildcards that gives the files of a figure, by name."""
    return lambda w: PLAN.figure_input(name, w.get("drive"))


def figure_settings(name):
    """Function of the wildcards that gives the settings of a figure."""
    return lambda w: PLAN.figure(name, w.get("drive"))


def piece_settings(check):
    """Function of the wildcards that gives the settings of a piece of a check."""
    return lambda w: CHECKS.pieces[w.extent][check][w.piece]


def say(notes):
    """Tell what the plan leaves out."""
    if workflow.is_main_process:
        print(*notes, sep="\n", end="\n" if notes else "", file=sys.stderr)


# Snakemake reads these too, but does not say in which line one is no YAML.
for path in (
    "config/config.yaml",
    "config/spin_up.yaml",
    "config/compression.yaml",
    "config/collision.yaml",
):
    checked(read_yaml, path)
