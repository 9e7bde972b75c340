"""``python -m ratd``: one aggregate from a file, one answer."""

import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import numba
import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner

import ratd
from files import grains_file, make_grain
from ratd.aggregates.write_particles import write_particles
from ratd.command import COMMANDS, SHOWN, main
from ratd.experiments import command as commands
from ratd.experiments.collision.figures.snapshots import origin_of, positions
from ratd.experiments.command import SHIFT, answer, moved, part_done
from ratd.experiments.compression.command import pressure_at
from ratd.experiments.saved import KNOWN_BY
from ratd.experiments.spin_up import command, run_files
from ratd.pipeline import io, provenance
from ratd.pipeline.blocks import rows
from ratd.pipeline.kinds import HOMES

FAST = ("--material", "q-S", "--epsilon", "1", "--starts", "3")


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.fixture
def chain(tmp_path):
    write_particles(make_grain(n=4), tmp_path / "chain.xyz")
    return tmp_path / "chain.xyz"


def test_an_aggregate_is_spun_up_from_its_file(chain):
    done = run("spin-up", chain, *FAST)
    assert done.exit_code == 0, done.output
    runs = run_files.read_runs(chain.with_name("chain_spin_up.nc"))
    omega = [float(ratd.disruption(run)["omega_disr"]) for run in runs]
    said = re.search(r"omega_disr = (\S+) ± (\S+) rad/s", done.stdout)
    assert float(said[1]) == pytest.approx(np.mean(omega), rel=1e-3)
    assert float(said[2]) == pytest.approx(np.std(omega, ddof=1), rel=0.06)
    assert [run.sizes.get("snapshot", 0) > 0 for run in runs] == [True, False, False]
    assert chain.with_name("chain_spin_up.png").read_bytes()[1:4] == b"PNG"
    assert chain.with_name("chain_spin_up.html").read_text().startswith("<!doctype html>")
    assert not list(chain.parent.glob("*.partial"))
    # and the same again from the file
    again = run("show", chain.with_name("chain_spin_up.nc"), "--out", chain.with_name("again"))
    assert again.exit_code == 0 and said[0] in again.stdout
    assert chain.with_name("again.png").exists()


def test_that_the_first_call_compiles_is_said_once(chain, tmp_path, monkeypatch):
    for folder, said in ((tmp_path / "cache", [True, False]), (tmp_path / "none", [True, True])):
        (tmp_path / "cache").mkdir(exist_ok=True)
        monkeypatch.setattr(numba.config, "CACHE_DIR", str(folder))
        for start, told in enumerate(said):
            how = ("--material", "q-S", "--epsilon", "1", "--starts", "1", "--out", tmp_path / f"{folder.name}{start}")
            done = run("spin-up", chain, *how)
            assert done.exit_code == 0 and ("compiles, which takes a minute" in done.stdout) == told


def test_a_material_of_ones_own_stands_in_a_file(chain, tmp_path):
    own = tmp_path / "own.yaml"
    grow = "{{surface_energy_mJ_m2: {}, youngs_modulus_GPa: 54, poisson_number: 0.17, density_kg_m3: 2650}}"
    own.write_text(f"same: {grow.format(20)}\nfirm: {grow.format(40)}\n")
    assert ratd.read_materials(own)["firm"].surface_energy == pytest.approx(0.04)
    with pytest.raises(ratd.FileError, match="none.yaml: cannot be read"):
        ratd.read_materials("none.yaml")
    omega = {}
    for name in ("q-S", "same", "firm"):
        how = ("--material", name, "--epsilon", "1", "--starts", "1", "--out", tmp_path / name)
        done = run("spin-up", chain, "--materials-file", own, *how)
        assert done.exit_code == 0, done.output
        (found,) = run_files.read_runs(tmp_path / f"{name}.nc")
        assert found.attrs["material"] == name
        omega[name] = float(ratd.disruption(found)["omega_disr"])
    assert omega["q-S"] == omega["same"] < omega["firm"]
    # the same name with other numbers is another material
    own.write_text(f"same: {grow.format(30)}\n")
    done = run("spin-up", chain, "--materials-file", own, *how[2:], "--material", "same", "--out", tmp_path / "same")
    assert done.exit_code == 1 and "holds runs of another aggregate, other settings" in done.stderr


