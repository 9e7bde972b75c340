"""What the files of the spin-up hold: runs, marks of disruption, the ensemble, fragments.

Only the pipeline imports this module, to find a kind of file (see `ratd.pipeline.kinds`): how such files are read
stands in `ratd.experiments.spin_up.run_files`, which needs no compiled code.
"""

from ratd.aggregates.files import CUT_BOUND
from ratd.experiments.spin_up import fragmentation, grain_table, marks, records
from ratd.experiments.spin_up.printed import PAPER
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes

__all__ = ["END_REASONS", "RUN_SETTINGS", "RUN_VALUES"]

_NAN = ("axis_a", "axis_b", "axis_c", "porosity", "angular_momentum", "dissipated_drag", "energy_residual")
"""Records that may be undefined: few monomers have no ellipsoid, the angular momentum of a new fragment is known a step
later, without a torque there is no balance of energy, and runs of older sources have none."""

END_REASONS = ("one contact left", "omega_RAT reached", "max_steps reached")
"""Why a spin-up ended; the flag in a file is the place in this list."""

RUN_VALUES = {
    "seed": Variable((ROW,), "i8", "1", "seed of the grain"),
    "a_eff": Variable((ROW,), "f8", "m", "effective radius of the grain"),
    "steps": Variable((ROW,), "i8", "1", "number of time steps"),
    "timestep": Variable((ROW,), "f8", "s", "first time step"),
    "smaller_steps": Variable((ROW,), "i8", "1", "parts of the run that were made again with smaller steps"),
    "end_reason": Variable((ROW,), "i1", "", "why the run ended", flags=END_REASONS),
    "angular_acceleration": Variable((ROW,), "f8", "rad s-2", "angular acceleration at the start"),
    "cut_bound": Variable((ROW,), "f8", *CUT_BOUND),
    "initial_n_monomers": Variable((ROW,), "i8", "1", "number of monomers after relaxation at rest"),
    "initial_n_contacts": Variable((ROW,), "i8", "1", "number of contacts after relaxation at rest"),
    "initial_mass": Variable((ROW,), "f8", "kg", "mass after relaxation at rest"),
    "initial_axis_a": Variable((ROW,), "f8", "m", "shortest semi-axis after relaxation at rest", nan=True),
    "initial_axis_b": Variable((ROW,), "f8", "m", "middle semi-axis after relaxation at rest", nan=True),
    "initial_axis_c": Variable((ROW,), "f8", "m", "longest semi-axis after relaxation at rest", nan=True),
    "initial_porosity": Variable((ROW,), "f8", "1", "porosity after relaxation at rest", nan=True),
}
"""Numbers of a run, one a grain: attributes of the dataset of a run, variables of the file of a block."""

RUN_SETTINGS = (
    "material", "type", "drive", "spin_up_law", "stretch", "unrest", "pace", "drag", "epsilon", "integrator",
    "displacement", "coriolis", "damping", "timestep_factor",
)  # fmt: skip
"""Attributes of the dataset of a run that are the same for all grains of a block: global attributes of its file."""

_SPINUP_RAGGED = ("record", "fragment", "snapshot", "monomer", "snapshot_monomer")
_SPINUP = {
    **MATERIAL,
    **RUN_VALUES,
    **row_sizes(_SPINUP_RAGGED),
    **{
        name: Variable(("record",), dtype, units, meaning, nan=name in _NAN)
        for name, (units, meaning, dtype) in records.RECORDS.items()
    },
    **{
        name: Variable(("fragment",), "i4" if name == "fragment_n_monomers" else "f8", units, meaning)
        for name, (units, meaning) in records.FRAGMENTS.items()
    },
    **over(("snapshot",), {"snapshot_omega": ("rad s-1", "angular velocity")}),
    **over(("monomer",), {"monomer_radius": ("m", "radius")}),
    **over(
        ("snapshot_monomer",),
        {
            "snapshot_x": ("m", "position along x in the turning frame"),
            "snapshot_y": ("m", "position along y in the turning frame"),
            "snapshot_z": ("m", "position along z in the turning frame"),
        },
        nan=True,
    ),
    "snapshot_fragment": Variable(
        ("snapshot_monomer",), "i4", "1", "fragment: 0 the largest, 1, 2, ... others, -1 dropped"
    ),
    "snapshot_normal_force": Variable(
        ("snapshot_monomer",), "f8", "N", "normal force of greatest magnitude on the monomer, > 0 pushing", nan=True
    ),
}
_DISRUPTION = {
    **MATERIAL,
    **RUN_VALUES,
    **over((ROW,), marks.VARIABLES, nan=True),
    "missing_marks": Variable((ROW,), "str", "", "marks that the run does not contain, and why"),
}

