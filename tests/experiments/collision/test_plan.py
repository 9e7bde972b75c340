"""The plan of the collisions: cells, rotations, files, settings, and what is refused."""

import copy
import itertools

import numpy as np
import pandas as pd
import pytest
import yaml

from ratd.aggregates.mrn import mrn
from ratd.base.errors import InputError
from ratd.experiments.collision.figures.dissipation import dissipation
from ratd.experiments.collision.figures.figure2 import figure2
from ratd.experiments.collision.figures.figure5 import figure5
from ratd.experiments.collision.figures.figure6 import figure6
from ratd.experiments.collision.figures.figure8 import figure8
from ratd.experiments.collision.plan import RUNS, check
from ratd.experiments.collision.stages import law_from, radii_from
from ratd.pipeline.config import merge
from tiny_pipeline import ROOT

FILES = [ROOT / "config" / f"{name}.yaml" for name in ("config", "collision")]
SCHEMAS = ROOT / "config" / "schema"
QUANTITIES = ("X", "N_s", "energy_half", "energy_end", "by_damping", "by_sliding", "by_rolling", "by_twisting")


def config(**own):
    merged = {}
    for path in FILES:
        merged = merge(merged, yaml.safe_load(path.read_text()))
    merged["materials_file"] = str(ROOT / "config" / "materials.yaml")
    merged["collision"] = merge(merged["collision"], own)
    return merged


def entry(**own):
    base = {
        "laws": ["velocity"],
        "clusters": ["570nm"],
        "samples": 1,
        "velocities": [15, 30],
        "rotations": {"first": 0, "number": 2},
        "impact_parameter": 0,
        "timestep_ps": 20,
        "duration_us": 3,
    }
    return base | own


NO_PICTURES = {"every": 1, "runs": []}
PICTURE = {"law": "velocity", "cluster": "mrn", "sample": 1, "velocity": 15, "rotation": 0}


def plan(*entries, **own):
    return check(config(runs=list(entries), snapshots=NO_PICTURES, **own), SCHEMAS)


def test_figures_without_their_clusters_are_left_out_and_said():
    own = plan(entry())
    assert own.figures == ["scaling"] and not any("mrn" in path for path in own.clusters_files())
    (note,) = own.notes
    assert "left out is collision.figures.figure1, figure2, figure5" in note and "'mrn'" in note
    assert check(config(), SCHEMAS).notes == []
    with pytest.raises(InputError, match="cluster_radius_um is 4e-06; allowed: a number from 0.001 to 1000"):
        plan(entry(), cluster_radius_um=4e-6)


def test_the_law_of_figure_1_has_the_ends_of_its_cluster():
    assert check(config(), SCHEMAS).figure("figure1")["ends"] == pytest.approx([50e-9, 2.5e-6])


def test_the_paper():
    """Seven kinds of clusters, ten velocities, ten rotations, 3 us; MRN at 1 ps."""
    paper = check(config(), SCHEMAS)
    assert len(paper.cells) == 70 and len(list(paper.queue())) == 700
    assert {cell.duration for cell in paper.cells} == {3e-6}
    assert {cell.timestep for cell in paper.cells if cell.cluster == "mrn"} == {1e-12}
    assert len(paper.figures) == 11 and len(set(paper.run_files())) == 70
    assert paper.figure_input("figure3")["runs"] == [
        RUNS.format(law="velocity", cluster="mrn", sample=1, velocity=15, impact=0)
    ]


def table_of(paper):
    """A table with a collision for each cell and two rotations, as if all that is planned had been computed."""
    rows = []
    for cell, seed in itertools.product(paper.cells, (0, 1)):
        radius = 1e-9 * paper.config["clusters"][cell.cluster].get("radius_nm", 0)
        own = {"largest_radius": radius or 2e-6, "mean_sphere_radius": radius or 9e-8, "seed": seed}
        own |= {name: getattr(cell, name) for name in ("law", "cluster", "sample", "velocity", "impact_parameter")}
        rows.append({"second_contact": 0.5, "largest_share": 0.1} | dict.fromkeys(QUANTITIES, 0.4 + 0.1 * seed) | own)
    return pd.DataFrame(rows)


def test_the_figures_of_all_that_the_paper_plans_draw():
    """It has more velocities than there are markers, and a user may have more samples."""
    paper = check(config(), SCHEMAS)
    table = table_of(paper)
    own = paper.config["figures"]
    many = [table.assign(sample=k) for k in range(12)]
    for figure in (
        figure5(table, own["law"]),
        figure6(pd.concat(many), own["law"], own["mrn"]),
        figure8(table, own["law"], own["mrn"]),
        dissipation(table, own["law"], [own["twin"], own["mrn"]]),
    ):
        figure.canvas.draw()
        assert all(axes.has_data() for axes in figure.axes)


def test_figures_of_the_law_have_its_ends():
    ends = {"smallest_nm": 100, "largest_nm": 800}
    other = check(config(clusters={"mrn": ends}), SCHEMAS)
    samples = [mrn(2000, seed, smallest=1e-7, largest=8e-7) for seed in (1, 2)]
    assert other.figure("figure2")["ends"] == pytest.approx([1e-7, 8e-7])
    (law,) = [line for line in figure2(samples, 1e-7, 8e-7).axes[0].lines if line.get_label() == "law"]
    # L_5 is the geometric mean of the ends
    assert np.interp(5.0, *law.get_data()) == pytest.approx(1e6 * np.sqrt(8e-14), rel=1e-3)


