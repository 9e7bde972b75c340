"""Says in one sentence what is wrong with a file given with --configfile.

Snakemake reads these files before the Snakefile, and tells of a missing one with a traceback and of one that is no YAML
without its line. It looks for plugins by the name of this package, and imports them earlier still.
"""

import sys
from pathlib import Path

from snakemake_interface_logger_plugins.base import LogHandlerBase

OPTIONS = ("--configfile", "--configfiles")


class LogHandler(LogHandlerBase):
    """Logs nothing: a plugin has to have one."""

    writes_to_stream = writes_to_file = has_filter = has_formatter = needs_rulegraph = False

    def emit(self, record):
        """Do nothing."""


def config_files(arguments):
    """Files that follow `--configfile` in arguments of Snakemake, list of str."""
    found, taking = [], False
    for argument in arguments:
        option, sign, value = argument.partition("=")
        if argument.startswith("-"):
            taking = option in OPTIONS
            found += [value] if taking and sign else []
        elif taking:
            found.append(argument)
    return found


def check(arguments):
    """End with one sentence where a config file is missing or no mapping in YAML."""
    from ratd.base.errors import FileError, InputError
    from ratd.pipeline.config import load

    try:
        load(*config_files(arguments))
    except (FileError, InputError) as error:
        sys.exit(str(error))


if Path(sys.argv[0]).stem in ("snakemake", "__main__") and Path("config", "schema", "config.schema.yaml").is_file():
    check(sys.argv[1:])
