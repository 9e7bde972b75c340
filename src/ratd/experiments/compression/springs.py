"""What a squeezed cluster gives back when its box grows again, see `ratd.validation.spring_back`."""

import pandas as pd

from ratd.experiments.compression.strength import measured, of_means

__all__ = ["of_springs"]

RATIOS = {
    "back": ("back", "work"),
    "of_held": ("back", "held"),
    "held": ("held", "work"),
    "last": ("back", "last"),
    "friction": ("lost", "back"),
    "kept": ("kept", "held"),
    "until": ("until", "turn"),
}
"""Slot -> the two numbers of `_of_cluster` whose means are divided."""


def of_springs(table):
    """Work that comes back, of the work that the box did and of what the springs held, in means over clusters.

    Parameters
    ----------
    table : pandas.DataFrame
        Of the kind ``validation_spring_back``.

    Returns
    -------
    dict
        For each filling factor PHI up to which clusters were squeezed: ``springs.back_PHI``, the greatest work that
        the box gets back over what it did; ``springs.of_held_PHI``, over what the springs of rolling and twisting held
        at its turn; ``springs.held_PHI``, what they held over the work of the box; ``springs.last_PHI``, what comes
        back over the work of the box since half the filling factor; ``springs.friction_PHI``, what friction takes
        meanwhile over what comes back; ``springs.kept_PHI``, what the springs hold then over what they held at the
        turn; ``springs.until_PHI``, the filling factor at which
        nothing presses any more over that of the turn; ``springs.n_PHI``, clusters. All of sums over clusters.
    """
    found = {}
    for phi, part in table.groupby("until_phi"):
        each = pd.DataFrame([_of_cluster(own) for _, own in part.groupby("seed")])
        found[f"springs.n_{phi:g}"] = len(each)
        for name, (over, under) in RATIOS.items():
            pairs = each[[over, under]].to_numpy()
            found[f"springs.{name}_{phi:g}"] = measured(of_means(pairs, lambda mean: mean[0] / mean[1]))
    return found


def _of_cluster(rows):
    """Numbers of one cluster, dict: work over E_roll, and filling factors."""
    into, out = (rows[rows["way"] == way].reset_index(drop=True) for way in ("in", "out"))
    end = into.iloc[-1]
    gone = out.loc[out["work"].idxmin()]
    half = into.loc[(into["phi"] / end["phi"] - 0.5).abs().idxmin()]
    return {
        "work": end["work"],
        "last": end["work"] - half["work"],
        "held": end["rolling"] + end["twisting"],
        "back": -gone["work"],
        "lost": gone["lost"],
        "kept": gone["rolling"] + gone["twisting"],
        "turn": end["phi"],
        "until": gone["phi"],
    }