def test_a_cluster_is_compressed_from_its_file(tmp_path):
    cluster = tmp_path / "cluster.xyz"
    write_particles(ratd.grow_bcca(32, material="ice", seed=1), cluster)
    how = ("--material", "ice", "--strain-rate", "1e-4", "--until-phi", "0.25", "--starts", "2")
    done = run("compress", cluster, *how)
    assert done.exit_code == 0, done.output
    target = cluster.with_name("cluster_compressed.nc")
    found = ratd.read_runs(target)
    assert ratd.compressive_strength(found, 0.1, 0.24)["n"] == 2
    assert [round(each["phi"].values[-1], 3) for each in found] == [0.25, 0.25]
    pressures = [pressure_at(each, 0.2) for each in found]
    said = re.search(r"P at phi 0.2 = (\S+) ± (\S+) Pa: (\S+) P_0 phi³", done.stdout)
    assert float(said[1]) == pytest.approx(np.mean(pressures), rel=1e-3)
    over = np.mean(pressures) / (found[0].attrs["rolling_pressure"] * 0.2**3)
    assert float(said[3]) == pytest.approx(over, rel=0.01)
    assert "phi 0.3" not in done.stdout  # it was not reached
    assert cluster.with_name("cluster_compressed.png").read_bytes()[1:4] == b"PNG"
    assert cluster.with_name("cluster_compressed.html").read_text().startswith("<!doctype html>")
    again = run("show", target, "--out", cluster.with_name("again"))
    assert again.exit_code == 0 and said[0] in again.stdout


def test_a_cluster_is_pulled_apart_from_its_file(tmp_path):
    cluster = tmp_path / "cluster.xyz"
    grain = ratd.grow_bcca(32, material="ice", seed=1)
    write_particles(grain, cluster)
    done = run("stretch", cluster, "--material", "ice", "--strain-rate", "1e-4", "--phi", "0.2", "--starts", "2")
    assert done.exit_code == 0, done.output
    target = cluster.with_name("cluster_stretched.nc")
    first = ratd.read_runs(target)[0]
    unmoved = ratd.read_particles(cluster, unit="nm").grain("ice")
    beside = ratd.stretch(ratd.compress(unmoved, 1e-4, 0.2, snapshots=()), 1e-4)
    assert first["tension"].values == pytest.approx(beside["tension"].values)
    strength = np.array([each.attrs["tensile_strength"] for each in ratd.read_runs(target)])
    said = re.search(r"tensile strength = (\S+) ± (\S+) Pa: (\S+) of 0.6", done.stdout)
    assert float(said[1]) == pytest.approx(strength.mean(), rel=1e-3)
    assert float(said[3]) == pytest.approx(strength.mean() / (0.6 * 0.1 / 1e-7 * 0.2**1.8), rel=0.01)
    assert cluster.with_name("cluster_stretched.png").read_bytes()[1:4] == b"PNG"
    refused = run("stretch", cluster, "--material", "ice", "--phi", "0.001", "--out", cluster.with_name("loose"))
    assert refused.exit_code != 0 and "--phi is 0.001; it must be above" in refused.output
    again = run("show", target, "--out", cluster.with_name("again"))
    assert again.exit_code == 0 and said[0] in again.stdout


