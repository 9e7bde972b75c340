"""What a run was made with, for the attributes of its Dataset: version, contact law, constants of the material."""

from dataclasses import asdict

from ratd import __version__

__all__ = ["SOURCE", "constants_of", "made_with"]

SOURCE = f"ratd {__version__}"
"""What every run names as its ``source``."""


def constants_of(material):
    """Name of a material, as ``material``, and its constants by their names in `ratd.Material`, dict."""
    constants = asdict(material)
    return {"material": constants.pop("name"), **constants}


def made_with(law, materials):
    """Attributes of a run.

    Parameters
    ----------
    law : part
        The contact law.
    materials : list of ratd.Material
        Of the monomers. The constants are told where all are of one; else the names alone, after each other.

    Returns
    -------
    dict
        ``source``, ``law``, ``material`` and what `constants_of` tells.
    """
    about = constants_of(materials[0]) if len(materials) == 1 else {"material": ", ".join(m.name for m in materials)}
    return {"source": SOURCE, "law": repr(law)} | about
