"""The queue: it goes on where it was and keeps what is there; the tables and figures that follow from it."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from ratd.aggregates.particles import read_particles
from ratd.aggregates.write_particles import write_particles
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.collision import study
from ratd.experiments.collision.figures.dissipation import dissipation
from ratd.experiments.collision.figures.figure5 import figure5
from ratd.experiments.collision.figures.figure6 import figure6
from ratd.experiments.collision.figures.figure7 import figure7, groups_of
from ratd.experiments.collision.figures.figure8 import figure8
from ratd.experiments.collision.figures.look import colour_of_velocity, looks_of
from ratd.experiments.collision.figures.masses import masses, rows_by_cluster
from ratd.experiments.collision.figures.page import page
from ratd.experiments.collision.figures.scaling import scaling
from ratd.experiments.collision.figures.snapshots import colours_of, origin_of, picture, positions, row_of
from ratd.experiments.collision.files import read_runs
from ratd.experiments.collision.fragmentation import fragmentation
from ratd.experiments.collision.plan import Plan
from ratd.experiments.collision.tables import (
    COLUMNS,
    THRESHOLDS,
    cluster_table,
    collision_table,
    materials_of_laws,
    mean_energy,
    read_collisions,
    threshold_table,
)
from ratd.pipeline import blocks, io, queue
from ratd.pipeline.kinds import as_dataset

SILICA = MATERIALS["silica"]


def plan(folder, **own):
    """Two clusters of few spheres under one law, two velocities, two rotations, with snapshots of one."""
    entry = {
        "laws": ["velocity"],
        "clusters": ["equal", "unequal"],
        "samples": 1,
        "velocities": [2.0, 25.0],
        "rotations": {"first": 0, "number": 2},
        "impact_parameter": 0,
        "timestep_ps": None,
        "duration_us": 0.6,
    }
    one = {"law": "velocity", "cluster": "unequal", "sample": 1, "velocity": 25.0, "rotation": 0}
    config = {
        "material": "silica",
        "cluster_radius_um": 1.6,
        "filling_factor": 0.2,
        "clusters": {
            "equal": {"radii": "equal", "radius_nm": 400, "second_contact": 0.5},
            "unequal": {"radii": "equal", "radius_nm": 300, "giant_nm": 700, "second_contact": 0.5},
        },
        "laws": {"velocity": {"law": "dmt", "viscous_time_ns": 0.5, "friction": "velocity"}},
        "runs": [entry],
        "records": 12,
        "snapshots": {"every": 6, "runs": [one]},
        "bootstrap": 20,
        "figures": {"law": "velocity", "mrn": "unequal", "twin": "equal"},
    }
    return Plan(config | own, MATERIALS, str(folder / "results"))


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A queue that is stopped in its middle and goes on."""
    folder = tmp_path_factory.mktemp("study")
    said = []

    def stop(text):
        said.append(text)
        if len(said) == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        queue.work(study.tasks(plan(folder), folder / "data"), say=stop)
    assert queue.work(study.tasks(plan(folder), folder / "data"), until=0.0, say=said.append) == 6
    assert queue.work(study.tasks(plan(folder), folder / "data"), say=said.append) == 0
    assert queue.work(study.tasks(plan(folder), folder / "data"), say=said.append) == 0
    assert len(said) == 9 and said[1].startswith("velocity equal sample 1 2 m/s rotation 0: X ")
    return folder


def files(done):
    return sorted((done / "data" / "velocity").glob("*.nc"))


def test_tables_hold_each_collision_once_in_order(done):
    rows = [(row["cluster"].item(), row["velocity"].item(), row["seed"].item()) for row in all_rows(done)]
    assert rows == [(name, v, seed) for name in ("equal", "unequal") for v in (2.0, 25.0) for seed in (0, 1)]
    assert queue.state(study.tasks(plan(done), done / "data"), "collisions").splitlines() == [
        f"{done}/data/{study.PICTURES[0]}: 1 of 1 collisions",
        *(f"{done}/data/velocity/{cluster}.nc: 4 of 4 collisions" for cluster in ("equal", "unequal")),
    ]
    assert len({row["source"].item() for row in all_rows(done)}) == 1


def all_rows(done):
    return [row for path in files(done) for row in blocks.rows(io.read(path, "collisions"), "collisions")]


def test_an_undisturbed_queue_gives_the_same_bytes(done, tmp_path):
    queue.work(study.tasks(plan(tmp_path), tmp_path / "data"), say=lambda text: None, processes=2)
    for path in files(done):
        assert (tmp_path / path.relative_to(done)).read_bytes() == path.read_bytes()


