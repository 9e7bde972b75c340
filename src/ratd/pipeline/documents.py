"""Documents: a template that a person wrote, with slots for numbers.

A slot is ``{{name}}``, ``{{name:.2f}}`` with a format of Python, or ``{{name:.2f±}}`` for a number with its standard
error, with a digit or two more where the error would else be 0. ``{{name:.1%}}`` works too, and ``{{name:.2e}}``
becomes 1.23·10⁻⁶. ``{{name | words}}`` has words that stand
there as long as there is no value; every other slot must have one. A *verdict* is ``{{name=holds}}``: it prints the
word, and is an error when the data give another one. Then a person has to read the sentence again.

Lines between ``<!-- if name -->`` (or ``if not name``) and ``<!-- end -->`` stand only where there are data of this
name, that is values that begin with ``name.``; such parts may stand in each other.
"""

import math
import re
import sys
from difflib import get_close_matches

from ratd.base.errors import FileError, InputError
from ratd.base.measured import Measured

__all__ = ["command", "fill"]

_SLOT = re.compile(r"\{\{\s*([^{}:=|]+?)\s*(?:([:=|])([^}]*))?\}\}")
_CONDITION = re.compile(r"<!-- (?:if (not )?(\S+)|(end)) -->")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def fill(template, values, where="the template"):
    """Text of a template with its slots filled.

    Parameters
    ----------
    template : str
    values : dict
        Name -> number, `Measured`, or text; a verdict is a text. There may be more of them than slots.
    where : str
        Name of the template, for the message.

    Returns
    -------
    str

    Raises
    ------
    InputError
        One sentence: a slot that no value fits, a number that is not finite, or a verdict that is not the one in the
        template.
    """
    kept = _kept(template, values, where)
    missing = [name for name, sign, _ in _SLOT.findall(kept) if name not in values and sign != "|"]
    if missing:
        near = ", ".join(get_close_matches(missing[0], values)) or f"{len(values)} others"
        raise InputError(
            f"{where}: the slot {missing[0]!r} has no value; {len(missing)} slots have none; there are {near}"
        )
    return _SLOT.sub(lambda found: _filled(values, where, *found.groups()), kept)


def _kept(template, values, where):
    """The lines of a template that are to stand."""
    names = {name.partition(".")[0] for name in values if "." in name}
    inside, lines = [], []
    for line in template.splitlines(keepends=True):
        condition = _CONDITION.fullmatch(line.strip())
        if condition is None:
            lines += [line] if all(inside) else []
        elif not condition[3]:
            inside.append((condition[2] in names) is not bool(condition[1]))
        elif inside:
            inside.pop()
        else:
            raise InputError(f"{where} has an 'end' without an 'if' before it")
    if inside:
        raise InputError(f"{where} has an 'if' without an 'end' behind it")
    return "".join(lines)


def _filled(values, where, name, sign, form):
    if sign == "|":
        value, form = values.get(name, form.strip()), ""
    else:
        value = values[name]
    if sign == "=":
        if value != form.strip():
            raise InputError(
                f"the verdict {name} is {value!r}, but {where} says {form.strip()!r}: read the sentences around it "
                "again"
            )
        return form.strip()
    if isinstance(value, str):
        return value
    form = (form or "").strip()
    error = value.error if isinstance(value, Measured) else math.nan
    value = value.value if isinstance(value, Measured) else value
    if not math.isfinite(value):
        raise InputError(f"the value of {name} is {value}, no finite number")
    if not form.endswith("±"):
        return _number(value, form)
    form = form[:-1]
    if not math.isfinite(error) or error == 0.0:
        return _number(value, form)
    form = _fine_enough(error, form)
    return f"{_number(value, form)} ± {_number(error, form)}"


def _fine_enough(error, form):
    """A format with up to two digits more, where those of the template make an error 0 that is not."""
    digits = re.fullmatch(r"\.(\d+)([f%])", form)
    if digits is None:
        return form
    first, kind = int(digits[1]), digits[2]
    forms = [f".{first + more}{kind}" for more in range(3)]
    return next((each for each in forms if float(format(error, each).rstrip("%")) > 0.0), form)


def _number(value, form):
    text = format(value, form) if value else "0"
    if float(text.rstrip("%")) == 0.0:
        text = text.removeprefix("-")
    text = text.replace("-", "−")
    mantissa, e, exponent = text.partition("e")
    return f"{mantissa}·10{str(int(exponent.replace('−', '-'))).translate(_RAISED)}" if e else text


def command(words, about, collect, redraw):
    """The command line of a document.

    Parameters
    ----------
    words : list of str
        Those after the name of the module.
    about : str
        The text of the module, which says what the words are.
    collect : callable
        Takes data from a folder of results.
    redraw : callable
        Writes the document and its figures from its data.

    Returns
    -------
    int
        The exit status.
    """
    try:
        match words:
            case ["collect", results]:
                collect(results)
            case ["redraw"]:
                redraw()
            case _:
                print(about.strip())
                return 2
    except (InputError, FileError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0
