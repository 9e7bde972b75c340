"""When a grain is disrupted: the characteristic angular velocities of one spin-up run.

The marks follow Reissl et al. (2024, A&A 692, A60), Sect. 7.1 and Fig. 4: the peak of the total stress, the loss of a
quarter of the mass, the loss of a quarter of the contacts. Everything is read from the records of the run alone.

What makes the marks well defined
---------------------------------
The total stress is a sum over the contacts of the largest fragment (Eq. 32). It rises about as omega squared until
contacts break, and it vibrates. Three rules turn "where it peaks before it collapses" into one number:

1. *The grain, not what is left of it.* The peak is looked for among the records before the first one in which the
   largest fragment holds less than half (`MAJORITY`) of the mass that the grain started with. Later on the largest
   fragment is a minority of the grain, and a few small monomers can bear a higher stress at a much higher omega than
   the whole grain did. `omega_stress_max` is the same mark without this rule, for comparison.
2. *Outliers do not count.* The records already hold averages over the recording interval; on top of that the stress
   is replaced by its running median over `MEDIAN_WINDOW` records, which removes lone spikes and, unlike a running
   mean, neither lowers nor shifts the edge at which the stress collapses. If the median has the same value in several
   records, the last one counts. A slow vibration of relative amplitude eta survives; since the stress grows as omega
   squared, it can move the mark by at most about a fraction eta of omega.
3. *The peak must be known to be one.* A run that ends before the grain is in pieces (largest fragment below half of
   the mass, or at most one contact left) has no `omega_disr`: the stress might have risen further.

The other marks are first crossings: the first record in which the quantity is at or below its threshold. Contacts
rise above their start in some runs before they fall; that is no crossing. A mark lies at the omega of its record, and
the event took place in the interval before it, so the uncertainty from the recording is that interval, downwards.
"""

import numpy as np
import xarray as xr

from ratd.base.checks import is_number, is_whole
from ratd.base.errors import InputError

MAJORITY = 0.5
"""Fraction of the initial mass below which the largest fragment no longer stands for the grain."""
LOSS = 0.25
"""Fraction of mass or contacts whose loss is a mark (Fig. 4)."""
MEDIAN_WINDOW = 5
"""Records in the running median of the stress, an odd number."""
ROUNDING = 1e-9
"""Relative difference of two masses that is not a loss. The lightest monomer of the largest grain holds 6e-6."""

_NEEDED = ("omega", "mass", "n_contacts", "total_stress", "axis_a", "axis_b", "axis_c", "porosity", "n_fragments_lost")
_NEEDED_ATTRS = (
    "initial_mass",
    "initial_n_contacts",
    "initial_axis_a",
    "initial_axis_b",
    "initial_axis_c",
    "initial_porosity",
)

