"""Where files lie, and whether what they hold agrees with it.

A kind of file names the places of its files, such as ``grains/{material}/{type}/{size}nm/seeds_{seeds}.nc``. A file
that lies in such a place, in whatever folder, must hold what the path says; a file elsewhere may hold anything.
"""

import re
from functools import cache

import numpy as np

from ratd.base.units import NM

__all__ = ["any_of", "contradiction", "seeds_of", "size_label"]


def size_label(size):
    """A size in nm as it stands in the name of a folder, e.g. ``"50"`` or ``"62.5"``."""
    return f"{size:.10g}"


def any_of(names):
    """Regular expression of any of some names; of none, one that nothing matches, since the empty one is any name."""
    return "|".join(map(re.escape, names)) or "(?!)"


def seeds_of(block):
    """Seeds of a block, a range, from its name such as ``"0-9"``."""
    first, last = (int(seed) for seed in block.split("-"))
    return range(first, last + 1)


def contradiction(dataset, places, path):
    """What a file holds other than its path says.

    Parameters
    ----------
    dataset : xarray.Dataset
        Content of the file.
    places : tuple of str
        Of its kind: ends of paths, with fields such as ``{material}``; ``*`` stands for any name.
    path : path-like
        Of the file.

    Returns
    -------
    str
        Such as ``"has the size 100, but lies where 50 belongs"``; empty where there is none.
    """
    for place in places:
        match = _pattern(place).search(str(path))
        for field, wanted in match.groupdict().items() if match else ():
            found = _found(dataset, field)
            if found is not None and found != wanted:
                return f"has the {field} {found}, but lies where {wanted} belongs"
    return ""


@cache
def _pattern(place):
    text = re.escape(place).replace(r"\*", "[^/]+")
    return re.compile("(?:^|/)" + re.sub(r"\\{(\w+)\\}", r"(?P<\1>[^/]+?)", text) + "$")


def _found(dataset, field):
    """What a dataset says of a field of a place, None where it says nothing."""
    if field == "size":
        return _each(size_label(size / NM) for size in np.atleast_1d(dataset["a_eff"].values))
    if field == "seeds":
        seeds = dataset["seed"].values.tolist()
        first, last = min(seeds), max(seeds)
        return f"{first}-{last}" if seeds == list(range(first, last + 1)) else ", ".join(map(str, seeds))
    if field in dataset.variables:
        return _each(np.atleast_1d(dataset[field].values).tolist())
    return dataset.attrs.get(field)


def _each(values):
    return ", ".join(dict.fromkeys(values)) or None
