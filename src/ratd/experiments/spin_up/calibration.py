"""The one free number of the literal drive: d omega/dt at the printed step factor, fixed on the onset of mass loss.

The printed equations with the Coriolis force at the old velocity feed in energy at a rate ~ omega^2 dt, so that a grain
comes apart at an omega that depends on d omega/dt (docs/model/drives.md). The paper gives no d omega/dt that could be
used ("hours" would be 1e16 steps), but it shows where the mass of one cell starts to fall (Fig. 4). Which d omega/dt
gives just that is found by a fit over several of them. Only d omega/dt over the step counts, so a run with another step
than the printed one stands for one with the printed step and d omega/dt in proportion.
"""

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.errors import InputError
from ratd.base.statistics import jackknife_error, slope_of
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.printed import PAPER
from ratd.experiments.spin_up.run_files import read_runs
from ratd.pipeline.kinds import Kind, as_dataset, entries, over, register

__all__ = [
    "CALIBRATION_COLUMNS",
    "FIT_VALUES",
    "calibrate",
    "calibration_table",
    "fit",
    "onset",
    "printed_acceleration",
    "same_rate",
]

ONSET = "omega_mass_99"
"""The mark that stands for the onset in Fig. 4: a single monomer that comes off cannot be seen there."""
ONSET_LOSS = 0.01
PRINTED_STEP = 0.02
"""f in the time step f min(t_dis) of Eq. 31, Reissl et al. (2024), A&A 692, A60."""
LAW_EXPONENT = 1.0 / 3.0
"""Exponent of d omega/dt in omega ~ (d omega/dt / dt)^(1/3), what the energy that is fed in would give by itself."""
FARTHEST = 100.0
"""No answer is given that lies farther than this factor outside the d omega/dt of the runs."""
CALIBRATION_COLUMNS = {
    "material": ("", "material of the monomers"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "end_reason": ("", "why the run ended"),
    "a_eff": ("m", "effective radius"),
    "seed": ("1", "seed of the grain"),
    "angular_acceleration": ("rad s-2", "angular acceleration at the start"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "timestep": ("s", "first time step"),
    "printed_acceleration": ("rad s-2", "angular acceleration over timestep_factor, times the printed factor of 0.02"),
    "steps": ("1", "number of time steps"),
    "omega_first_loss": ("rad s-1", "angular velocity of the first loss of mass"),
    "omega_mass_99": ("rad s-1", "angular velocity at which the largest fragment has lost 1 % of the initial mass"),
    "omega_mass_75": ("rad s-1", "angular velocity at which the largest fragment has lost 25 % of the initial mass"),
    "omega_end": ("rad s-1", "angular velocity of the last record"),
}
"""Units and meaning of the columns of `calibration_table`."""
FIT_VALUES = {
    "omega_onset": ("rad s-1", "onset of mass loss that the literal drive is to have"),
    "exponent": ("1", "exponent p of omega ~ (d omega/dt)^p, fitted with a prefactor for each grain"),
    "exponent_error": ("1", "standard error of the exponent, by leaving out one grain after the other"),
    "calibrated": ("rad s-2", "d omega/dt at which the mean onset is the wanted one, at the printed step factor"),
    "calibrated_low": ("rad s-2", "calibrated d omega/dt, one standard error lower"),
    "calibrated_high": ("rad s-2", "calibrated d omega/dt, one standard error higher"),
    "calibrated_by_law": (
        "rad s-2",
        "the same with the exponent 1/3, from the slowest run of each grain, of equally slow ones that of the least f",
    ),
}
"""Units and meaning of what `calibrate` gives."""


def printed_acceleration(angular_acceleration, timestep_factor):
    """d omega/dt [rad/s2] at the printed step factor that a run with another one stands for: the same over the step."""
    return angular_acceleration * PRINTED_STEP / timestep_factor


def same_rate(rate):
    """d omega/dt, a Series, without the last digits, in which equal ones of runs with different steps differ."""
    return rate.map(lambda value: float(f"{value:.6g}"))


def onset(run):
    """omega [rad/s] at which a spin-up run has lost `ONSET_LOSS` of its initial mass; NaN where it has not."""
    gone = run["mass"].values <= (1.0 - ONSET_LOSS) * run.attrs["initial_mass"]
    return float(run["omega"].values[gone.argmax()]) if gone.any() else np.nan


def calibration_table(runs):
    """Where the mass of each run starts to fall.

    Parameters
    ----------
    runs : list of xarray.Dataset
        From `ratd.spin_up`.

    Returns
    -------
    pandas.DataFrame
        Columns of `CALIBRATION_COLUMNS`, sorted by seed, printed_acceleration and step. NaN where a run ended before
        a mark.
    """
    rows = []
    for run in runs:
        marks = disruption(run)
        row = {name: run.attrs[name] for name in CALIBRATION_COLUMNS if name in run.attrs}
        row |= {name: float(marks[name]) for name in CALIBRATION_COLUMNS if name in marks}
        row["printed_acceleration"] = printed_acceleration(row["angular_acceleration"], row["timestep_factor"])
        row["omega_mass_99"] = onset(run)
        rows.append(row)
    table = pd.DataFrame(rows, columns=list(CALIBRATION_COLUMNS))
    return table.sort_values(["seed", "printed_acceleration", "timestep_factor"], ignore_index=True)


def calibrate(table, omega_onset):
    """d omega/dt that gives the wanted onset of mass loss with the printed step.

    Parameters
    ----------
    table : pandas.DataFrame
        From `calibration_table`.
    omega_onset : float
        [rad/s].

    Returns
    -------
    xarray.Dataset
        Scalars of `FIT_VALUES`. ln omega is fitted by least squares as a prefactor for each grain and one exponent for
        all; the mean prefactor stands for the grains that the paper averages over. Errors are found by leaving out one
        grain after the other, so that several runs of a grain count as what they are; NaN for one grain. All but
        ``omega_onset`` is NaN where no grain has its onset at two accelerations, and so is every d omega/dt that lies
        more than a factor `FARTHEST` outside those of the runs.

    Raises
    ------
    InputError
        If `omega_onset` is not above zero.
    """
    if not omega_onset > 0:
        raise InputError(f"calibrate: omega_onset is {omega_onset}, but must be above 0 rad/s")
    there = table[table[ONSET].notna()]
    x, y = np.log(there["printed_acceleration"].to_numpy(float)), np.log(there[ONSET].to_numpy(float))
    grain, own = pd.factorize(there["seed"])
    exponent, answer = _inverted(x, y, grain, np.log(omega_onset))
    others = [grain != k for k in range(len(own))]
    left_out = np.array([_inverted(x[k], y[k], grain[k], np.log(omega_onset)) for k in others]).reshape(-1, 2)
    exponent_error, error = (jackknife_error(values) for values in left_out.T)
    least = there.assign(rate=same_rate(there["printed_acceleration"])).sort_values(["rate", "timestep_factor"])
    least = least.drop_duplicates("seed")
    by_law = np.log(least["printed_acceleration"]) + np.log(omega_onset / least[ONSET]) / LAW_EXPONENT
    answers = {
        "calibrated": answer,
        "calibrated_low": answer - error,
        "calibrated_high": answer + error,
        "calibrated_by_law": by_law.mean() if np.isfinite(exponent) else np.nan,
    }
    value = {"omega_onset": omega_onset, "exponent": exponent, "exponent_error": exponent_error}
    for name, own in answers.items():
        known = np.isfinite(own) and x.min() - np.log(FARTHEST) <= own <= x.max() + np.log(FARTHEST)
        value[name] = np.exp(own) if known else np.nan
    return xr.Dataset(
        {
            name: ((), float(value[name]), {"units": units, "long_name": meaning})
            for name, (units, meaning) in FIT_VALUES.items()
        }
    )


def fit(files, settings, say):
    """The table of the runs of the calibration with its fit, from their files.

    Parameters
    ----------
    files : sequence of path-like
        Spin-ups.
    settings : dict
        ``omega_onset`` [rad s-1].
    say : callable
        Called with a sentence.

    Returns
    -------
    dict
        Name of an output -> what it holds.
    """
    table = calibration_table([run for path in files for run in read_runs(path)])
    found = calibrate(table, settings["omega_onset"])
    say(f"calibrated d omega/dt: {float(found['calibrated']):.3g} rad/s2")
    return {"calibration": as_dataset(table).merge(found), "calibration_csv": table}


def _inverted(x, y, grain, wanted):
    """Slope of y = prefactor of the grain + slope x, and the mean over the grains of the x at which y is `wanted`."""
    if not len(x):
        return np.nan, np.nan
    slope, _ = slope_of(x, y, grain)
    rest = pd.Series(wanted - (y - slope * x)).groupby(np.asarray(grain)).mean()
    return slope, float((rest / slope).mean())


register(
    "calibration",
    Kind(
        "Onset of mass loss with the literal drive, and the calibrated angular acceleration",
        entries(CALIBRATION_COLUMNS) | over((), FIT_VALUES, nan=True),
        references=PAPER,
    ),
)