VARIABLES = {
    "omega_disr": ("rad s-1", "angular velocity of disruption: peak of the total stress before the grain collapses"),
    "omega_disr_uncertainty": ("rad s-1", "half width of the running median in which omega_disr is found"),
    "omega_stress_max": ("rad s-1", "angular velocity of the greatest total stress of any largest fragment in the run"),
    "omega_stress_max_uncertainty": ("rad s-1", "half width of the running median in which omega_stress_max is found"),
    "omega_first_loss": ("rad s-1", "angular velocity of the first loss of mass"),
    "omega_first_loss_uncertainty": ("rad s-1", "recording interval before omega_first_loss"),
    "omega_mass_75": ("rad s-1", "angular velocity at which the largest fragment has lost 25 % of the initial mass"),
    "omega_mass_75_uncertainty": ("rad s-1", "recording interval before omega_mass_75"),
    "omega_contacts_75": ("rad s-1", "angular velocity at which 25 % of the initial contacts are lost"),
    "omega_contacts_75_uncertainty": ("rad s-1", "recording interval before omega_contacts_75"),
    "omega_contacts_max": ("rad s-1", "angular velocity at which the number of contacts first has its maximum"),
    "omega_contacts_max_uncertainty": ("rad s-1", "recording interval before omega_contacts_max"),
    "omega_end": ("rad s-1", "angular velocity of the last record"),
    "omega_end_uncertainty": ("rad s-1", "recording interval before omega_end"),
    "stress_peak": ("Pa", "total stress at omega_disr, running median"),
    "n_contacts_max": ("1", "greatest number of contacts of the largest fragment in the run"),
    "axis_a_start": ("m", "shortest semi-axis of the relaxed grain at rest"),
    "axis_b_start": ("m", "middle semi-axis of the relaxed grain at rest"),
    "axis_c_start": ("m", "longest semi-axis of the relaxed grain at rest"),
    "porosity_start": ("1", "porosity of the relaxed grain at rest"),
    "axis_a_disr": ("m", "shortest semi-axis of the largest fragment at omega_disr"),
    "axis_b_disr": ("m", "middle semi-axis of the largest fragment at omega_disr"),
    "axis_c_disr": ("m", "longest semi-axis of the largest fragment at omega_disr"),
    "porosity_disr": ("1", "porosity of the largest fragment at omega_disr"),
    "mass_fraction_disr": ("1", "mass of the largest fragment at omega_disr over the initial mass"),
    "n_contacts_disr": ("1", "number of contacts of the largest fragment at omega_disr"),
    "n_fragments_lost_disr": ("1", "number of fragments lost up to omega_disr"),
}
"""Units and meaning of every variable of `disruption`, in order. All are float64 scalars, NaN where undefined."""

MARK = "omega_mass_75"
"""The mark that the documents tell results by."""
MARKS = ("omega_disr", "omega_stress_max", "omega_first_loss", "omega_mass_75", "omega_contacts_75")
"""The marks that a run may lack."""

BEFORE_MARKS = {
    f"{name}_{mark}": (units, f"{meaning} in the record before {event}")
    for mark, event in (("first_loss", "the first loss of mass"), ("mass_75", "a quarter of the mass is lost"))
    for name, (units, meaning) in {
        "angular_momentum": ("kg m2 s-1", "angular momentum of the largest fragment"),
        "axis_ratio": ("1", "longest over shortest semi-axis of the largest fragment"),
        "steps": ("1", "time steps"),
    }.items()
}
"""Units and meaning of every variable of `before_marks`."""


