"""The command line: one aggregate from a file, one answer.

    python -m ratd spin-up grain.xyz --material q-S
    python -m ratd compress cluster.xyz --material ice
    python -m ratd stretch cluster.xyz --material ice
    python -m ratd collide cluster.xyz --material silica --velocity 10
    python -m ratd show grain.xyz

Each experiment has a module with its subcommand. To add one is a line in `COMMANDS`; what `show` makes of its files is
a line in `SHOWN`.
"""

import sys
import warnings
from importlib import import_module

import click

from ratd import __version__
from ratd.base.errors import FileError, InputError

__all__ = ["main"]

COMMANDS = {
    "spin-up": "ratd.experiments.spin_up.command",
    "compress": "ratd.experiments.compression.command",
    "stretch": "ratd.experiments.compression.stretch_command",
    "collide": "ratd.experiments.collision.command",
    "show": "ratd.command.show",
}
"""Name of a subcommand -> the module whose `command` it is."""

SHOWN = {
    "spinup": "ratd.experiments.spin_up.command",
    "compression": "ratd.experiments.compression.command",
    "stretched": "ratd.experiments.compression.stretch_command",
    "collisions": "ratd.experiments.collision.command",
    "grains": "ratd.command.show",
}
"""Kind of file (see `ratd.pipeline.kinds`) -> the module whose ``show(path, out)`` makes pictures and lines of it."""


class _Commands(click.Group):
    """Subcommands that are loaded when they are called: each brings compiled code of its own."""

    def list_commands(self, context):
        return list(COMMANDS)

    def get_command(self, context, name):
        return import_module(COMMANDS[name]).command if name in COMMANDS else None

    def invoke(self, context):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("once", UserWarning)
                warnings.showwarning = lambda message, *where, **more: click.echo(f"warning: {message}", err=True)
                return super().invoke(context)
        except click.exceptions.Exit:  # a RuntimeError too: --help has said all
            raise
        except KeyboardInterrupt:
            kept = "" if context.invoked_subcommand == "show" else "; the same command goes on with what is kept"
            click.echo(f"stopped{kept}", err=True)
            sys.exit(130)
        except (InputError, FileError, RuntimeError) as error:
            click.echo(f"error: {error}", err=True)
            sys.exit(1)


@click.group(cls=_Commands, context_settings={"max_content_width": 100})
@click.version_option(__version__)
def main():
    """The mechanics of dust aggregates, every monomer integrated.

    FILE holds the spheres of an aggregate: text or CSV with x y z r, extended XYZ, or a LAMMPS dump.
    """
