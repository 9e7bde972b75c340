"""The pipeline of the compression as a whole, on one very small cluster."""

import yaml

from ratd.pipeline import io
from tiny_pipeline import Pipeline

SMALL = {
    "all_sets": {"n": 32, "strain_rate": 1e-4, "until_phi": 0.2, "timestep_factor": 0.14, "seeds": {"number": 2}},
    "pulls": {"x": {"set": "base", "phi": [0.15], "strain_rate": 1e-4, "number": 1}},
    "figures": {
        **dict.fromkeys([f"figure{k}" for k in range(3, 14)]),
        "looser": None,
        "isotropy": None,
        "high_density": None,
        "monomers": None,
        "fewer_steps": None,
        "figure4": {"sets": ["base"]},
        "tension": {"pulls": ["x"]},
    },
}


def test_clusters_are_grown_compressed_pulled_and_drawn_and_nothing_runs_twice(tmp_path):
    pipeline = Pipeline(tmp_path)
    (tmp_path / "tiny.yaml").write_text(yaml.safe_dump({"results": "results/tiny", "compression": SMALL}))
    done = pipeline.run("compression")
    assert done.returncode == 0, done.stdout
    assert {path.name for path in (tmp_path / "results/tiny/clusters").iterdir()} == {"base"}
    results = tmp_path / "results" / "tiny"
    for name in ("figure4", "tension"):
        assert (results / "figures" / f"compression_{name}.png").stat().st_size > 10_000
    table = io.read(results / "compression" / "base.nc", "compression_set")
    assert table["seed"].values.tolist() == [0, 1] and table["phi"].values[-1] < 0.2
    assert {"base", "base.nc"} <= {path.name for path in (results / "compression").iterdir()}
    assert pipeline.planned("compression") == {}
