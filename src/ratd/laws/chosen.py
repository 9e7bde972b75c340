"""The law that a user means, and whether the step that is to be taken knows it."""

from ratd import laws
from ratd.base.errors import InputError

__all__ = ["check_stiffness", "law_of"]


def law_of(law, default):
    """A law by its name, "dmt" or "jkr", or as it is.

    Parameters
    ----------
    law : str, part or None
    default : callable
        Makes the law that None stands for.

    Returns
    -------
    part

    Raises
    ------
    InputError
        If it is none of these.
    """
    if law is None:
        return default()
    if isinstance(law, str) and law in laws.__all__:
        return getattr(laws, law)()
    if not (isinstance(law, tuple) and hasattr(law, "forces")):
        named = ", ".join(map(repr, laws.__all__))
        raise InputError(f"law is {law!r}; allowed are {named}, or a law of `ratd.laws` with its options.")
    return law


def check_stiffness(law, instead):
    """Raise InputError unless a law tells what the semi-implicit step asks for; `instead` says what to do."""
    if not hasattr(law, "stiffness"):
        raise InputError(
            f"law is {type(law).__name__}, which does not tell its stiffness, and the semi-implicit step asks for it; "
            f"{instead}."
        )
