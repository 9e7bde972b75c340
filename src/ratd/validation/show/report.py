"""The report: introduction, then the sections of the checks."""

INTRODUCTION = """# Validation

Checks of the model against exact answers, theory and its own convergence. Everything below, numbers and figures, was
written by

    {command}

Nothing in it is typed by hand. Tables of all cases, from which the figures are drawn, lie in `{results}/{extent}` as
netCDF. "±" is a standard error; where only a range is given, it is the range over all cases.
"""


def report(sections, *, extent, results, command):
    """The text of the whole report, Markdown.

    Parameters
    ----------
    sections : list of str
        What `tell` of the checks returned, with their figures.
    extent, results, command : str
        Which extent it is, where its results lie, and what makes it.

    Returns
    -------
    str
    """
    head = INTRODUCTION.format(extent=extent, results=results, command=command)
    return "\n".join([head, *sections])
