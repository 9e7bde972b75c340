"""How results are listed in the report of Snakemake."""


def figure_labels(name, shows, form):
    """Labels of a figure, by which the list of the report is sorted as text.

    Parameters
    ----------
    name : str
        Such as ``figure7``; a figure that is none of a paper has any other name.
    shows : str
        What it shows, in a few words.
    form : str
        Suffix of the file.

    Returns
    -------
    dict of str to str
    """
    number = name.removeprefix("figure")
    return {
        "figure": f"{number:>2}" if number.isdigit() else "study",
        "shows": shows,
        "format": form.upper(),
    }
