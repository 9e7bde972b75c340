"""The configs of the compression: what they plan and what they refuse."""

import pytest

import ratd
from ratd.experiments.compression import document
from ratd.experiments.compression import plan as plans
from ratd.experiments.compression.run import Cluster
from ratd.experiments.compression.squeeze import squeezed
from ratd.pipeline.config import load, merge

PAPER = ("config/config.yaml", "config/spin_up.yaml", "config/compression.yaml")


def plan_of(*over, **compression):
    return plans.check(merge(load(*PAPER, *over), {"compression": compression}))


@pytest.mark.parametrize("name", ["quick", "compression_default"])
def test_configs_that_come_with_ratd_are_good(name):
    plan = plan_of(f"config/{name}.yaml")
    assert plan.results == f"results/{name}"
    for wanted in plan.sets:
        assert plan.grow(wanted)["n"] <= 16384 and plan.compress(wanted)["strain_rate"] >= 1e-7
        assert len(plan.files(plans.RUN, wanted)) == len(plan.seeds(wanted)) >= 2


def test_the_large_config_adds_to_the_default_one():
    default = plan_of("config/compression_default.yaml")
    large = plan_of("config/compression_default.yaml", "config/compression_large.yaml")
    assert large.results == default.results and set(default.sets) < set(large.sets)
    assert set(default.files(plans.RUN, "n_16384")) < set(large.files(plans.RUN, "n_16384"))
    assert set(default.tables) < set(large.tables)
    for name in set(large.sets) - set(default.sets):
        assert large.grow(name)["n"] >= 16384


def test_the_config_of_steps_adds_other_steps_to_the_default_one():
    default = plan_of("config/compression_default.yaml")
    steps = plan_of("config/compression_default.yaml", "config/compression_steps.yaml")
    assert steps.results == default.results and set(default.sets) < set(steps.sets)
    assert set(default.tables) < set(steps.tables) and "fewer_steps" in steps.figures
    for name in set(steps.sets) - set(default.sets):
        assert steps.grow(name)["n"] == 1024


def test_the_document_is_drawn_by_all_configs_that_its_tables_are_made_with():
    names = [f"config/compression_{name}.yaml" for name in ("default", "steps", "large")]
    assert document.CONFIGS[-3:] == tuple(names)
    assert set(plan_of(*names).figures) == set(plans.FIGURES)


def test_the_paper_is_as_printed():
    plan = plan_of()
    assert set(plan.figures) == set(plans.FIGURES)
    assert plan.of_set("base")["strain_rate"] == 3e-7 and plan.seeds("base") == list(range(10))
    assert plan.compress("k_n_10")["k_n"] == 10
    assert plan.grow("xi_2")["material"]["critical_rolling_displacement"] == pytest.approx(2e-10)
    mrn = {"law": "mrn", "smallest": pytest.approx(5e-8), "largest": pytest.approx(4e-7)}
    assert plan.grow("mrn")["radii"] == mrn
    assert plan.stretch("x")["pull"] == {"strain_rate": 3e-7, "axes": "x", "unload": False}


def test_only_the_sets_that_are_named_are_wanted():
    figures = dict.fromkeys(plans.FIGURES) | {"figure5": {"sets": ["rate_1e-5", "base"]}}
    plan = plan_of(figures=figures, further_sets=[])
    assert plan.sets == ["rate_1e-5", "base"] and plan.figures == ["figure5"]
    further = plan_of(figures=figures, further_sets=["silicate"])
    assert further.sets == [*plan.sets, "silicate"]
    assert set(further.tables) - set(plan.tables) == {plans.TABLE.format(set="silicate")}
    assert plan.tables == ["<results>/compression/rate_1e-5.nc", "<results>/compression/base.nc"]
    # clusters that are pulled need no compression of their own
    figures = dict.fromkeys(plans.FIGURES) | {"tension": {"pulls": ["x"]}}
    assert all("/tension/" in path for path in plan_of(figures=figures, further_sets=[]).tables)


def test_the_steps_go_from_the_config_to_the_run():
    steps = {"strain": 1.8e-4, "displacement": 0.2, "calming": 0.1, "until_phi": 0.03}
    grain = ratd.grow_bcca(64, seed=0)
    said = {}
    for name, own in (("long", steps), ("explicit", None)):
        settings = plan_of(all_sets={"long_steps": own, "until_phi": 0.05, "strain_rate": 3e-5}).compress("base")
        said[name] = squeezed(grain, settings).attrs["integrator"]
    long, then = said["long"].split(", from phi = 0.03 on ")
    assert long.startswith("SemiImplicit(") and f"longest={3 * Cluster(grain).time_unit!r}" in long
    assert then == said["explicit"] and then.startswith("Leapfrog(timestep_factor=0.0708,")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"figures": {"figure4": {"sets": ["x"]}}},
            "config: compression.figures.figure4 names the set 'x'; allowed: base",
        ),
        (
            {"figures": {"figure3": {"phi": [0.05]}}},
            "config: compression.figures.figure3.phi has 0.05; allowed: the snapshots of the set base, 0.001, ",
        ),
        ({"further_sets": ["x"]}, "config: compression.further_sets names the set 'x'; allowed: base"),
        (
            {"figures": {"tension": {"pulls": ["y"]}}},
            "config: compression.figures.tension names the pull 'y'; all",
        ),
        ({"all_sets": {"n": 1000}}, "config: compression.all_sets.n is 1000; allowed: a power of 2 from 2"),
        ({"all_sets": {"strain_rate": 0}}, "compression.all_sets.strain_rate is 0; allowed: a number above 0"),
        (
            {"all_sets": {"strain_rate": 100}},
            "compression.all_sets.strain_rate is 100; allowed: a number above 0 and at",
        ),
        ({"sets": {"base": {"material": "x"}}}, "compression.sets.base.material is 'x'; allowed: a-C"),
        ({"sets": {"base": {"material": "q-S"}}}, "compression.sets.base.radius_nm is null; allowed: a number"),
        (
            {"sets": {"base": {"radius_nm": 1e-7}}},
            "compression.sets.base.radius_nm is 1e-07; allowed: a number from 0.1",
        ),
        ({"sets": {"snapshots": {}}}, "compression.sets has 'snapshots'; allowed: another name"),
        ({"sets": {"..": {}}}, "letters, digits and _ . -"),
        ({"figures": {"figure3": {"phi": []}}}, "figure3.phi is []; allowed: a list of filling factors between 0 and"),
        ({"sets": {"base": {"until_phi": 0.9}}}, "until_phi is 0.9; allowed: a filling factor between 0 and 0.64"),
        (
            {"sets": {"base": {"radii": {"law": "lognormal", "smallest_nm": 25, "largest_nm": 300}}}},
            "the key compression.sets.base.radii.median_nm is missing; allowed: a mapping with the keys law, median_nm",
        ),
        (
            {"sets": {"base": {"radii": {"law": "mrn", "median_nm": 50, "smallest_nm": 25, "largest_nm": 300}}}},
            "the key 'median_nm' in compression.sets.base.radii is unknown",
        ),
        ({"sets": {"base": {"speed": 1}}}, "the key 'speed' in compression.sets.base is unknown"),
    ],
)
def test_a_wrong_config_is_one_sentence(change, said):
    with pytest.raises(ratd.InputError) as error:
        plan_of(**change)
    assert said in str(error.value)