def test_two_clusters_collide_from_their_files(tmp_path):
    one, other = tmp_path / "one.xyz", tmp_path / "other.xyz"
    for path, number in ((one, 12), (other, 8)):
        write_particles(ratd.build_cluster(np.full(number, 3e-7), 1.2e-6, "silica", seed=1), path)
    how = ("--material", "silica", "--velocity", "20", "--duration", "2e-7", "--starts", "2")
    done = run("collide", one, "--other", other, *how)
    assert done.exit_code == 0, done.output
    found = rows(io.read(one.with_name("one_collided.nc"), "collisions"), "collisions")
    assert [row["n_monomers"].item() for row in found] == [20, 20] and found[0]["velocity"].item() == 20.0
    assert found[0]["friction"].item() == "velocity" and found[0]["damping_time"].item() == pytest.approx(
        0.5e-9, rel=1e-3
    )
    assert origin_of(positions(found[0])[2]).tolist() == [0] * 12 + [1] * 8
    said = re.search(r"N_s = (\S+) ± (\S+): fragmentation", done.stdout)
    assert float(said[1]) == pytest.approx(np.mean([row["N_s"].item() for row in found]), rel=1e-3, abs=1e-4)
    assert one.with_name("one_collided.png").read_bytes()[1:4] == b"PNG"
    assert one.with_name("one_collided.html").read_text().startswith("<!doctype html>")
    long = run("collide", one, *how, "--timestep", "1", "--out", tmp_path / "long")
    assert long.exit_code == 1 and "timestep is 1 s; the smallest sphere, 3e-07 m, allows at most" in long.stderr
    slow = run("collide", one, "--material", "silica", "--velocity", "0.001")
    assert slow.exit_code == 1 and "in which the two do not meet" in slow.stderr
    # the same rotations of one with itself are other collisions
    done = run("collide", one, *how, "--law", "jkr")
    assert done.exit_code == 1 and "give another --out" in done.stderr
    done = run("collide", one, *how, "--law", "jkr", "--out", tmp_path / "alone")
    assert done.exit_code == 0 and "24 spheres at 20 m/s" in done.stdout


def test_a_stopped_command_goes_on_with_the_same_answer(chain, monkeypatch):
    assert run("spin-up", chain, *FAST, "--out", chain.with_name("whole")).exit_code == 0
    begun = []

    def stopped(grain, **how):
        begun.append(grain.seed)
        if grain.seed == 2 and len(begun) == 3:
            raise KeyboardInterrupt
        return ratd.spin_up(grain, **how)

    monkeypatch.setattr(command, "spin_up", stopped)
    # what takes no time is written with what comes next; Ctrl-C writes it too
    monkeypatch.setattr("ratd.pipeline.partial.WORK_BETWEEN_PIECES", 1e9)
    done = run("spin-up", chain, *FAST)
    assert done.exit_code == 130 and done.stderr.endswith("stopped; the same command goes on with what is kept\n")
    assert not chain.with_name("chain_spin_up.nc").exists()
    assert run("spin-up", chain, *FAST).exit_code == 0
    assert begun == [0, 1, 2, 2]
    assert chain.with_name("chain_spin_up.nc").read_bytes() == chain.with_name("whole.nc").read_bytes()


def test_what_is_there_is_taken_and_other_runs_are_not_overwritten(chain, monkeypatch):
    first = run("spin-up", chain, *FAST)
    target = chain.with_name("chain_spin_up.nc")
    made = target.read_bytes()

    def never(grain, **how):
        raise AssertionError

    with monkeypatch.context() as patch:
        patch.setattr(command, "spin_up", never)
        again = run("spin-up", chain, *FAST)
        other = run("spin-up", chain, "--material", "a-C", *FAST[2:])
    assert again.exit_code == 0 and again.stdout.splitlines()[-5:] == first.stdout.splitlines()[-5:]
    assert other.exit_code == 1 and other.stderr.count("\n") == 1 and "remove it, or give another --out" in other.stderr
    assert target.read_bytes() == made


def test_an_aggregate_that_has_changed_does_not_get_the_old_answer(chain):
    run("spin-up", chain, *FAST)
    made = chain.with_name("chain_spin_up.nc").read_bytes()
    write_particles(make_grain(n=5), chain)
    other = run("spin-up", chain, *FAST)
    assert other.exit_code == 1 and "remove it, or give another --out" in other.stderr
    assert chain.with_name("chain_spin_up.nc").read_bytes() == made
    assert run("spin-up", chain, *FAST, "--out", chain.with_name("new")).exit_code == 0


