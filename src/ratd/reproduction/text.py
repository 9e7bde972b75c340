"""Numbers of the document as text, and rows that set ours beside the printed ones."""

from dataclasses import dataclass, field

import numpy as np

from ratd.markdown import markdown_table, measured
from ratd.reproduction.paper import PRINTED, Printed

NOTHING = "–"
NO_DATA = "no data"


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


def mean_and_error(values):
    """Mean and standard error of the finite values; NaN for fewer than two."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    if len(values) < 2:
        return (float(values[0]) if len(values) else np.nan), np.nan
    return float(values.mean()), float(values.std(ddof=1) / np.sqrt(len(values)))


@dataclass(frozen=True)
class Answer:
    """Our value of a printed one.

    Parameters
    ----------
    text : str
        With its uncertainty.
    ratio : str
        Ours over printed.
    """

    text: str = NOTHING
    ratio: str = NOTHING


def over(value, printed):
    """Ours over printed, as text; of both ends where the printed value is a range."""
    if isinstance(printed, tuple):
        return " / ".join(number(own / end) for own, end in zip(value, printed, strict=True))
    return number(value / printed) if printed else NOTHING


def answer(value, error, printed):
    """Answer of a value with an error to a `Printed`."""
    return Answer(with_error(value, error), over(value, printed.value) if printed.value is not None else NOTHING)


def range_answer(low, high, printed, more=""):
    """Answer of a range to a `Printed` with a range."""
    return Answer(between(low, high) + more, over((low, high), printed.value))


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
        head += [drive, "ratio"]
    lines = []
    for row in sorted(rows, key=lambda row: list(PRINTED).index(row.key)):
        cells = [row.printed.place, row.printed.what, row.printed.text]
        for k, drive in enumerate(drives):
            common = row.answers.get("")
            own = row.answers.get(drive) or (common if k == 0 else Answer("(same)") if common else None)
            own = own or Answer(NO_DATA)
            cells += [own.text, own.ratio]
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
