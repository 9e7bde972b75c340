"""Results that Snakemake has no record of, such as copied ones: whether they are what the plan would make.

Snakemake compares params with those that it wrote down in its own folder. Where that is gone it takes any file for
good. The files say themselves what they were made with.
"""

from base64 import urlsafe_b64encode
from collections import Counter
from pathlib import Path

import netCDF4

from ratd.base.errors import InputError
from ratd.pipeline.provenance import settings_hash

__all__ = ["check"]

_RECORDS = Path(".snakemake", "metadata")


def check(rules, results, forced=()):
    """Raise InputError where results without a record were made with another source or other settings.

    Parameters
    ----------
    rules : iterable of snakemake.rules.Rule
        Their params `task` and `settings` are those of `ratd.pipeline.jobs`.
    results : path-like
        Folder of all results.
    forced : collection of str, optional
        Names of rules, or files, that are made anew whatever there is.

    Raises
    ------
    InputError
        One sentence with the number of such files, one of them, and what to do.
    """
    results = Path(results)
    rules = [rule for rule in rules if hasattr(rule.params, "task") and hasattr(rule.params, "settings")]
    wrong = {}  # file -> name of its rule
    for path in sorted(results.rglob("*.nc")):
        rule = None if _recorded(path) else next((rule for rule in rules if rule.is_producer(str(path))), None)
        if rule is not None and not {rule.name, str(path)} & set(forced) and _is_other(path, rule):
            wrong[path] = rule.name
    if wrong:
        folders = Counter(path.relative_to(results).parts[0] for path in wrong)
        listed = ", ".join(f"{number} in {results / folder}" for folder, number in folders.items())
        raise InputError(
            f"{results}: files that Snakemake has no record of were made with other settings or another source than "
            f"those of now ({listed}), for example {next(iter(wrong))}; the same command with "
            f"--forcerun {' '.join(dict.fromkeys(wrong.values()))} makes them anew with all that follows from them, or "
            "set results to another folder"
        )


def _recorded(path):
    name = urlsafe_b64encode(str(path).encode()).decode()
    # longer names are split into folders of Snakemake's
    if len(name) < 255:
        return (_RECORDS / name).is_file()
    parts = [name[k : k + 254] for k in range(0, len(name), 254)]
    return _RECORDS.joinpath(*(f"@{part}" for part in parts[:-1]), parts[-1]).is_file()


def _is_other(path, rule):
    """Whether a file is one that its rule would make otherwise; not so where it cannot be read."""
    try:
        with netCDF4.Dataset(path) as file:
            found = {name: file.getncattr(name) for name in ("code_hash", "settings_hash")}
    except (OSError, AttributeError):  # damaged or foreign: whoever reads it says so
        return False
    settings = rule.params.settings
    if callable(settings):
        settings = settings(_Wildcards(rule.get_wildcards(str(path))))
    if settings is None:  # of a study that the config leaves out: nobody asks for this file
        return False
    # a job that makes several files may have settings for each
    ways = [settings, *(settings if isinstance(settings, list) else ())]
    return found["code_hash"] != rule.params.task["hash"] or found["settings_hash"] not in map(settings_hash, ways)


class _Wildcards(dict):
    """Wildcards as the functions of params take them."""

    __getattr__ = dict.__getitem__
