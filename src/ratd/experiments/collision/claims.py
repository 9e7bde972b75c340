"""The claims of docs/collision.md: what its sentences say and further collisions may overturn.

The document is not written then, and a test fails, until somebody has read the sentence again.
"""

import itertools

import numpy as np

from ratd.base.units import NM
from ratd.experiments.collision.document_samples import chance_of_change, change_by_half
from ratd.experiments.collision.likeness import is_equal
from ratd.experiments.collision.fragmentation import fragmentation_velocities, mean_and_error
from ratd.experiments.collision.printed import PRINTED_THRESHOLDS
from ratd.experiments.collision.thresholds import head_on, is_close, of_paper

__all__ = ["claims"]


def claims(table, thresholds, likeness):
    """What the sentences of the document say, dict of str to bool; all must hold.

    Parameters
    ----------
    table, thresholds, likeness : pandas.DataFrame
        Of `ratd.experiments.collision.tables.findings`.
    """
    of = _Found(table, thresholds, likeness)
    return {**_which_radius(of), **_what_decides(of), **_equal_spheres(of), **_energy(of)}


class _Found:
    """Single numbers of the three tables."""

    def __init__(self, table, thresholds, likeness):
        self.table, self.thresholds, self.likeness = table, thresholds, likeness

    def cell(self, law, cluster, velocity):
        """Central collisions of a cell."""
        table = self.table
        same = (table["law"] == law) & (table["cluster"] == cluster) & (table["impact_parameter"] == 0.0)
        return table[same & np.isclose(table["velocity"], velocity)]

    def mean(self, column, law, cluster, velocity):
        """Mean of a column in a cell."""
        return mean_and_error(self.cell(law, cluster, velocity), column)[0]

    def first(self, column, law, cluster, velocity):
        """Value of the first rotation of the first sample."""
        own = self.cell(law, cluster, velocity)
        return own.loc[(own["sample"] == 1) & (own["seed"] == 0), column].iloc[0]

    def apart(self, column, cluster, other, velocity, law="velocity"):
        """By how many standard errors the means of two clusters differ, the other under another law if wanted."""
        parts = self.cell("velocity", cluster, velocity), self.cell(law, other, velocity)
        (one, error), (two, error_two) = (mean_and_error(part, column) for part in parts)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.abs(one - two) / np.hypot(error, error_two)

    def rises(self, column, law, cluster, other, velocity):
        """Whether a mean is greater for the other cluster, or not less by more than two standard errors."""
        parts = (mean_and_error(self.cell(law, name, velocity), column) for name in (cluster, other))
        (one, error), (two, error_two) = parts
        return two > one - 2.0 * np.hypot(error, error_two)

    def halved(self, column, cluster):
        """By how much a column changes with half the step, mean and error, see `document_samples.change_by_half`."""
        return mean_and_error(change_by_half(self.table, column, cluster), "change")

    def threshold(self, law, cluster, impact_parameter=0.0):
        """Row of a fragmentation velocity."""
        own = self.thresholds[(self.thresholds["law"] == law) & (self.thresholds["cluster"] == cluster)]
        return own[np.isclose(own["impact_parameter"], impact_parameter)].iloc[0]

    def frag(self, law, cluster):
        """Fragmentation velocity [m/s] of central collisions."""
        return self.threshold(law, cluster)["velocity"]

    def over_stick(self, law, cluster):
        """Fragmentation velocity over the sticking velocity of two of the spheres."""
        return self.frag(law, cluster) / self.threshold(law, cluster)["sticking_velocity"]

    def by_sample(self, law, cluster):
        """Fragmentation velocity [m/s] of each sample, (k,) array."""
        own = self.table[(self.table["law"] == law) & (self.table["cluster"] == cluster)]
        return fragmentation_velocities(own[own["impact_parameter"] == 0.0])

    def alike(self, law, quantity, cluster="mrn"):
        """Radius [m] of the equal spheres that a cluster is like."""
        own = self.likeness[(self.likeness["law"] == law) & (self.likeness["cluster"] == cluster)]
        return own[own["quantity"] == quantity]["radius"].iloc[0]


