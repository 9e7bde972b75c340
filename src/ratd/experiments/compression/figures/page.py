"""The page on which a cluster in its box is turned and stepped through."""

from ratd.experiments.compression.files import read_runs
from ratd.pictures.box_page import box_page

__all__ = ["page", "page_of"]


def page_of(run):
    """Page, HTML, of a run with snapshots; see `ratd.pictures.box_page.box_page`."""
    phi, length, place = (run[f"snapshot_{name}"].values for name in ("phi", "box_length", "position"))
    title = f"{run.attrs['n_monomers']} monomers of {run.attrs['material']}"
    return box_page(phi, length, place, run["radius"].values, title)


def page(files, settings, say):
    """The page of a job of the pipeline, from the file with the run."""
    return {"page": page_of(read_runs(files["run"])[0])}
