"""Numbers of the document as text, and rows that set ours beside the printed ones."""

from dataclasses import dataclass, field

import numpy as np

from ratd.markdown import markdown_table, measured
from ratd.reproduction.paper import PRINTED, Printed

NOTHING = "–"
NO_DATA = "no data"
NEAR = 1.25
"""A printed number holds where ours is within this factor of it ("within a quarter")."""
ROUGHLY = 2.0
"""The same where the paper says "roughly" or gives an order of magnitude."""
VERDICT = {True: "yes", False: "no", None: NOTHING}


def number(value):
    """A number to three figures, or whole, such as "0.123", "45.6", "1234" or "1.23e8"."""
    if value is None or not np.isfinite(value):
        return NOTHING
    if value != 0 and not 1e-3 <= abs(value) < 1e5:
        mantissa, exponent = f"{value:.2e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:.3g}" if abs(value) < 999.5 else f"{value:.0f}"


def with_error(value, error):
    """A value with its error, such as "1.013 ± 0.024" or "(1.02 ± 0.03)e8"."""
    if value is None or not np.isfinite(value):
        return NOTHING
    if not 1e-5 * abs(value) < error < np.inf:  # less than is shown, or the rounding of equal values
        return number(value)
    size = max(abs(value), error)  # a value may be far less than its error
    if 1e-3 <= size < 1e4:
        return measured(value, error)
    exponent = int(np.floor(np.log10(size)))
    scaled = measured(value / 10.0**exponent, error / 10.0**exponent)
    return f"({scaled})e{exponent}" if "±" in scaled else f"{scaled}e{exponent}"


def between(low, high):
    """A range, such as "0.4–0.85", or "-0.4 to -0.1"."""
    return f"{number(low)}{' to ' if min(low, high) < 0 else '–'}{number(high)}"


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
    """Whether values without an error lie within a factor of the printed ones, None where one is not finite."""
    ratio = np.atleast_1d(values) / np.atleast_1d(printed)
    return bool(((ratio > 1 / factor) & (ratio < factor)).all()) if np.isfinite(ratio).all() else None


def lies_in(value, error, low=-np.inf, high=np.inf):
    """Whether a value lies in a range, of which the ends count.

    Returns
    -------
    bool or None
        True and False only where the value and two errors on both sides of it do; None where the data do not tell,
        also where the error is not known.
    """
    if not np.isfinite(value) or not np.isfinite(error):
        return None
    least, most = value - 2 * error, value + 2 * error
    if low <= least and most <= high:
        return True
    return False if most < low or least > high else None


def lies_between(value, error, low=-np.inf, high=np.inf):
    """Whether a value lies above `low` and below `high`, as `lies_in`, but of the range the ends do not count.

    Returns
    -------
    bool or None
    """
    return lies_in(value, error, np.nextafter(low, np.inf), np.nextafter(high, -np.inf))


def all_of(verdicts):
    """Verdict on a finding that has several parts: False where one fails, True where all hold, else None."""
    verdicts = list(verdicts)
    if False in verdicts:
        return False
    return True if verdicts and None not in verdicts else None


def answer(value, error, printed, factor=NEAR):
    """Answer of a value with an error to a `Printed` number; it holds within a factor."""
    holds = lies_in(value, error, printed.value / factor, printed.value * factor)
    return Answer(with_error(value, error), over(value, printed.value), holds)


def range_answer(low, high, printed, holds, more=""):
    """Answer of a range to a `Printed` with a range."""
    return Answer(between(low, high) + more, over((low, high), printed.value), holds)


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
        They are put into the order of `PRINTED`.
    drives : list of str
        Drives that the rows have answers for; empty where they depend on none.

    Returns
    -------
    str
    """
    head = ["where", "what", "printed", "holds if"]
    for drive in drives or ["ours"]:
        head += [drive, "ratio", "holds"]
    lines = []
    for row in sorted(rows, key=lambda row: list(PRINTED).index(row.key)):
        cells = [row.printed.place, row.printed.what, row.printed.text, row.printed.rule or NOTHING]
        for drive in drives or [""]:
            own = row.answers.get(drive, Answer(NO_DATA))
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
