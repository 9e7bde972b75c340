"""Documents: a text that people write, with slots for numbers that are filled from data.

A slot is ``{{name}}``. Every slot must have a value; no sentence is made by a program.
"""

import re

from ratd.base.errors import InputError

__all__ = ["fill", "slots"]

_SLOT = re.compile(r"\{\{\s*(.+?)\s*\}\}")


def slots(template):
    """Names of the slots of a template, in their order, each once."""
    return list(dict.fromkeys(_SLOT.findall(template)))


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
        If a slot has no value: one sentence that names it.
    """
    missing = [name for name in slots(template) if name not in values]
    if missing:
        raise InputError(f"{where}: the slot {missing[0]!r} has no value; {len(missing)} slots have none")
    return _SLOT.sub(lambda match: values[match.group(1)], template)