def _which_radius(of):
    """Which equal spheres MRN is like, and which not."""
    return {
        "the radii that MRN is like, as rounded in the answer": all(
            abs(of.alike(law, quantity) - radius) < 0.016e-6
            for law, quantity, radius in (
                ("velocity", "N_s", 0.24e-6),
                ("velocity", "X", 0.29e-6),
            )
        ),
        "by N_s the radius with rate friction is below those that the paper tried": of.alike("velocity", "N_s")
        < 0.28e-6,
        "the recipe is good to a quarter for v_frag": 0.72
        < of.frag("velocity", "353nm") / of.frag("velocity", "mrn")
        < 0.85,
        "the recipe's radius comes apart before MRN, and breaks more": of.frag("velocity", "353nm")
        < of.frag("velocity", "mrn") - 3.0
        and of.mean("N_s", "velocity", "353nm", 20) > of.mean("N_s", "velocity", "mrn", 20) + 0.4,
        "N_s of MRN runs between 0.22 and 0.26 um until its ceiling": all(
            of.mean("N_s", "velocity", "220nm", speed) < of.mean("N_s", "velocity", "mrn", speed)
            and of.mean("N_s", "velocity", "mrn", speed) < of.mean("N_s", "velocity", "260nm", speed) + 0.02
            for speed in (20, 25, 30)
        )
        and of.mean("N_s", "velocity", "mrn", 40) < of.mean("N_s", "velocity", "260nm", 40) - 0.05,
        "X of MRN runs between 0.26 and 0.314 um": all(
            of.mean("X", "velocity", "314nm", speed) < of.mean("X", "velocity", "mrn", speed)
            and of.mean("X", "velocity", "mrn", speed) < of.mean("X", "velocity", "260nm", speed)
            for speed in (20, 25, 30)
        ),
        "energy left of MRN lies below the equal spheres in slow impacts and not in fast ones": of.mean(
            "energy_half", "velocity", "mrn", 15
        )
        < of.mean("energy_half", "velocity", "260nm", 15)
        and of.apart("energy_half", "mrn", "260nm", 15) > 2.0
        and of.mean("energy_half", "velocity", "mrn", 40) > of.mean("energy_half", "velocity", "260nm", 40),
        "and cannot choose a radius in fast ones": mean_and_error(of.cell("velocity", "mrn", 40), "energy_half")[1]
        > of.mean("energy_half", "velocity", "353nm", 40) - of.mean("energy_half", "velocity", "220nm", 40),
        "of MRN sliding takes most": of.mean("by_sliding", "velocity", "mrn", 30)
        > 0.5
        > of.mean("by_damping", "velocity", "mrn", 30),
        "MRN without its smallest spheres has the v_frag of 0.353 um, and not that of its own recipe": abs(
            of.frag("velocity", "mrn100") - of.frag("velocity", "353nm")
        )
        < 3.0
        and of.frag("velocity", "mrn100") > 1.7 * of.frag("velocity", "453nm"),
        "by N_s no radius is like MRN without its smallest spheres": all(
            of.mean("N_s", "velocity", "353nm", speed) > of.mean("N_s", "velocity", "mrn100", speed) + 0.1
            for speed in (15, 30)
        ),
        "without giants the recipe's 283 nm is the best radius within 20 nm": all(
            abs(of.alike("velocity", quantity, "mrn100_to_800") - 283e-9) < 20e-9 for quantity in ("X", "N_s")
        ),
        "and holds far better than that at 15 m/s": of.mean("X", "velocity", "mrn100_to_800", 15)
        > of.mean("X", "velocity", "260nm", 15)
        > of.mean("X", "velocity", "298nm", 15) + 0.05,
        "nearly all mass of MRN stays in large pieces": of.mean("large_share", "velocity", "mrn", 30)
        > 0.9
        > of.mean("large_share", "velocity", "mrn100", 30)
        > of.mean("large_share", "velocity", "260nm", 30)
        > of.mean("large_share", "velocity", "314nm", 30)
        > of.mean("large_share", "velocity", "353nm", 30),
        "the recipe's radius breaks into many times as many pieces": of.mean("n_pieces", "velocity", "353nm", 20)
        > 10.0 * of.mean("n_pieces", "velocity", "mrn", 20),
        "the fragmentation velocities of the samples of MRN and of 0.353 um do not overlap": bool(
            of.by_sample("velocity", "mrn").min() > of.by_sample("velocity", "353nm").max()
        ),
        "with springs MRN is at its ceiling at 30 m/s": of.mean("N_s", "spring", "mrn", 30)
        > 0.95 * (1.0 - of.mean("largest_share", "spring", "mrn", 30)),
        "energy left of MRN is not that of 0.314 um at 15 m/s": of.mean("energy_half", "velocity", "mrn", 15)
        < 0.75 * of.mean("energy_half", "velocity", "314nm", 15),
        "with springs the recipe's radius breaks less than MRN": of.mean("X", "spring", "353nm", 15)
        > max(of.mean("X", "spring", name, 15) for name in ("mrn", "mrn100")),
    }


