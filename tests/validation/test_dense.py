"""Dense clusters beside LAMMPS, and the pair of spheres that shows what its twisting does."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import ratd
from peer import need_lammps
from ratd.aggregates.clusters import grow_bcca
from ratd.experiments.compression.beside_lammps import of_dense
from ratd.experiments.compression.run import Cluster
from ratd.laws.contact_constants import equilibrium_compression, equilibrium_contact_radius, reduced_radius
from ratd.laws.jkr_as_in_lammps import jkr_as_in_lammps
from ratd.laws.jkr_with_springs import jkr
from ratd.laws.tangential import TWISTING_LIMIT, twisting_stiffness
from ratd.pipeline import io
from ratd.validation import dense
from ratd.validation.lammps_box import BoxInLammps
from ratd.validation.tables import as_dataset

SMALL = {
    "material": "ice", "n": 64, "seed": 1, "strain_rate": 2e-5, "from_phi": 0.08, "until_phi": 0.115,
    "timestep_factor": 0.14, "lammps_step": 0.1,
}  # fmt: skip


@pytest.fixture(scope="module")
def rows():
    need_lammps()
    said = []
    found = dense.compute(SMALL, said.append)
    assert [line.split(":")[0] for line in said] == list(dict.fromkeys(row["code"] for row in found))
    return found


def test_both_codes_agree_where_they_have_the_same_law(rows):
    table = pd.DataFrame(rows).pivot_table(index="phi", columns="code", values="pressure")
    alike = table["LAMMPS"] / table["ratd with the limits of LAMMPS"]
    assert alike.to_numpy() == pytest.approx(1.0, abs=0.05)
    contacts = pd.DataFrame(rows).pivot_table(index="phi", columns="code", values="n_contacts")
    without = contacts["LAMMPS without twisting"] / contacts["ratd without twisting"]
    assert without.to_numpy() == pytest.approx(1.0, abs=0.02)


def test_rows_make_a_file_of_the_check(rows, tmp_path):
    io.write(tmp_path / "a.nc", as_dataset(rows, dense.KIND), dense.KIND)
    assert io.read(tmp_path / "a.nc", dense.KIND).sizes["case"] == len(rows)


def test_lammps_turns_a_twisting_torque_round_where_its_limit_falls():
    """A pair that vibrates and is twisted past its limit. If this fails, LAMMPS is mended, and the text is old."""
    need_lammps()
    pair = grow_bcca(2, "ice", 0)
    ice = replace(pair.material, viscous_time=0.0)
    pair = ratd.Grain(pair.position, pair.radius, ice)
    time_unit, radius, mass = Cluster(pair).time_unit, pair.radius[0], pair.mass[0]
    r = reduced_radius(radius, radius)
    stiffness = twisting_stiffness(
        equilibrium_contact_radius(r, ice.surface_energy, ice.reduced_modulus), 0.5 * ice.shear_modulus
    )
    line = np.subtract(*pair.position) / np.linalg.norm(np.subtract(*pair.position))
    first = 1.5 * TWISTING_LIMIT * np.sqrt(2.0 * stiffness / (0.4 * mass * radius**2))
    spin = np.outer([first, -first], line)
    length = equilibrium_compression(r, ice.surface_energy, ice.reduced_modulus)
    velocity = np.outer([1.0, -1.0], 0.1 * length / time_unit * line)
    step, every, records = 0.1 * time_unit, 400, 12

    def in_ratd(law):
        how = {"law": law, "timestep": step, "records": 1, "balance": None}
        durations = every * step * np.arange(1, records + 1)
        runs = [ratd.evolve(pair.position, pair.radius, velocity, spin, ice, duration=t, **how) for t in durations]
        return [run["spin"].values[0] @ line / first for run in runs]

    theirs = []
    with BoxInLammps(pair, 20.0 * radius, 0.0, step, 20.0 * radius) as box:
        number = box._atoms("id").copy()
        for k in range(2):
            box._atoms("omega")[k] = spin[number[k] - 1]
            box._atoms("v")[k] = velocity[number[k] - 1]
        for _ in range(records):
            box.advance(every)
            theirs.append(box._atoms("omega")[np.argmin(box._atoms("id"))] @ line / first)
    assert in_ratd(jkr_as_in_lammps(damping="none")) == pytest.approx(theirs, abs=0.015)
    for law in (jkr_as_in_lammps(damping="none", sign_of_rate=False), jkr(damping="none")):
        assert np.abs(np.subtract(in_ratd(law), theirs)).max() > 0.3


def test_ratios_are_those_of_the_pairs_of_codes():
    pressures = {"ratd": 2.0, "LAMMPS": 1.0, "ratd without twisting": 0.5, "LAMMPS without twisting": 0.5}
    pressures["ratd with the limits of LAMMPS"] = 1.0
    cases = [
        dict(
            code=code, seed=seed, phi=phi, pressure=factor * phi**3, line=phi**3, n_contacts=60 + seed,
            kinetic=1.0 / factor, n_monomers=64, strain_rate=1e-5, twisting=phi * factor,
        )
        for code, factor in pressures.items()
        for seed in (0, 1)
        for phi in (0.07, 0.12, 0.18)
    ]  # fmt: skip
    found = of_dense(pd.DataFrame(cases))
    assert found["dense.pressure_plain_0.1"].value == pytest.approx(0.5)
    assert found["dense.kinetic_plain_0.1"].value == pytest.approx(2.0)
    assert found["dense.pressure_untwisted_0.05"].value == pytest.approx(1.0)
    assert found["dense.pressure_limits_0.15"].value == pytest.approx(1.0)
    assert found["dense.n_contacts_limits_0.15"].value == pytest.approx(1.0)
    assert found["dense.twisting"].value == pytest.approx(0.36)
    assert found["dense.twisting_limits"].value == pytest.approx(0.18)
    for low in (0.05, 0.1, 0.15):
        assert found[f"dense.twisting_matters_{low:g}"].value == pytest.approx(4.0)
        assert found[f"dense.line_{low:g}"].value == pytest.approx(2.0)
        assert found[f"dense.line_untwisted_{low:g}"].value == pytest.approx(0.5)
    assert found["dense.n"] == 2 and found["dense.N"] == 64
