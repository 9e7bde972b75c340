"""What docs/collision.md is made from: its figures, their files and settings."""

from pathlib import Path

from ratd.experiments.collision.plan import FIGURES as OF_A_CONFIG
from ratd.experiments.collision.plan import SPACING, load

__all__ = [
    "CONFIG",
    "DATA",
    "FIGURES",
    "PAGE",
    "SAMPLES",
    "TABLES",
    "figure_input",
    "figure_module",
    "figure_settings",
    "run_files",
    "samples_settings",
]

CONFIG = ("config/config.yaml", "config/collision.yaml", "config/collision_study.yaml")
"""Config files of the collisions of the document, whatever config Snakemake was given."""
DATA = "docs/collision/data"
TABLES = "results/collision_study/{name}.nc"
SAMPLES = "results/collision_study/samples.nc"
PAGE = "docs/collision/collision.html"
"""The collision of figure 4, to be turned and stepped through in a browser."""
_SHOWN = {"law": "velocity", "mrn": "mrn", "twin": "314nm", "cut": "mrn100"}
"""`cut` is MRN without its smallest spheres."""
_SETTINGS = {
    "figure1": {},
    "figure2": {},
    "figure3": {"rotation": 1, "spacing": SPACING["figure3"]},
    "figure4": {"rotation": 2, "spacing": SPACING["figure4"]},
    "scaling": {},
    "question": {"velocities": [15.0, 30.0]},
}
"""Figure -> its settings where they are not `_SHOWN`."""
FIGURES = {
    name: (*how, _SETTINGS.get(name, _SHOWN))
    for name, how in (OF_A_CONFIG | {"question": ("question", "table")}).items()
}
"""Figure -> module that draws it, what it is drawn from, and its settings."""


def run_files():
    """Committed files of collisions without snapshots, sorted list of str."""
    return sorted(str(path) for path in Path(DATA).glob("*/*.nc") if path.parent.name != "pictures")


def samples_settings():
    """Settings of the stage `build` that makes `SAMPLES`, all samples of MRN that are collided."""
    plan = load(*CONFIG)
    return plan.build(plan.material_of(_SHOWN["law"]).name, _SHOWN["mrn"])


def figure_module(name):
    """Module that draws a figure."""
    return FIGURES[name][0]


def figure_settings(name):
    """Settings of a figure."""
    return FIGURES[name][2]


def figure_input(name):
    """Files that a figure is drawn from, dict of name to list of str."""
    source = FIGURES[name][1]
    if source == "built":
        return {"built": [SAMPLES]}
    if source == "pictures":
        return {"runs": [f"{DATA}/pictures/{name}.nc"]}
    if source == "runs":
        return {"runs": run_files()}
    return {source: TABLES.format(name=f"collision_{source}")}