_TEXT_COLUMNS = ("material", "type", "drive", "end_reason", "missing_marks")


def _column(name, dimension, units, meaning):
    """Variable of a column of the table of all grains."""
    if name in _TEXT_COLUMNS:
        return Variable((dimension,), "str", "", meaning)
    if name == "seed":
        return Variable((dimension,), "i8", units, meaning)
    return Variable((dimension,), "f8", units, meaning, nan=True)


_TABLE = {name: _column(name, "grain", *about) for name, about in grain_table.COLUMNS.items()}

_CELLS = {name: _column(name, "cell", *grain_table.COLUMNS[name]) for name in ("material", "type", "a_eff")}
_CELLS["n_grains"] = Variable(("cell",), "i8", "1", "grains in the cell")
for _name, (_units, _meaning) in grain_table.COLUMNS.items():
    if _name not in (*_TEXT_COLUMNS, "a_eff", "seed"):
        for _statistic in ("mean", "minimum", "maximum"):
            _CELLS[f"{_name}_{_statistic}"] = _column(_name, "cell", _units, f"{_statistic} of: {_meaning}")
        _CELLS[f"{_name}_count"] = Variable(("cell",), "i8", "1", f"grains with a value of: {_meaning}")

_PAIR = ("material", "type")
_FIT = {
    "mean_radius": Variable(("mean_radius",), "str", "", "reading of the mean monomer radius in Eq. 33"),
    "material": Variable(("material",), "str", "", "material of the monomers"),
    "type": Variable(("type",), "str", "", "growth: BA, BAM1 or BAM2"),
    **over(
        ("mean_radius", *_PAIR),
        {
            "A": ("1", "fit parameter A of Eq. 33"),
            "A_low": ("1", "lower end of the confidence interval of A"),
            "A_high": ("1", "upper end of the confidence interval of A"),
            "alpha": ("1", "fit parameter alpha of Eq. 33"),
            "alpha_low": ("1", "lower end of the confidence interval of alpha"),
            "alpha_high": ("1", "upper end of the confidence interval of alpha"),
            "scatter": ("1", "standard deviation of the residuals of ln omega"),
        },
        nan=True,
    ),
    **over(_PAIR, {"n_grains": ("1", "grains in the fit"), "n_sizes": ("1", "sizes in the fit")}, dtype="i4"),
    **over(
        _PAIR,
        {
            "A_printed": ("1", "A as printed in Table 3 of the paper"),
            "alpha_printed": ("1", "alpha as printed in Table 3 of the paper"),
        },
        nan=True,
    ),
}


_SPUN_UP_RAGGED = ("fragment",)
_SPUN_UP = {
    **_DISRUPTION,
    **over((ROW,), marks.BEFORE_MARKS, nan=True),
    "source": Variable((ROW,), "str", "", "hash of the source that made the row"),
    **row_sizes(_SPUN_UP_RAGGED),
    **{
        name: Variable(("fragment",), "i4" if name == "fragment_n_monomers" else "f8", units, meaning)
        for name, (units, meaning) in fragmentation.FRAGMENT_COLUMNS.items()
    },
}


def _register(name, title, variables, **options):
    register(name, Kind(title, variables, references=PAPER, **options))


_RUN = {"attributes": RUN_SETTINGS, "of_row": tuple(RUN_VALUES)}
_register(
    "spinup",
    "Spin-up of grains",
    _SPINUP,
    ragged=_SPINUP_RAGGED,
    places=("spinup/{drive}/{material}/{type}/{size}nm/seeds_{seeds}.nc",),
    **_RUN,
)
_register(
    "disruption",
    "Disruption of grains",
    _DISRUPTION,
    places=(
        "disruption/{drive}/{material}/{type}/{size}nm.nc",
        "parameters/{drive}/{type}/{size}nm/*.nc",
        "formulae/*/{type}/{size}nm.nc",
    ),
    **_RUN,
)
_register("table", "All grains of an ensemble", _TABLE, places=("ensemble/{drive}/grains.nc",))
_register("cells", "Grains of an ensemble, averaged per material, type and size", _CELLS)
_register(
    "fit",
    "Fit of Eq. 33 to an ensemble, beside Table 3 of the paper",
    _FIT,
    attributes=("drive",),
    places=("ensemble/{drive}/table3.nc",),
)
_register("spun_up", "Grains that were spun up: marks, fragments", _SPUN_UP, ragged=_SPUN_UP_RAGGED, **_RUN)
