"""A drive of one's own, as docs/model/drives.md shows it."""

import re

import numpy as np
import pytest

import ratd
from ratd.base.errors import InputError
from tiny_pipeline import ROOT

EXAMPLE = re.findall(
    r"```python\n(.*?)```", (ROOT / "docs" / "model" / "drives.md").read_text(encoding="utf-8"), re.DOTALL
)


@pytest.fixture(scope="module")
def names():
    (code,) = EXAMPLE
    found = {}
    exec(code, found)
    return found


def test_a_cluster_falls_as_a_whole(names):
    run, grain, g = names["run"], names["grain"], 9.81e7
    mass, time = grain.mass.sum(), run.time.values
    # the kick of the weight over the last half of a step is still to come in each record
    kicks = mass * g * run.attrs["timestep"]
    np.testing.assert_allclose(run.momentum.sel(axis="z")[1:], -mass * g * time[1:] + 0.5 * kicks, atol=1e-3 * kicks)
    assert abs(run.momentum.sel(axis="x")).max() < 1e-9 * mass * g * time[-1]
    assert (run.n_contacts == grain.n_contacts).all()
    fallen = (run.position.values - grain.position)[:, 2]
    np.testing.assert_allclose(fallen, -0.5 * g * time[-1] ** 2, rtol=1e-2)
    # what the balance of energy lacks is the work of the weight
    assert run.residual.values[-1] == pytest.approx(0.5 * mass * (g * time[-1]) ** 2, rel=1e-2)


def test_what_is_no_drive_is_refused(names):
    weight = names["Weight"]
    spheres = dict(position=np.zeros((1, 3)), radius=[1e-8], duration=1e-9, timestep=1e-12)
    with pytest.raises(InputError, match="drive is 'free', without turning"):
        ratd.evolve(**spheres, drive="free")
    with pytest.raises(InputError, match=r"drive is the class Weight; it must be one of its objects, Weight\(...\)"):
        ratd.evolve(**spheres, drive=weight)
    for other in (dict(drag=1e9), dict(box=ratd.periodic(1e-6))):
        with pytest.raises(InputError, match="drive is for open space without a drag"):
            ratd.evolve(**spheres, drive=weight(1.0), **other)
