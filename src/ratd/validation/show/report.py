"""The report: introduction, then the sections of the checks."""

INTRODUCTION = """# Validation

Checks of the model against exact answers, theory and its own convergence. Everything below, numbers and figures, was
written by

    {command}

Nothing in it is typed by hand. Tables of all cases, from which the figures are drawn, lie in `{results}/{extent}` as
netCDF. "±" is a standard error; where only a range is given, it is the range over all cases.

BA, BAM1, BAM2: grains grown with none, one and two migrations of each monomer. a-C, q-S, co-S: amorphous carbon, quartz
silicate, a mixture of silicates. omega: angular velocity in rad/s. Its marks: omega_disr, where the total stress of the
largest fragment peaks before less than half of the mass is left; omega_first_loss, the first loss of mass;
omega_mass_75 and omega_contacts_75, the loss of a quarter of the mass and of the contacts. epsilon: d omega/dt over
omega². f: the time step over the shortest time of the contacts (Eq. 31). Production: what config/config.yaml has. Cut
bound: the omega at which the weakest cut through the contacts gives way, each holding its pull-off force F_C.
`docs/model.md` says more.
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