def test_more_starts_are_added_to_those_that_are_there_and_fewer_take_none_away(chain, monkeypatch):
    begun = []

    def counted(grain, **how):
        begun.append(grain.seed)
        return ratd.spin_up(grain, **how)

    assert run("spin-up", chain, *FAST, "--out", chain.with_name("whole")).exit_code == 0
    monkeypatch.setattr(command, "spin_up", counted)
    for starts, expected in ((2, [0, 1]), (3, [0, 1, 2]), (1, [0, 1, 2])):
        done = run("spin-up", chain, *FAST[:4], "--starts", starts)
        assert done.exit_code == 0 and begun == expected
    assert (
        "3 starts of 4 monomers" in done.stdout
        and f"{chain}: 4 spheres, radii 20.08 to 23.18 nm, 3 contacts" in done.stdout
    )
    assert not list(chain.parent.glob("*.partial"))
    made = [run_files.read_runs(chain.with_name(f"{name}.nc")) for name in ("chain_spin_up", "whole")]
    for own, other in zip(*made, strict=True):
        assert own.equals(other)


def test_starts_made_with_other_packages_are_told_but_no_others_join_them(chain, monkeypatch):
    target = chain.with_name("chain_spin_up.nc")
    monkeypatch.setattr(provenance, "versions", lambda: "ratd 1.0.0, pandas 2.0.0")
    assert run("spin-up", chain, *FAST[:4], "--starts", 2).exit_code == 0
    made = target.read_bytes()
    monkeypatch.undo()
    assert run("spin-up", chain, *FAST[:4], "--starts", 2).exit_code == 0
    done = run("spin-up", chain, *FAST)
    said = f"{target} holds 2 starts made with ratd 1.0.0, pandas 2.0.0, to which none of ratd"
    assert done.exit_code == 1 and said in done.stderr and "remove it, or give another --out" in done.stderr
    assert target.read_bytes() == made and not list(chain.parent.glob("*.partial"))


def test_a_command_that_waited_for_the_same_one_makes_nothing_anew(chain, monkeypatch):
    """The other one ends between the look at the file and the lock."""
    begun = []

    def counted(grain, **how):
        begun.append(grain.seed)
        return ratd.spin_up(grain, **how)

    def waited(*arguments):
        monkeypatch.setattr(commands, "locked", lock)
        assert run("spin-up", chain, *FAST).exit_code == 0
        return lock(*arguments)

    lock = commands.locked
    monkeypatch.setattr(command, "spin_up", counted)
    monkeypatch.setattr(commands, "locked", waited)
    assert run("spin-up", chain, *FAST).exit_code == 0 and begun == [0, 1, 2]
    assert not list(chain.parent.glob("*.partial"))


def test_unfinished_runs_of_other_settings_are_not_removed(chain, monkeypatch):
    def stopped(grain, **how):
        if grain.seed == 1:
            raise KeyboardInterrupt
        return ratd.spin_up(grain, **how)

    with monkeypatch.context() as patch:
        patch.setattr(command, "spin_up", stopped)
        assert run("spin-up", chain, *FAST).exit_code != 0
    (folder,) = chain.parent.glob("*.partial")
    kept = sorted(path.name for path in folder.iterdir())
    assert "seed_0.nc" in kept
    done = run("spin-up", chain, "--material", "a-C", *FAST[2:])
    assert done.exit_code == 1 and "holds unfinished runs of another aggregate, other settings" in done.stderr
    assert sorted(path.name for path in folder.iterdir()) == kept


def test_a_run_that_fails_ends_with_a_sentence_and_leaves_nothing(chain, monkeypatch):
    def fail(grain, **how):
        raise RuntimeError("the balance of energy is off")

    monkeypatch.setattr(command, "spin_up", fail)
    done = run("spin-up", chain, *FAST)
    assert done.exit_code == 1 and "error: the balance of energy is off" in done.stderr
    assert [path.name for path in chain.parent.iterdir()] == [chain.name]


