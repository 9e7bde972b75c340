"""The report: introduction, then the sections of the checks."""

from ratd.errors import InputError
from ratd.validation.show import (
    convergence,
    damping,
    energy,
    energy_step,
    forces,
    frames,
    growth,
    lammps,
    literal,
    pull_off,
    relaxation,
    theory,
)

MODULES = (
    convergence, damping, energy, energy_step, forces, frames, growth, lammps, literal, pull_off, relaxation, theory
)  # fmt: skip
SHOWN = {module.__name__.rpartition(".")[2]: module for module in MODULES}
"""Check -> module with its `draw` and `tell`."""

INTRODUCTION = """# Validation

Checks of the model against exact answers, theory and its own convergence. Everything below, numbers and figures, was
written by

    {command}

from the tables of all cases in `{data}`, where a README says how these were made. Nothing in it is typed by hand. "±"
is a standard error; where only a range is given, it is the range over all cases.

BA, BAM1, BAM2: grains grown with none, one and two migrations of each monomer. a-C, q-S, co-S: amorphous carbon, quartz
silicate, a mixture of silicates. omega: angular velocity in rad/s. Its marks: omega_disr, where the total stress of the
largest fragment peaks before less than half of the mass is left; omega_first_loss, the first loss of mass;
omega_mass_75 and omega_contacts_75, the loss of a quarter of the mass and of the contacts. epsilon: d omega/dt over
omega². f: the time step over the shortest time of the contacts (Eq. 31). Production: what config/config.yaml has. Cut
bound: the omega at which the weakest cut through the contacts gives way, each holding its pull-off force F_C.
`docs/model.md` says more.
"""


def section(check, words, picture):
    """The section of a check with its figure, Markdown.

    Parameters
    ----------
    check : str
    words : str
        From its `tell`.
    picture : str
        The figure as seen from the text.

    Returns
    -------
    str
    """
    return f"{words}\n\n![{check}]({picture})\n"


def report(folder, tables, pictures, command):
    """The text of docs/validation.md, Markdown.

    Parameters
    ----------
    folder : path-like
        Of the tables, see `ratd.validation.data`.
    tables : dict
        From `ratd.validation.data.whole_tables`.
    pictures : str
        Folder of the figures, as seen from the document.
    command : str
        What writes it.

    Returns
    -------
    str

    Raises
    ------
    InputError
        If a check has no table.
    """
    sections = []
    for check, table in tables.items():
        if table is None:
            raise InputError(
                f"{folder}: lacks the table of {check} as config/validation.yaml asks for it; allowed: tables of this "
                "config (snakemake --cores 2 validation_data makes them)"
            )
        sections.append(section(check, SHOWN[check].tell(table), f"{pictures}/{check}.png"))
    return "\n".join([INTRODUCTION.format(data=folder, command=command), *sections])
