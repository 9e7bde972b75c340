"""Numbers of the document as text, and rows that set ours beside the printed ones."""

from dataclasses import dataclass, field

import numpy as np

from ratd.markdown import markdown_table, measured
from ratd.reproduction.paper import PRINTED, Printed

NOTHING = "–"
NO_DATA = "no data"
NEAR = 1.25
"""A printed number holds where ours is within this factor of it, unless the paper says "roughly"."""
ROUGHLY = 2.0
"""The same where it does."""
VERDICT = {True: "yes", False: "no", None: NOTHING}


def number(value):
    """A number to three figures, such as "0.123", "45.6" or "1.23e8"."""
    if value is None or not np.isfinite(value):
        return NOTHING
    if value != 0 and not 1e-3 <= abs(value) < 1e5:
        mantissa, exponent = f"{value:.2e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def with_error(value, error):
    """A value with its error, such as "1.013 ± 0.024" or "(1.02 ± 0.03)e8"."""
    if value is None or not np.isfinite(value):
        return NOTHING
    if not error > 1e-9 * abs(value):  # the rounding of equal values
        return number(value)
    if value == 0 or 1e-3 <= abs(value) < 1e4:
        return measured(value, error)
    exponent = int(np.floor(np.log10(abs(value))))
    scaled = measured(value / 10.0**exponent, error / 10.0**exponent)
    return f"({scaled})e{exponent}" if "±" in scaled else f"{scaled}e{exponent}"


def between(low, high):
    """A range, such as "0.4–0.85"."""
    return f"{number(low)}–{number(high)}"


def interval(value, low, high):
    """A value with its interval, such as "2.11 (2.05–2.18)"."""
    return f"{number(value)} ({between(low, high)})" if np.isfinite(low) else number(value)


@dataclass(frozen=True)
class Answer:
    """Our value of a printed one.

    Parameters
    ----------
    text : str
        With its uncertainty.
    ratio : str
        Ours over printed.
    holds : bool or None
        Whether the printed value or finding holds for our grains; None where the data do not decide it.
    """

    text: str = NOTHING
    ratio: str = NOTHING
    holds: bool | None = None


def over(value, printed):
    """Ours over printed, as text; of both ends where the printed value is a range."""
    if isinstance(printed, tuple):
        return " / ".join(number(own / end) for own, end in zip(value, printed, strict=True))
    return number(value / printed) if printed else NOTHING


def near(values, printed, factor=NEAR):
    """Whether values lie within a factor of the printed ones, None where one is not finite."""
    ratio = np.atleast_1d(values) / np.atleast_1d(printed)
    return bool(((ratio > 1 / factor) & (ratio < factor)).all()) if np.isfinite(ratio).all() else None


def beyond(value, error, limit):
    """Whether a value is above a limit, None where it lies within two errors of it."""
    return bool(value > limit) if abs(value - limit) > 2 * error else None


def answer(value, error, printed, factor=NEAR, holds=None):
    """Answer of a value with an error to a `Printed`; it holds within a factor, unless it is told."""
    if printed.value is None:
        return Answer(with_error(value, error), NOTHING, holds)
    found = near(value, printed.value, factor) if holds is None else holds
    return Answer(with_error(value, error), over(value, printed.value), found)


def range_answer(low, high, printed, factor=NEAR, more="", holds=None):
    """Answer of a range to a `Printed` with a range, as `answer`."""
    found = near((low, high), printed.value, factor) if holds is None else holds
    return Answer(between(low, high) + more, over((low, high), printed.value), found)


@dataclass
class Row:
    """One printed value and our answers.

    Parameters
    ----------
    key : str
        Of `ratd.reproduction.paper.PRINTED`.
    answers : dict of str to Answer
        Drive -> answer; the key "" for what depends on no drive.
    reason : str
        Why they differ.
    """

    key: str
    answers: dict = field(default_factory=dict)
    reason: str = ""

    @property
    def printed(self) -> Printed:
        return PRINTED[self.key]


def row_table(rows, drives):
    """All rows as one table in Markdown.

    Parameters
    ----------
    rows : list of Row
        They are put into the order of the paper.
    drives : list of str

    Returns
    -------
    str
    """
    head = ["where", "what", "printed"]
    for drive in drives:
        head += [drive, "ratio", "holds"]
    lines = []
    for row in sorted(rows, key=lambda row: list(PRINTED).index(row.key)):
        cells = [row.printed.place, row.printed.what, row.printed.text]
        for k, drive in enumerate(drives):
            common = row.answers.get("")
            own = row.answers.get(drive) or (common if k == 0 else Answer("(same)") if common else None)
            own = own or Answer(NO_DATA)
            cells += [own.text, own.ratio, VERDICT[own.holds]]
        lines.append([*cells, row.reason if row.answers else ""])
    return markdown_table([*head, "why they differ"], lines)


def drive_rows(key, sources, evaluate, reason=""):
    """Row with an answer for each drive.

    Parameters
    ----------
    key : str
        Of `ratd.reproduction.paper.PRINTED`.
    sources : dict
        Drive -> what `evaluate` takes.
    evaluate : callable
        ``evaluate(source, printed)`` returns an Answer, or None where the data do not hold it.
    reason : str
    """
    found = {drive: evaluate(source, PRINTED[key]) for drive, source in sources.items()}
    return Row(key, {drive: own for drive, own in found.items() if own is not None}, reason)