def test_starts_are_moved_by_less_than_an_atom(chain):
    position = make_grain(n=4).position
    first, second = moved(position, 1), moved(position, 2)
    assert moved(position, 0) is position and np.array_equal(first, moved(position, 1))
    assert not np.array_equal(first, second)
    np.testing.assert_allclose(np.linalg.norm(first - position, axis=1), SHIFT, rtol=1e-3)


def test_a_file_of_spheres_and_one_of_grains_are_shown(chain):
    done = run("show", chain, "--material", "q-S")
    assert done.exit_code == 0 and "4 monomers, 3 contacts, radii 20" in done.stdout
    pair = chain.with_name("pair.txt")
    pair.write_text("0 0 0 20\n0 0 40 20\n")
    done = run("show", pair, "--material", "q-S")
    assert done.exit_code == 0 and "2 monomers, 1 contact, radius 20 nm" in done.stdout
    assert chain.with_suffix(".png").read_bytes()[1:4] == b"PNG"
    odd = chain.with_name("a$\\q$b.xyz")
    odd.write_bytes(chain.read_bytes())
    assert run("show", odd).exit_code == 0
    grains_file(chain.with_name("grains.nc"))
    done = run("show", chain.with_name("grains.nc"))
    assert done.exit_code == 0 and "seed 2: 5 monomers, 4 contacts, porosity" in done.stdout


def saved_runs(folder):
    """One run of each experiment, saved as a user does, and what `show` must say of it."""
    cluster = ratd.grow_bcca(32, material="ice", seed=1)
    pressed = ratd.compress(cluster, 1e-4, 0.25, snapshots=(0.1,))
    pulled = ratd.stretch(pressed, 1e-4)
    spun = ratd.spin_up(make_grain(n=4), epsilon=1)
    two = ratd.build_cluster(np.full(6, 3e-7), 1.0e-6, "silica", seed=1)
    met = ratd.collide(two, two, 20.0, duration=2e-7)
    for name, run in (("compress", pressed), ("stretch", pulled), ("spin_up", spun), ("collide", met)):
        run.to_netcdf(folder / f"{name}.nc")
    return {
        "compress": f"P at phi 0.2 = {pressure_at(pressed, 0.2):.4g} Pa",
        "stretch": f"tensile strength = {pulled.attrs['tensile_strength']:.4g} Pa",
        "spin_up": f"omega_disr = {float(ratd.disruption(spun)['omega_disr']):.4g} rad/s",
        "collide": "12 spheres at 20 m/s",
    }


def test_runs_that_a_user_saved_are_shown(tmp_path):
    for name, said in saved_runs(tmp_path).items():
        done = run("show", tmp_path / f"{name}.nc")
        assert done.exit_code == 0 and said in done.stdout, done.output
        assert (tmp_path / f"{name}.png").read_bytes()[1:4] == b"PNG"
        assert len(ratd.read_runs(tmp_path / f"{name}.nc")) == 1
    xr.load_dataset(tmp_path / "compress.nc")[["phi", "pressure", "snapshot_phi"]].to_netcdf(tmp_path / "part.nc")
    done = run("show", tmp_path / "part.nc")
    assert done.exit_code == 1 and "part.nc: is not the whole of a run, as ratd" in done.stderr
    assert "phi_mean" in done.stderr
    done = run("show", tmp_path / "compress.nc", "--unit", "um")
    assert done.exit_code == 1 and "leave out --unit and --material" in done.stderr
    ratd.evolve(np.zeros((1, 3)), [1e-7], duration=1e-9, timestep=1e-10).to_netcdf(tmp_path / "other.nc")
    with pytest.raises(ratd.InputError, match="other.nc: holds no runs; allowed: what ratd.spin_up, compress"):
        ratd.read_runs(tmp_path / "other.nc")
    done = run("show", tmp_path / "other.nc")
    assert done.exit_code == 1 and "other.nc: holds none of these; allowed: files of spinup" in done.stderr


