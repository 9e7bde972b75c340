"""The queue of static limits: what a row holds, and what is told of the tables."""

import numpy as np
import pandas as pd
import pytest

import ratd
from ratd.base.units import NM
from ratd.experiments.spin_up.findings.static_limit import of_static_limits
from ratd.experiments.spin_up.firm_bound import firm_bound
from ratd.experiments.spin_up.plan import load
from ratd.experiments.spin_up.static_limit import read_limits, static_limit
from ratd.pipeline.queue import work
from ratd.validation import static_limits
from tiny_pipeline import ROOT

PLAN = [ROOT / path for path in static_limits.CONFIG]


def test_rows_are_the_limits_of_the_grains_of_the_ensemble(tmp_path):
    wanted = static_limits.tasks(load(*PLAN), tmp_path)
    assert len(wanted) == 3 * len(static_limits.SIZES_NM) * len(static_limits.SEEDS)
    assert work(wanted[:3], say=lambda text: None) == 0
    table = read_limits(tmp_path)
    assert list(table["type"]) == ["BA", "BAM1", "BAM2"]
    for row in table.itertuples():
        grain = ratd.grow(row.type, row.a_eff, row.material, row.seed)
        assert row.static_limit == static_limit(grain) and row.firm_bound == firm_bound(grain)
        assert (row.n_monomers, row.n_contacts) == (grain.n_monomers, grain.n_contacts)


def test_an_empty_folder_is_one_sentence(tmp_path):
    with pytest.raises(ratd.InputError, match="holds no grains"):
        read_limits(tmp_path)


def test_driven_grains_stand_over_their_static_limit():
    grains = [
        {"material": "q-S", "type": kind, "a_eff": size * NM, "nm": float(size), "seed": seed}
        for kind in ("BA", "BAM1", "BAM2")
        for size in (100, 300, 600)
        for seed in range(3)
    ]
    limits = pd.DataFrame(grains).assign(firm_bound=4e8, static_limit=lambda own: 1e8 * (own["nm"] / 300) ** -1.5)
    driven = limits[["material", "type", "a_eff", "nm", "seed"]].assign(
        printed=1e9,
        omega_first_loss=limits["static_limit"] * np.tile([0.8, 0.9, 1.0], 9),
        omega_mass_75=np.where(limits["seed"] == 0, np.nan, limits["static_limit"]),
    )
    # at 600 nm a half to the power of 1.5 of what it is at 300 nm
    found = of_static_limits(limits.sample(frac=1.0, random_state=0), driven)
    assert found["static.grains"] == 27
    mean = (0.8 * 0.9 * 1.0) ** (1 / 3)
    for kind in ("BA", "BAM1", "BAM2"):
        assert found[f"static.{kind} large first"].value == pytest.approx(mean)
        assert found[f"static.{kind} large quarter"].value == pytest.approx(1.0)
        assert found[f"static.{kind} large over firm"].value == pytest.approx(0.25 * 2**-0.75)
        assert found[f"static.{kind} large printed"].value == pytest.approx(10.0 * 2**0.75)
        ends = [found[f"static.{kind} large first {end}"] for end in ("least", "most")]
        assert ends == pytest.approx([0.8, 1.0])
        for word in ("", " first"):
            assert found[f"static.{kind} power{word}"].value == pytest.approx(-1.5)
    with pytest.raises(ratd.InputError, match="9 grains with a static limit were not spun up"):
        of_static_limits(limits, driven[driven["type"] != "BA"])
