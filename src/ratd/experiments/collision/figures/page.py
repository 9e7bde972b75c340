"""The page on which a collision is turned and stepped through."""

from ratd.experiments.collision.figures.snapshots import origin_of, positions, row_of
from ratd.pictures.collision_page import collision_page

__all__ = ["page"]


def page(files, settings, say):
    """The page of a job of the pipeline, from the file with the run and its settings."""
    row = row_of(files["runs"], settings["rotation"])
    time, place, piece = positions(row)
    title = f"{row['cluster'].item()}, {row['velocity'].item():g} m/s, rotation {row['seed'].item()}"
    return {"page": collision_page(time, place, row["radius"].values, piece, origin_of(piece), title)}