def test_a_collision_goes_on_from_its_checkpoint_when_its_cell_gets_more_rotations(tmp_path, monkeypatch):
    def caught(*_, checkpoint, **__):
        raise RuntimeError(checkpoint.name)

    def names(plan):
        return [str(pytest.raises(RuntimeError, task.make).value) for task in study.tasks(plan, tmp_path / "data")]

    monkeypatch.setattr(study, "_at_rest", lambda *_: None)
    monkeypatch.setattr(study, "collided", caught)
    one = plan(tmp_path)
    (entry,) = one.config["runs"]
    (shown,) = one.config["snapshots"]["runs"]
    more = plan(tmp_path, runs=[entry | {"rotations": {"first": 0, "number": 3}}],
                snapshots={"every": 6, "runs": [shown, shown | {"rotation": 2}]})  # fmt: skip
    assert len(set(names(one))) == 9 and set(names(one)) < set(names(more))


def test_other_settings_under_the_same_name_are_refused(done):
    with pytest.raises(InputError, match="equal.nc: holds rows with other settings than the config has"):
        study.tasks(plan(done, cluster_radius_um=1.7), done / "data")


def test_columns_of_the_tables(done):
    table = collision_table(read_collisions(files(done)))
    assert list(table) == list(COLUMNS) and len(table) == 8
    slow, fast = (table[table["velocity"] == v] for v in (2.0, 25.0))
    assert slow["X"].mean() > 0.8 > 0.3 > fast["X"].mean() and slow["N_s"].mean() < fast["N_s"].mean()
    spent = table[["by_damping", "by_sliding", "by_rolling", "by_twisting"]].sum(axis=1)
    # the rest is what is stored in contacts, and what the balance lacks
    assert (np.abs(1.0 - spent - table["energy_end"]) < 0.05).all() and (table["balance"] < 0.01).all()
    unequal = table[table["cluster"] == "unequal"]
    share = 0.343 / (0.343 + 20 * 0.027)
    assert unequal["largest_share"].to_numpy() == pytest.approx(share, rel=0.1)
    # whatever breaks, the largest sphere of each cluster stays whole
    assert (unequal["N_s"] <= 1.0 - unequal["largest_share"] + 1e-12).all()
    io.write(done / "table.nc", as_dataset(table), "collision_table")


def test_threshold_of_the_equal_spheres(done):
    collisions = read_collisions(files(done))
    table = collision_table(collisions)
    found = threshold_table(table, materials_of_laws(collisions), 50)
    assert list(found) == list(THRESHOLDS) and len(found) == 2
    equal = found[found["cluster"] == "equal"].iloc[0]
    assert 2.0 < equal["velocity"] < 25.0 and equal["sticking_velocity"] == pytest.approx(0.735, abs=0.01)
    mass = 4 / 3 * np.pi * 2000 * 0.4e-6**3
    # with the material of its law
    stiff = replace(SILICA, youngs_modulus=4 * SILICA.youngs_modulus, density=2 * SILICA.density)
    harder = threshold_table(table, {"velocity": stiff}, 50).query("cluster == 'equal'").iloc[0]
    assert harder["sticking_velocity"] < 0.8 * equal["sticking_velocity"]
    assert equal["energy_per_contact"] * 9.16e-18 == pytest.approx(mass * equal["velocity"] ** 2 / 4, rel=0.02)
    assert np.isnan(found[found["cluster"] == "unequal"].iloc[0]["radius"])


@pytest.mark.parametrize("name", ["figure5", "figure6", "figure7", "figure8", "dissipation", "masses", "scaling"])
def test_figures_draw(done, name):
    paths = files(done)
    collisions = read_collisions(paths)
    table = collision_table(collisions)
    names = ("velocity", ["equal", "unequal"])
    figure = {
        "figure5": lambda: figure5(table, "velocity"),
        "figure6": lambda: figure6(table, "velocity", "unequal"),
        "figure7": lambda: figure7(groups_of(paths, *names), names[0]),
        "figure8": lambda: figure8(table, "velocity", "unequal"),
        "dissipation": lambda: dissipation(table, *names),
        "masses": lambda: masses(rows_by_cluster(paths, *names), names[0]),
        "scaling": lambda: scaling(
            threshold_table(table, materials_of_laws(collisions), 20).assign(below=9.0, above=10.0)
        ),
    }[name]()
    figure.canvas.draw()
    assert all(axes.has_data() for axes in figure.axes)
    words = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert not any("no collisions" in text for text in words)


