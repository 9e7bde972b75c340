"""The page on which the grain of figure 5 is turned and steps through its disruption."""

from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run_files import run_of_seed
from ratd.pictures.grain_page import grain_page

__all__ = ["page"]


def page(files, settings, say):
    """The page of a job of the pipeline, from the file with the run and the settings of figure 5."""
    run = run_of_seed(files["runs"], settings["seed"])
    return {"page": grain_page(run, float(disruption(run)["omega_disr"]), drive=settings["drive"])}