def running_median(values, window=MEDIAN_WINDOW):
    """Median over a centred window that shrinks symmetrically towards both ends.

    Parameters
    ----------
    values : array_like, shape (n,)
    window : int
        Number of records, odd.

    Returns
    -------
    numpy.ndarray, shape (n,)
        The ends hold the values themselves, so that a series that rises to its last record keeps its peak there.

    Raises
    ------
    InputError
        If `window` is not a positive odd number.
    """
    if not (is_whole(window) and window >= 1 and window % 2 == 1):
        raise InputError(f"running_median: the window is {window}, but must be a positive odd number of records")
    values = np.asarray(values, dtype=float)
    n = len(values)
    half = np.minimum(np.minimum(np.arange(n), np.arange(n)[::-1]), window // 2)
    result = values.copy()
    for width in range(1, window // 2 + 1):
        if n >= 2 * width + 1:
            median = np.median(np.lib.stride_tricks.sliding_window_view(values, 2 * width + 1), axis=1)
            here = half[width : n - width] == width
            result[width : n - width][here] = median[here]
    return result


def disruption(run, *, majority=MAJORITY, window=MEDIAN_WINDOW):
    """Find the marks of disruption in one spin-up run.

    The definitions are in the text at the head of this module.

    Parameters
    ----------
    run : xarray.Dataset
        What `ratd.spin_up` returns: over `record` the variables omega [rad s-1], mass [kg], n_contacts, total_stress
        [Pa], axis_a, axis_b, axis_c [m], porosity, n_fragments_lost; in the attributes the initial values.
    majority : float
        Part of the initial mass that the largest fragment must hold where the peak is looked for, above 0 and at most
        1.
    window : int
        Records in the running median of the stress, an odd number.

    Returns
    -------
    xarray.Dataset
        The scalars of `VARIABLES`, each with `units` and `long_name`, and the attributes of the run. A mark that
        the run does not contain is NaN and has an attribute `reason`; `missing_marks` lists all of them in one
        sentence each and is empty otherwise. The numbers behind the definitions stand in the attributes
        `disruption_majority`, `disruption_loss` and `disruption_median_window`.

    Raises
    ------
    InputError
        If the run has no records, lacks a variable or an attribute, or holds NaN where a number is needed; if the
        majority or the window is not allowed.

    References
    ----------
    Reissl et al. (2024), A&A 692, A60, Sect. 7.1, Fig. 4 and Eq. 32.
    """
    _check(run)
    if not (is_number(majority) and 0.0 < majority <= 1.0):
        raise InputError(f"disruption: the majority is {majority!r}, but must be above 0 and at most 1")
    omega, mass, n_contacts, stress = (
        run[name].values.astype(float) for name in ("omega", "mass", "n_contacts", "total_stress")
    )
    mass_fraction = mass / run.attrs["initial_mass"]
    contact_fraction = n_contacts / run.attrs["initial_n_contacts"]
    end = run.attrs.get("end_reason", "the records end")
    last = len(omega) - 1

    smooth, peak, top, reason = _peaks(
        mass_fraction, n_contacts, stress, run.attrs["initial_n_contacts"], end, majority, window
    )
    value = {}

    record = {
        "omega_disr": peak,
        "omega_stress_max": top,
        "omega_first_loss": _first(mass_fraction < 1 - ROUNDING),
        "omega_mass_75": _first(mass_fraction <= (1 - LOSS) * (1 + ROUNDING)),
        "omega_contacts_75": _first(contact_fraction <= 1 - LOSS),
        "omega_contacts_max": int(np.argmax(n_contacts)),
        "omega_end": last,
    }
    lost = {
        "omega_first_loss": "any mass was lost",
        "omega_mass_75": "25 % of the mass was lost",
        "omega_contacts_75": "25 % of the contacts were lost",
    }
    interval = np.abs(np.diff(omega, prepend=0.0))
    for name, k in record.items():
        if k is None:
            value[name] = value[f"{name}_uncertainty"] = np.nan
            if name in lost:
                reason[name] = f"{end} before {lost[name]}"
        else:
            value[name] = omega[k]
            median = name in ("omega_disr", "omega_stress_max")
            value[f"{name}_uncertainty"] = _half_width(omega, k, window) if median else interval[k]

    value["stress_peak"] = np.nan if peak is None else smooth[peak]
    value["n_contacts_max"] = n_contacts.max()
    for name in ("axis_a", "axis_b", "axis_c", "porosity"):
        value[f"{name}_start"] = run.attrs[f"initial_{name}"]
        value[f"{name}_disr"] = _at(run[name].values, peak)
    value["mass_fraction_disr"] = _at(mass_fraction, peak)
    value["n_contacts_disr"] = _at(n_contacts, peak)
    value["n_fragments_lost_disr"] = _at(run["n_fragments_lost"].values, peak)

    marks = xr.Dataset(attrs=dict(run.attrs))
    for name, (units, meaning) in VARIABLES.items():
        marks[name] = xr.DataArray(np.float64(value[name]), attrs={"units": units, "long_name": meaning})
        if name in reason:
            marks[name].attrs["reason"] = reason[name]
    marks.attrs["missing_marks"] = "; ".join(f"{name}: {why}" for name, why in reason.items())
    marks.attrs["disruption_majority"] = majority
    marks.attrs["disruption_loss"] = LOSS
    marks.attrs["disruption_median_window"] = window
    return marks


def before_marks(run, marks):
    """What the grain was just before it lost mass.

    Parameters
    ----------
    run : xarray.Dataset
        From `ratd.spin_up`.
    marks : xarray.Dataset
        From `disruption`.

    Returns
    -------
    dict of str to float
        The values of `BEFORE_MARKS`; NaN for a mark that the run lacks.
    """
    values = dict.fromkeys(BEFORE_MARKS, np.nan)
    for mark in ("first_loss", "mass_75"):
        after = _first(run["omega"].values >= marks[f"omega_{mark}"].item())
        if after is not None:
            before = max(after - 1, 0)
            values[f"angular_momentum_{mark}"] = run["angular_momentum"].values[before]
            values[f"axis_ratio_{mark}"] = run["axis_c"].values[before] / run["axis_a"].values[before]
            values[f"steps_{mark}"] = float(run["steps_so_far"].values[before])
    return values


def _peaks(mass_fraction, n_contacts, stress, initial_n_contacts, end, majority, window):
    """Where the stress peaks, in the grain and in the whole run.

    Returns
    -------
    smooth : numpy.ndarray, shape (n,)
        Running median of the stress.
    peak, top : int or None
        Records of `omega_disr` and `omega_stress_max`.
    reason : dict of str
        Why one of them is None.
    """
    last = len(stress) - 1
    reason = {}
    minority = _first(mass_fraction < majority * (1 - ROUNDING))
    in_pieces = n_contacts[last] <= (1 if initial_n_contacts > 1 else 0)
    n_grain = len(stress) if minority is None else minority  # so many records belong to the grain
    # The two parts are filtered apart: no median across the break, and the grain may have its peak in its last record.
    smooth = np.concatenate([running_median(part, window) for part in (stress[:n_grain], stress[n_grain:])])
    peak = top = None
    if minority is None and not in_pieces:
        held = f"{100 * mass_fraction[last]:.3g} % of the mass"
        reason["omega_disr"] = f"{end} while the largest fragment held {held}: the stress might have risen further"
    elif n_grain == 0:
        reason["omega_disr"] = f"the first record is already below {100 * majority:g} % of the mass: record more often"
    else:
        peak = _last_maximum(smooth[:n_grain])
    if in_pieces:
        top = _last_maximum(smooth)
    else:
        reason["omega_stress_max"] = f"{end} with {int(n_contacts[last])} contacts left: a later peak may be higher"
    return smooth, peak, top, reason


def _check(run):
    """Raise InputError unless the run has all that the marks need."""
    if not isinstance(run, xr.Dataset):
        raise InputError(f"disruption: the run is a {type(run).__name__}; it must be what ratd.spin_up returned")
    for name in _NEEDED:
        if name not in run or run[name].dims != ("record",):
            raise InputError(f"disruption: the run has no variable '{name}' over the dimension 'record'")
    if run.sizes["record"] == 0:
        raise InputError("disruption: the run has no records, at least one is needed")
    for name in _NEEDED_ATTRS:
        if name not in run.attrs:
            raise InputError(f"disruption: the run has no attribute '{name}'")
    for name in ("initial_mass", "initial_n_contacts"):
        if not run.attrs[name] > 0:
            raise InputError(f"disruption: the attribute '{name}' is {run.attrs[name]}, but must be above zero")
    for name in ("omega", "mass", "n_contacts", "total_stress"):
        bad = np.flatnonzero(~np.isfinite(run[name].values.astype(float)))
        if len(bad):
            raise InputError(f"disruption: '{name}' of the run is not finite in record {bad[0]}")


def _first(condition):
    """Index of the first true element, None if there is none."""
    return int(np.argmax(condition)) if condition.any() else None


def _last_maximum(values):
    """Index of the greatest element, the last one of equals."""
    return len(values) - 1 - int(np.argmax(values[::-1]))


def _half_width(omega, k, window):
    """Greater of the distances in omega from record k to the two ends of the median window."""
    half = window // 2
    below = omega[k] - omega[k - half] if k >= half else omega[k]
    above = omega[min(k + half, len(omega) - 1)] - omega[k]
    return max(abs(below), abs(above))


def _at(values, k):
    """Value in record k, NaN if there is no such record."""
    return np.nan if k is None else float(values[k])