def test_the_queue_keeps_snapshots_of_what_is_shown_alone(done, tmp_path):
    assert all(row.sizes.get("snapshot", 0) == 0 for row in all_rows(done))
    with pytest.raises(InputError, match="no collision with snapshots has the rotation 0"):
        row_of(files(done), 0)
    shown = row_of([done / "data" / study.PICTURES[0]], 0)
    (same,) = [row for row in all_rows(done) if (row["cluster"], row["velocity"], row["seed"]) == ("unequal", 25.0, 0)]
    assert shown.sizes["snapshot"] == 3 and shown["X"].item() == same["X"].item()
    # a file gives them as the run itself does, and they can be written for other programs
    (again,) = read_runs(done / "data" / study.PICTURES[0])[:1]
    assert again["snapshot_position"].shape == (3, shown.sizes["monomer"], 3)
    assert (again["snapshot_piece"].values == positions(shown)[2]).all()
    write_particles(again, tmp_path / "a.xyz")
    frames = read_particles(tmp_path / "a.xyz", frame=2)
    np.testing.assert_allclose(frames.position, positions(shown)[1][2], atol=1e-15)
    with pytest.raises(InputError, match="without piece; .*read_runs gives of a file of ratd has its N_s"):
        fragmentation(again)
    # each of the two came as one piece, the giant first of its own
    origin = origin_of(positions(shown)[2])
    assert origin.tolist() == [0] * (len(origin) // 2) + [1] * (len(origin) // 2)
    # radii are told apart by colours and a scale; equal ones tell the clusters apart, without a scale
    half = len(origin) // 2
    radius, piece = shown["radius"].values, positions(shown)[2]
    assert (colours_of(radius, piece)[:half] == colours_of(radius, piece)[half:]).all()
    assert len(np.unique(colours_of(radius, piece), axis=0)) > 1 and len(picture(shown, 1e-7).axes) == 7
    equal = shown.assign(radius=("monomer", np.full_like(radius, radius.min())))
    first, second = np.split(colours_of(equal["radius"].values, piece), 2)
    assert len(np.unique(first, axis=0)) == len(np.unique(second, axis=0)) == 1 and (first[0] != second[0]).any()
    assert len(picture(equal, 1e-7).axes) == 6


def test_pictures_and_page_of_a_collision_with_snapshots(done, tmp_path):
    own = plan(done)
    (cell,) = [cell for cell in own.cells if (cell.cluster, cell.velocity) == ("unequal", 25.0)]
    settings = own.settings_of(cell)
    assert settings["snapshots"] == {"0": 6}
    cluster = study.built(own.cluster(SILICA, "unequal"), 1)
    row = study.collided(cluster, settings, 0, snapshot_every=6)
    path = tmp_path / "run.nc"
    io.write(path, blocks.block([row], "collisions", SILICA), "collisions")
    found = row_of([path], 0)
    figure = picture(found, 1e-7)
    assert len(figure.axes) == 7
    html = page({"runs": [path]}, {"rotation": 0}, None)["page"]
    assert "unequal, 25 m/s, rotation 0" in html and html == page({"runs": [path]}, {"rotation": 0}, None)["page"]


def test_table_1(done, tmp_path):
    from ratd.experiments.collision.files import cluster_row

    cluster = study.built(plan(done).cluster(SILICA, "equal"), 1)
    path = tmp_path / "velocity" / "equal.nc"
    row = cluster_row(cluster, 1.6e-6, "equal")
    io.write(path, blocks.block([row], "built_clusters", SILICA), "built_clusters")
    (found,) = cluster_table([path]).to_dict("records")
    assert found["law"] == "velocity" and found["n_monomers"] == cluster.n_monomers
    assert found["filling_factor"] == pytest.approx(cluster.n_monomers * 0.4**3 / 1.6**3)
    assert found["n_contacts"] * cluster.n_monomers == pytest.approx(cluster.n_contacts, abs=1)


def test_velocities_look_alike_in_all_panels():
    looks = looks_of([[10, 15, 20, 25, 30, 35, 40], [], [15, 25, 40, 40]])
    # those of the panel that has the fewest, each with the colour that it has in any figure
    assert list(looks) == [15, 25, 40] and looks[25]["color"] == colour_of_velocity(25)
    assert len({look["color"] for look in looks.values()}) == len({look["ls"] for look in looks.values()}) == 3
    assert len(looks_of([range(1, 40)])) == 5 and looks_of([[], []]) == {}


def test_energies_are_averaged_over_samples():
    def one(sample, energy):
        zero = np.zeros(2)
        table = pd.DataFrame({"time": [0.0, 1.0], "kinetic_translation": [4.0, energy], "kinetic_spin": zero})
        return {"sample": sample, "impact_energy": 4.0}, table

    time, energy, error = mean_energy([one(1, 1.0), one(1, 1.0), one(1, 1.0), one(2, 3.0)])
    assert time.tolist() == [0.0, 1.0] and energy.tolist() == [1.0, 0.5]
    # of two samples with 0.25 and 0.75
    np.testing.assert_allclose(error, [0.0, 0.25])
    assert np.isnan(mean_energy([one(1, 1.0)])[2]).all()