def _what_decides(of):
    """What the largest and the smallest spheres do, and friction."""
    unequal = of.table[~is_equal(of.table)]
    ceiling = 1.0 - of.cell("velocity", "mrn", 40).groupby("sample")["largest_share"].mean().mean()
    return {
        "N_s never exceeds one less the share of the largest sphere": bool(
            (unequal["N_s"] <= 1.0 - unequal["largest_share"] + 1e-9).all()
        ),
        "N_s of MRN is near its ceiling at 40 m/s": of.mean("N_s", "velocity", "mrn", 40) > ceiling - 0.12,
        "contacts of MRN do not matter within the errors": of.apart("X", "mrn100", "mrn100_tree", 15) < 2.0
        and of.apart("N_s", "mrn100", "mrn100_tree", 30) < 2.0,
        "without giants MRN comes apart at 30 m/s all the same": of.mean("X", "velocity", "mrn100_to_800", 30) < 0.15,
        "springs break MRN more": of.mean("N_s", "spring", "mrn100", 15)
        > of.mean("N_s", "velocity", "mrn100", 15) + 0.3,
        "the largest sphere holds 0.25 to 0.40 of the mass": 0.24
        < of.cell("velocity", "mrn", 30)["largest_share"].min()
        and of.cell("velocity", "mrn", 30)["largest_share"].max() < 0.41,
        "with half the step MRN breaks more, which may be chance": of.halved("N_s", "mrn")[0] > 0.0
        and of.halved("X", "mrn")[0] < 0.0
        and chance_of_change(change_by_half(of.table, "N_s", "mrn")) > 0.05,
        "and MRN above 0.1 um by a few hundredths at most": abs(of.halved("N_s", "mrn100")[0]) < 0.04
        and abs(of.halved("X", "mrn100")[0]) < 0.04,
        "with half the step MRN above 0.1 um breaks alike": of.apart("N_s", "mrn100", "mrn100", 30, law="half_step")
        < 2.0,
        "at 30 m/s N_s of MRN is far below that of equal spheres": of.mean("N_s", "velocity", "mrn100", 30)
        < of.mean("N_s", "velocity", "314nm", 30) - 0.1,
        "without giants MRN holds best": of.mean("X", "velocity", "mrn100_to_800", 15)
        > max(of.mean("X", "velocity", name, 15) for name in ("mrn100", "314nm", "314nm_giant")),
        "one large sphere among equal ones has the same ceiling": of.mean("N_s", "velocity", "314nm_giant", 30) < 0.7,
        "at 30 m/s X of MRN is near the limit": of.mean("X", "velocity", "mrn100", 30) < 0.25,
        "the pair that held together had not finished": of.first("X_early", "velocity", "mrn", 30)
        > 0.8
        > 0.3
        > of.first("X", "velocity", "mrn", 30),
        "the smallest spheres glue": of.mean("X", "velocity", "mrn", 20) > of.mean("X", "velocity", "mrn100", 20) + 0.1
        and of.mean("N_s", "velocity", "mrn", 20) < of.mean("N_s", "velocity", "mrn100", 20) - 0.1
        and of.mean("energy_half", "velocity", "mrn", 15) < 0.8 * of.mean("energy_half", "velocity", "mrn100", 15),
        "with springs MRN keeps more energy than 0.298 and 0.314 um": all(
            of.mean("energy_half", "spring", "mrn", speed) > of.mean("energy_half", "spring", name, speed) + 0.04
            for speed in (15, 30)
            for name in ("298nm", "314nm")
        )
        and of.mean("energy_half", "spring", "mrn", 30) > of.mean("energy_half", "spring", "570nm", 30),
        "with springs N_s at 15 m/s is lower with the smallest spheres": of.mean("N_s", "spring", "mrn", 15)
        < of.mean("N_s", "spring", "mrn100", 15),
        "a giant breaks what is around it": of.mean("N_s_rest", "velocity", "314nm_giant", 30)
        > of.mean("N_s", "velocity", "314nm", 30) + 0.05,
        "with springs MRN comes apart at 15 m/s where 0.314 um holds": of.mean("X", "spring", "mrn", 15)
        < 0.3
        < of.mean("X", "spring", "314nm", 15),
    }


