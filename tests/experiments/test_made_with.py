"""What a run says of what it was made with."""

from dataclasses import asdict

import numpy as np
import pytest

import ratd
from ratd.base.materials import get_material
from ratd.experiments.made_with import constants_of, made_with
from ratd.experiments.spin_up.run_files import run_row
from ratd.laws.jkr_with_springs import jkr

GLASS = ratd.Material("glass", 0.1, 7e10, 0.2, 2500.0, 0.3e-9, 4e-12)
PAIR = np.array([[0.0, 0.0, 0.0], [1.9985e-7, 0.0, 0.0]])


def test_constants_are_those_of_the_material():
    assert constants_of(GLASS) == {
        "material": "glass",
        "surface_energy": 0.1,
        "youngs_modulus": 7e10,
        "poisson_number": 0.2,
        "density": 2500.0,
        "critical_rolling_displacement": 0.3e-9,
        "viscous_time": 4e-12,
    }


def test_of_several_materials_the_names_are_told():
    about = made_with(jkr(), [GLASS, get_material("q-S")])
    assert about == {"source": f"ratd {ratd.__version__}", "law": repr(jkr()), "material": "glass, q-S"}


def pair(material=GLASS):
    return ratd.Grain(PAIR, [1e-7, 1e-7], material)


RUNS = {
    "spin_up": lambda law: ratd.spin_up(pair(), law=law, max_steps=5),
    "evolve": lambda law: ratd.evolve(PAIR, [1e-7, 1e-7], material=GLASS, law=law, duration=1e-12, records=1),
    "compress": lambda law: ratd.compress(ratd.grow_bcca(16, GLASS, radius=1e-7), 1e-4, 0.08, law=law, balance=False),
}


@pytest.mark.parametrize("name", RUNS)
def test_every_run_names_its_law_and_its_material(name):
    law = jkr(sliding_limit=0.9)
    run = RUNS[name](law)
    assert run.attrs["law"] == repr(law) != repr(jkr())
    told = {"material": "glass", **asdict(GLASS)}
    del told["name"]
    assert {key: run.attrs[key] for key in told} == told
    assert run.attrs["source"] == f"ratd {ratd.__version__}"


def test_a_row_of_a_file_leaves_to_the_file_what_it_says_once():
    row = run_row(RUNS["spin_up"](None))
    assert row.attrs["material"] == "glass" and row.attrs["law"] == repr(jkr()) and "density" not in row.attrs
