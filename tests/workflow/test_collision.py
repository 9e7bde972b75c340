"""The collisions through Snakemake: what is planned, what is refused, and one cell from the clusters to its file."""

import numpy as np
import pytest
import yaml

from ratd.experiments.collision.document_plan import SAMPLES
from ratd.experiments.collision.plan import load
from ratd.experiments.collision.run import at_rest
from ratd.experiments.collision.stages import built, collided
from ratd.pipeline import blocks, io
from ratd.pipeline.partial import partial_folder
from tiny_pipeline import ROOT, Pipeline

CELL = "results/tiny/collision/runs/velocity/pair/sample_1/20mps_b0.nc"
OWN = {
    "cluster_radius_um": 1.6,
    "filling_factor": 0.2,
    "clusters": {"pair": {"radii": "equal", "radius_nm": 400, "second_contact": 0.5}},
    "runs": [
        {
            "laws": ["velocity"],
            "clusters": ["pair"],
            "samples": 1,
            "velocities": [20],
            "rotations": {"first": 3, "number": 2},
            "impact_parameter": 0,
            "timestep_ps": None,
            "duration_us": 0.1,
        }
    ],
    "records": 4,
    "snapshots": {
        "every": 2,
        "runs": [{"law": "velocity", "cluster": "pair", "sample": 1, "velocity": 20, "rotation": 4}],
    },
    "figures": {"law": "velocity", "mrn": "pair", "twin": "pair"},
}


def pipeline(folder, collision):
    made = Pipeline(folder)
    config = {"results": "results/tiny", "collision": collision}
    (folder / "tiny.yaml").write_text(yaml.safe_dump(config))
    return made


def test_the_paper_is_planned_and_only_when_it_is_asked_for(tmp_path):
    made = pipeline(tmp_path, {})
    planned = made.planned("collision")
    assert planned["collide"] == 70 and planned["build_clusters"] == planned["relax_clusters"] == 7
    assert planned["collision_tables"] == planned["collision_figure6"] == planned["collision_page"] == 1
    assert "collide" not in made.planned()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"records": 0}, "collision.records is 0; allowed: a whole number of 2 or more"),
        ({"material": "cheese"}, "collision.material is 'cheese'; allowed: "),
    ],
)
def test_a_wrong_config_ends_with_one_sentence(tmp_path, change, said):
    done = pipeline(tmp_path, change).run("collision")
    assert done.returncode != 0 and not (tmp_path / "results").exists()
    assert [line for line in done.stdout.splitlines() if line][-1].startswith(f"config: {said}")


def test_pieces_of_finished_files_go_from_the_folder_of_the_document_too(tmp_path):
    made = pipeline(tmp_path, OWN)
    pieces = partial_folder(tmp_path / SAMPLES)
    pieces.mkdir(parents=True)
    for path in (tmp_path / SAMPLES, pieces / "lock"):
        path.write_text("")
    done = made.run("results/tiny/config.yaml")
    assert done.returncode == 0 and not pieces.exists(), done.stdout


def test_one_cell_through_the_pipeline(tmp_path):
    made = pipeline(tmp_path, OWN)
    assert made.planned(CELL) == {"build_clusters": 1, "relax_clusters": 1, "collide": 1}
    done = made.run(CELL)
    assert done.returncode == 0, done.stdout
    found = blocks.rows(io.read(tmp_path / CELL, "collisions"), "collisions")
    assert [row["seed"].item() for row in found] == [3, 4]
    assert [row.sizes.get("snapshot", 0) for row in found] == [0, 3]

    files = (ROOT / "config" / "config.yaml", ROOT / "config" / "collision.yaml", tmp_path / "tiny.yaml")
    plan = load(*files, schemas=ROOT / "config" / "schema")
    (cell,) = plan.cells
    cluster = at_rest(built(plan.cluster(plan.material_of("velocity"), "pair"), 1))
    row = collided(cluster, plan.settings_of(cell), 3)
    for name in ("X", "N_s", "n_pieces", "steps", "time", "kinetic_translation", "mass_1"):
        np.testing.assert_array_equal(found[0][name], row[name])
    assert found[0]["balance"].item() < 0.01