def _equal_spheres(of):
    """Fragmentation velocities of equal spheres."""
    thresholds, table = of.thresholds, of.table
    ratios = of_paper(head_on(thresholds))
    ratios = ratios[(ratios["friction"] == "velocity") & is_close(ratios)].dropna(subset="sticking_velocity")
    at_half = ratios[ratios["damping_time"] == 0.5e-9]
    at_half, ratios = (own["velocity"] / own["sticking_velocity"] for own in (at_half, ratios))
    base = of.frag("velocity", "570nm")
    printed = {f"{radius / NM:.0f}nm": velocity for radius, velocity in PRINTED_THRESHOLDS.items()}
    return {
        "twice the surface energy gives the printed v_frag of 0.57 um within its error": abs(
            of.frag("velocity_50mJ", "570nm") - printed["570nm"]
        )
        < of.threshold("velocity_50mJ", "570nm")["error"],
        "springs lower the fragmentation velocity": of.frag("spring", "570nm") < 0.8 * base,
        "with twice the surface energy v_frag doubles, with half it halves": 1.6 * base
        < of.frag("velocity_50mJ", "570nm")
        < 2.2 * base
        and 0.45 * base < of.frag("velocity_12mJ", "570nm") < 0.65 * base,
        "second contacts and limits of sliding and twisting hardly move v_frag": all(
            abs(of.frag(*changed) - base) < 0.12 * base
            for changed in (
                ("velocity", "570nm_tree"),
                ("velocity", "570nm_full"),
                ("slide_4", "570nm"),
                ("twist_10", "570nm"),
            )
        ),
        "the limit of rolling moves it": 1.1 * base < of.frag("roll_100", "570nm") < 1.5 * base,
        "JKR lies between springs and rate friction": of.frag("spring", "570nm") < of.frag("jkr", "570nm") < base,
        "off centre v_frag falls at the greater impact parameter only": abs(
            of.threshold("velocity", "570nm", 0.3)["velocity"] - base
        )
        < 0.15 * base
        and of.threshold("velocity", "570nm", 0.6)["velocity"] < 0.75 * base,
        "with half the step 0.353 um breaks alike": of.apart("N_s", "353nm", "353nm", 15, law="half_step") < 2.0
        and of.apart("X", "353nm", "353nm", 15, law="half_step") < 2.0,
        "equal spheres go on parting after 3 us": of.frag("longer", "314nm") < of.frag("velocity", "314nm"),
        "at A = 0.5 ns all are half to three fifths of the printed ones": all(
            0.45 * velocity < of.frag("velocity", name) < 0.65 * velocity
            for name, velocity in printed.items()
            if np.isfinite(of.frag("velocity", name))
        ),
        "v_frag is 17 to 22 times v_stick at A = 0.5 ns": bool(16.5 < at_half.min() and at_half.max() < 22.5),
        "energy of the impact over the contacts grows sevenfold": 5.5
        < of.threshold("velocity", "298nm")["energy_per_contact"]
        / of.threshold("velocity", "570nm")["energy_per_contact"]
        < 8.5,
        "v_frag over v_stick is less for smaller spheres": of.over_stick("velocity", "220nm")
        < of.over_stick("velocity", "260nm")
        < 16.0,
        "v_frag over v_stick falls with A": bool(ratios.min() < 0.6 * at_half.min()),
        "a greater A brings them near": all(
            of.frag("velocity_1.0ns", name) < 1.2 * printed[name]
            and of.frag("velocity_1.5ns", name) > 0.8 * printed[name]
            for name in ("570nm", "453nm")
        ),
        "the balance is closed": bool(
            (table["balance"] <= np.where(table["friction"] == "spring", 0.03, 0.01) + 1e-12).all()
        ),
    }


def _energy(of):
    """Where the energy of an impact is."""
    return {
        "energy left rises with the radius but where two agree within their errors": all(
            of.rises("energy_half", "velocity", small, large, speed)
            for small, large in itertools.pairwise(("298nm", "314nm", "353nm", "396nm", "453nm", "570nm"))
            for speed in (10, 15, 20, 25, 30)
        ),
        "and does so from the least to the greatest": all(
            of.mean("energy_half", "velocity", "570nm", speed)
            > 1.15 * of.mean("energy_half", "velocity", "298nm", speed)
            for speed in (10, 15, 20, 25, 30)
        ),
        "energy left tells little among equal spheres": of.mean("energy_half", "velocity", "353nm", 30)
        - of.mean("energy_half", "velocity", "314nm", 30)
        < 0.02,
        "potential over kinetic energy is small in a fast impact only": of.mean(
            "potential_share", "velocity", "314nm", 30
        )
        < 0.01
        < min(
            of.mean("potential_share", "velocity", "570nm", 2),
            of.mean("potential_share", "velocity", "mrn", 25),
        ),
        "of equal spheres damping and sliding take alike": 0.6
        < of.mean("by_sliding", "velocity", "570nm", 30) / of.mean("by_damping", "velocity", "570nm", 30)
        < 1.1,
    }