def test_what_is_averaged_differs_in_its_starts_alone(tmp_path):
    """Files of the documents, which hold several velocities and samples, and grains that differ."""
    data = Path(__file__).parents[2] / "docs"
    told = run("show", data / "collision" / "data" / "velocity" / "314nm.nc", "--out", tmp_path / "a").stdout
    found = ratd.read_runs(data / "collision" / "data" / "velocity" / "314nm.nc")
    for velocity, sample in {(row["velocity"].item(), row["sample"].item()) for row in found}:
        own = [row["X"].item() for row in found if (row["velocity"], row["sample"]) == (velocity, sample)]
        heading = f"{len(own)} rotations of 1226 spheres at {velocity:g} m/s, sample {sample:g}, mean"
        assert told.count(heading) == 1 and answer("X", own, "").rstrip() in told
    told = run("show", data / "reproduction" / "data" / "figure4" / "literal.nc", "--out", tmp_path / "b").stdout
    assert "5 grains of 613 to 782 monomers, mean" in told


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("spin-up", "none.xyz", *FAST), "error: none.xyz: cannot be read"),
        (("spin-up", "{bare}", *FAST, "--unit", "m"), "read in nm they would: give that as the unit"),
        (("spin-up", "{chain}", "--material", "cheese"), "'cheese' is not a material; allowed: a-C, q-S"),
        (("show", "{chain}", "--material", "ice", "--materials-file", "none.yaml"), "none.yaml: cannot be read"),
        (("show", "{chain}", "--material", "ice", "--materials-file", "{empty}"), "empty.txt: holds no material"),
        (
            ("spin-up", "{micron}", *FAST),
            "micron.txt: states no unit, and read in nm the radii have the median 1e-10 m",
        ),
        (("spin-up", "{micron}", *FAST), "give the unit, which is um in all likelihood"),
        (("spin-up", "{apart}", *FAST), "apart.txt: The aggregate is in 2 pieces"),
        (("spin-up", "{chain}", *FAST, "--unit", "um"), "states that its lengths are in nm, and was to be read in um"),
        (("spin-up", "{chain}", *FAST, "--out", ""), "is a folder; allowed: a stem in it"),
        (("show", "."), "'.' is a directory"),
        (("collide", "{chain}", "--material", "q-S", "--velocity", "nan"), "nan is not a finite number"),
        (("spin-up", "{chain}", "--material", "q-S", "--epsilon", "nan"), "nan is not a finite number"),
        (("show", "none.nc"), "error: none.nc: cannot be read as netCDF"),
        (("melt", "{chain}"), "No such command 'melt'"),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(chain, arguments, said):
    chain.with_name("apart.txt").write_text("0 0 0 20\n0 0 50 20\n")
    chain.with_name("bare.txt").write_text("0 0 0 20\n0 0 40 20\n")
    chain.with_name("micron.txt").write_text("0 0 0 0.1\n0 0 0.2 0.1\n")
    chain.with_name("empty.txt").write_text("")
    written = ("apart", "bare", "micron", "empty")
    names = {"chain": str(chain)} | {name: str(chain.with_name(f"{name}.txt")) for name in written}
    done = run(*[argument.format(**names) for argument in arguments])
    assert done.exit_code != 0 and said in done.output and "Traceback" not in done.output


def test_the_answer_says_what_is_not_known():
    assert answer("x", [1.0, 3.0], "m") == "x = 2 ± 1.4 m"
    assert answer("x", [np.nan, 3.0], "m") == "x = 3 m, known in 1 of 2 starts"
    assert answer("x", [np.nan], "m") == "x: unknown, no start shows it"
    assert part_done(0.0, float("inf")) == 0.0 and 0 < part_done(0.0, 1.0) <= 1


def test_every_subcommand_is_there():
    for name, home in COMMANDS.items():
        assert import_module(home).command.name == name
        told = run(name, "--help")
        assert told.exit_code == 0 and "Options:" in told.stdout and not told.stderr
    for kind, home in SHOWN.items():
        assert kind in HOMES and callable(import_module(home).show)
    assert KNOWN_BY.keys() <= SHOWN.keys()


def test_the_module_can_be_run(tmp_path):
    done = subprocess.run([sys.executable, "-m", "ratd", "--help"], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0 and "spin-up" in done.stdout and "python -m ratd" in done.stdout