@pytest.mark.parametrize("name", ["quick", "collision_default", "collision_study"])
def test_the_other_configs(name):
    merged = merge(config(), yaml.safe_load((ROOT / "config" / f"{name}.yaml").read_text()))
    other = check(merged, SCHEMAS)
    assert other.cells and all(other.settings_of(cell)["records"] >= 2 for cell in other.cells)
    for law, cluster in other.pairs():
        law_from(other.law(law))
        if other.config["clusters"][cluster]["radii"] == "equal":
            assert len(radii_from(other.cluster(other.material_of(law), cluster), 1)) > 50


def test_rotations_of_several_entries_add_up_in_the_order_of_the_queue():
    two = plan(entry(), entry(velocities=[30, 45], rotations={"first": 1, "number": 3}))
    assert [(cell.velocity, cell.rotations) for cell in two.cells] == [
        (15, (0, 1)),
        (30, (0, 1, 2, 3)),
        (45, (1, 2, 3)),
    ]
    queue = [(cell.velocity, rotation) for cell, rotation in two.queue()]
    assert queue == [(15, 0), (30, 0), (15, 1), (30, 1), (45, 1), (30, 2), (45, 2), (30, 3), (45, 3)]
    assert two.collide(two.cells[1].names)["rotations"] == [0, 1, 2, 3]


def test_materials_and_laws():
    laws = {"strong": {"law": "dmt", "viscous_time_ns": 1.5, "friction": "spring", "surface_energy_mJ_m2": 50}}
    own = plan(entry(laws=["strong"]), laws=laws)
    assert own.material_of("strong").surface_energy == pytest.approx(0.05)
    assert own.material_of("strong").name == "silica_50mJ" and own.material_of("velocity").name == "silica"
    assert law_from(own.law("strong")).viscous_time == pytest.approx(1.5e-9)
    assert own.build("silica_50mJ", "570nm")["material"]["surface_energy"] == pytest.approx(0.05)


def test_a_giant_among_equal_spheres_takes_its_volume_from_the_others():
    clusters = {"giant": {"radii": "equal", "radius_nm": 314, "giant_nm": 1800, "second_contact": 0}}
    own = plan(entry(clusters=["giant"]), clusters=clusters)
    settings = own.cluster(own.material_of("velocity"), "giant")
    radii = radii_from(settings, 1)
    assert radii[0] == pytest.approx(1.8e-6) and len(radii) == 1 + 425
    assert (radii**3).sum() == pytest.approx(settings["total_cube"], rel=2e-3)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"runs": [entry(laws=["hard"])]}, r"collision.runs\[0\].laws has 'hard'; allowed: velocity"),
        ({"runs": [entry(clusters=["100nm"])]}, r"collision.runs\[0\].clusters has '100nm'; allowed: mrn"),
        ({"runs": [entry(velocities=[0])]}, r"collision.runs\[0\].velocities\[0\] is 0; allowed: a number above 0"),
        ({"runs": [entry(velocities=[-3])]}, "is -3; allowed"),
        ({"runs": [entry(impact_parameter=1)]}, "impact_parameter is 1; allowed: a number from 0 to below 1"),
        ({"runs": [entry(), entry(timestep_ps=10)]}, r"runs\[1\] has 570nm at 15 m/s, .* another timestep_ps"),
        ({"laws": {"x": {"law": "hertz"}}}, "laws.x.law is 'hertz'; allowed: dmt or jkr"),
        ({"laws": {"velocity": {"law": "dmt", "damping": "none"}}}, "the key 'damping' in .*laws.velocity is unknown"),
        ({"laws": {"x": {"law": "dmt", "material": "cheese"}}}, "laws.x.material is 'cheese'; allowed: a-C"),
        ({"material": "cheese"}, "collision.material is 'cheese'"),
        ({"clusters": {"new": {"radii": "equal", "second_contact": 0}}}, "clusters.new.radius_nm is missing"),
        ({"clusters": {"new": {"radii": "equal", "second_contact": 2, "radius_nm": 5}}}, "second_contact is 2"),
        ({"figures": {"mrn": "none"}}, "figures.mrn is 'none'; allowed: mrn"),
        (
            {"snapshots": {"runs": [PICTURE | {"sample": 9}]}},
            "snapshots.runs has .* allowed: a collision of `runs`",
        ),
        ({"extra": 1}, "the key 'extra' in collision is unknown"),
    ],
)
def test_a_wrong_config_is_refused_in_one_sentence(change, words):
    base = {"runs": [entry()], "snapshots": NO_PICTURES}
    with pytest.raises(InputError, match=words) as caught:
        check(copy.deepcopy(config(**base | change)), SCHEMAS)
    assert "\n" not in str(caught.value) and str(caught.value).startswith("config: ")


def test_the_default_set_is_a_part_of_the_study():
    """Each of its collisions stands behind the document, with the same settings."""
    default, study = (
        check(merge(config(), yaml.safe_load((ROOT / "config" / f"collision_{name}.yaml").read_text())), SCHEMAS)
        for name in ("default", "study")
    )

    def asked(plan):
        for cell, rotation in plan.queue():
            cluster = plan.cluster(plan.material_of(cell.law), cell.cluster)
            settings = plan.settings_of(cell) | {"rotations": rotation, "snapshots": {}}
            yield repr((cell.law, cell.cluster, cell.sample, sorted(cluster.items()), settings))

    wanted, there = set(asked(default)), set(asked(study))
    assert len(wanted) == 184 and wanted <= there
