"""Documents: a text that people write, with slots for numbers that are filled from data.

A slot is ``{{name}}``, or ``{{name | words}}`` with the words that stand there as long as there is no value. Every
other slot must have one. No sentence is made by a program.
"""

import re

from ratd.base.errors import InputError

__all__ = ["fill", "slots"]

_SLOT = re.compile(r"\{\{\s*([^|}]+?)\s*(?:\|\s*([^}]*?)\s*)?\}\}")


def slots(template):
    """Names of the slots of a template, in their order, each once."""
    return list(dict.fromkeys(name for name, _ in _SLOT.findall(template)))


def fill(template, values, where="template"):
    """The text of a template with values in its slots.

    Parameters
    ----------
    template : str
    values : dict of str to str
        There may be more of them than slots.
    where : str
        Name of the template, for the message.

    Returns
    -------
    str

    Raises
    ------
    InputError
        If a slot has neither a value nor words of its own: one sentence that names it.
    """
    missing = [name for name, words in _SLOT.findall(template) if name not in values and not words]
    if missing:
        raise InputError(f"{where}: the slot {missing[0]!r} has no value; {len(missing)} slots have none")
    return _SLOT.sub(lambda match: values.get(match.group(1), match.group(2)), template)
