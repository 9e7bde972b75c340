"""The Python of README.md and docs/using.md, as a reader would type it."""

import re
from pathlib import Path

import matplotlib.pyplot as plt
import pandas as pd
import pytest
import xarray as xr

import ratd
from tiny_pipeline import Pipeline

README = Path(__file__).parents[1] / "README.md"
USING = Path(__file__).parents[1] / "docs" / "using.md"


def code(section, start, end):
    """Lines of code of a section of the page between two texts."""
    text = USING.read_text(encoding="utf-8").split(f"\n## {section}\n")[1].split(start)[1].split(end)[0]
    return [line[4:] for line in text.splitlines() if line.startswith("    ")]


def test_one_grain_and_two_that_meet():
    """With a grain that takes a second, and without the last line of the first, whose spin-up may take long."""
    lines = code("From Python", "one grain:", "One cluster")
    assert "ratd.spin_up(own" in lines[-1] and "200e-9" in "".join(lines)
    own = ratd.grow("BA", 60e-9, "q-S", 0)
    names = {"position": own.position, "radius": own.radius}
    exec("\n".join(lines[:-1]).replace("200e-9", "60e-9"), names)
    (line,) = plt.gca().get_lines()
    plt.close()
    assert line.get_ydata() == pytest.approx(names["run"]["mass"].values)
    assert line.get_xdata() == pytest.approx(names["run"]["omega"].values)
    assert names["own"].n_contacts == own.n_contacts

    exec("\n".join(code("From Python", "at 10 m/s:", "From files")), names)
    meeting = names["run"]
    assert meeting["n_pieces"][0] == 2
    assert abs(meeting["residual"][-1]) < 0.03 * meeting["kinetic_translation"][0]


def test_a_cluster_that_is_compressed_and_pulled(tmp_path, monkeypatch):
    """With one that takes a second."""
    monkeypatch.chdir(tmp_path)
    lines = code("From Python", "and pulled again:", "Own aggregates")
    names = {"ratd": ratd}
    for as_written, small in (("1024", "64"), ("strain_rate=1e-5", "strain_rate=3e-5")):
        lines = [line.replace(as_written, small) for line in lines]
    exec("\n".join(lines), names)
    assert names["run"]["phi"][-1] == pytest.approx(0.3, rel=1e-3)
    xr.testing.assert_identical(xr.load_dataset("run.nc"), names["run"])
    assert names["pulled"].attrs["tensile_strength"] > 0.0


def test_two_clusters_that_collide():
    """With fewer spheres for a shorter time."""
    lines = code("Collisions", "From Python:", "Both clusters")
    small = "[0.4e-6, 0.3e-6, 0.3e-6, 0.2e-6]"
    text = "\n".join(lines).replace("ratd.mrn(5000, seed=1), radius=4e-6", f"{small}, radius=1.2e-6")
    text = text.replace('law="dmt")', 'law="dmt", duration=2e-7)')
    assert small in text and "duration" in text
    names = {"ratd": ratd, "table": pd.DataFrame({"velocity": [1.0, 2.0], "X": [0.3, 0.0]})}
    exec(text, names)
    assert names["pieces"]["piece_members"].values.sum() == 8 and names["run"].sizes["snapshot"] == 31
    assert ratd.fragmentation_velocity(names["table"])["velocity"] == pytest.approx(1.5)


def test_the_python_of_the_readme():
    """With a grain that takes a second."""
    lines = README.read_text(encoding="utf-8").split("## From Python\n")[1].split("If your aggregate")[0].splitlines()
    text = "\n".join(line[4:] for line in lines)
    assert '"BAM2", a_eff=200e-9' in text
    names = {}
    exec(text.replace('"BAM2", a_eff=200e-9', '"BA", a_eff=60e-9'), names)
    omega = names["ratd"].disruption(names["run"])["omega_disr"]
    assert names["run"]["omega"].values.max() > omega > 1e8


def test_the_readme_is_one_screen_and_what_it_names_is_there():
    text = README.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 80
    for path in re.findall(r'\]\(([^)]+)\)|src="([^"]+)"', text):
        assert (README.parent / "".join(path)).exists(), path
    for name in re.findall(r"ratd\.(\w+)\(", text):
        assert hasattr(ratd, name)


def test_the_first_command_plans_all_three_experiments(tmp_path):
    (command,) = re.findall(r"^ {4}.*snakemake --cores 2 (.*)$", README.read_text(encoding="utf-8"), re.MULTILINE)
    *targets, _, config = command.split()
    pipeline = Pipeline(tmp_path)
    (tmp_path / "tiny.yaml").write_text((README.parent / config).read_text(encoding="utf-8"))
    assert {"spin_up", "compress", "collide", "grain_page", "compression_page"} <= set(pipeline.planned(*targets))
