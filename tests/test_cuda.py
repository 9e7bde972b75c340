"""The engine on CUDA: its kernels in simulation, its rule, and what is said where there is no GPU."""

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml
from scipy.stats import ks_2samp

import tiny_pipeline
from ratd import io, jobs
from ratd.cuda import device
from ratd.cuda.arena import Batch
from ratd.cuda.spin_up import spin_up_many
from ratd.engine.state import new_state
from ratd.errors import InputError
from ratd.growth import grow
from ratd.marks import disruption
from ratd.spinup import spin_up

SIMULATED = {"NUMBA_ENABLE_CUDASIM": "1"}
TINY = {
    "results": "results/tiny",
    "materials": ["q-S"],
    "types": ["BA"],
    "sizes_nm": [45, 50],
    "seeds": {"first": 0, "number": 2},
    "block_size": 2,
    "small_grains": None,
    "spin_up": {"epsilon": None, "angular_acceleration": 4e18, "records": 20, "max_steps": 150},
    "snapshots": {"every": 5, "grains": [{"material": "q-S", "type": "BA", "size_nm": 45, "seed": 1}]},
    "figures": dict.fromkeys(
        ["figure1", "figure4", "figure5", "figure6", "figure8", "figure9", "figure10", "calibration", "formulae"]
    ),
}


def usable():
    try:
        device.require()
    except InputError:
        return False
    return True


no_gpu = pytest.mark.skipif(usable(), reason="there is a GPU")


needs_gpu = pytest.mark.skipif(not usable(), reason="there is no GPU")


def run_tests(*arguments, **environment):
    """Run tests in a process of their own, where numba is imported with other variables in its environment."""
    folder = Path(__file__).parent
    paths = os.pathsep.join(filter(None, [str(folder), os.environ.get("PYTHONPATH")]))
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *arguments],
        cwd=folder,
        env=os.environ | environment | {"PYTHONPATH": paths},
        capture_output=True,
        text=True,
        timeout=1200,
    )
    assert done.returncode == 0 and "skipped" not in done.stdout, done.stdout + done.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulated_cuda.py", "runs_cuda.py"],
        # killed and resumed: the same kernels once more
        ["-p", "watched_cuda", "racing_cuda.py", "simulated_cuda.py", "runs_cuda.py", "-k", "not killed"],
    ],
    ids=["numbers", "races"],
)
def test_kernels_in_simulation(arguments):
    run_tests(*arguments, **SIMULATED)


@needs_gpu
def test_whole_runs_on_the_device():
    run_tests("runs_cuda.py")


@needs_gpu
def test_omega_disr_of_200_grains_is_that_of_the_processor():
    """Rounding grows until contacts break in another order: a grain may differ, the distribution of a type may not."""
    settings = dict(drive="prescribed", epsilon=0.1)
    ratios = []
    for kind in ("BA", "BAM2"):
        grains = [grow(kind, 80e-9, "q-S", seed) for seed in range(100)]
        found, expected = (
            np.array([float(disruption(run)["omega_disr"]) for run in runs])
            for runs in (spin_up_many(grains, **settings), [spin_up(grain, **settings) for grain in grains])
        )
        assert ks_2samp(found, expected).pvalue > 0.01
        ratios.append(found / expected)
    assert np.median(np.abs(np.concatenate(ratios) - 1.0)) < 0.02


@no_gpu
def test_missing_gpu_is_one_sentence():
    with pytest.raises(InputError, match="^engine is cuda, but [^\n]*[.]$"):
        device.require()


@no_gpu
def test_pipeline_without_gpu_ends_with_one_sentence_before_any_job(tmp_path):
    pipeline = tiny_pipeline.Pipeline(tmp_path)
    pipeline.write_config(TINY | {"engine": "cuda"})
    done = pipeline.run()
    assert done.returncode != 0
    *remarks, sentence = [line for line in done.stdout.splitlines() if line]
    assert sentence.startswith("engine is cuda, but ")
    assert remarks[-1].startswith("total ") and "Error" not in done.stdout  # no job, nothing but the plan of all jobs
    assert not (tmp_path / "results").exists()


@no_gpu
def test_pipeline_without_gpu_plans_and_computes_what_needs_none(tmp_path):
    pipeline = tiny_pipeline.Pipeline(tmp_path)
    pipeline.write_config(TINY | {"engine": "cuda"})
    assert pipeline.planned("spinups")["spin_up_cuda_prescribed_q-S_BA"] == 1
    done = pipeline.run("grains")
    assert done.returncode == 0, done.stdout
    assert pipeline.planned("grains") == {}


@pytest.mark.parametrize("here", [True, False])
@pytest.mark.parametrize("environments", [set(), {"conda"}])
@pytest.mark.parametrize("resources", [{"gpu": 1, "mem_mb": 500}, {"mem_mb": 500}])
def test_gpu_is_asked_for_where_a_job_is_to_use_it(here, environments, resources):
    """Not on the host that sends jobs to a cluster, nor beside the environments that jobs have of their own."""
    jobs_to_run = [SimpleNamespace(resources={"mem_mb": 500}), SimpleNamespace(resources=resources)]
    workflow = SimpleNamespace(
        local_exec=here,
        deployment_settings=SimpleNamespace(deployment_method=environments),
        dag=SimpleNamespace(needrun_jobs=lambda: iter(jobs_to_run)),
    )
    assert jobs.gpu_needed(workflow) == (here and not environments and "gpu" in resources)


def test_pipeline_writes_the_files_of_the_other_engine(tmp_path):
    """In simulation: one job for all sizes and seeds, the same files with the same grains, records and snapshots."""
    files = {}
    for engine in ("cpu", "cuda"):
        (tmp_path / engine).mkdir()
        pipeline = tiny_pipeline.Pipeline(tmp_path / engine)
        pipeline.environment |= SIMULATED
        (pipeline.folder / "tiny.yaml").write_text(yaml.safe_dump(TINY | {"engine": engine}))
        planned = pipeline.planned("spinups")
        jobs = {name: n for name, n in planned.items() if name.startswith("spin_up")}
        cuda = {f"spin_up_cuda_prescribed_q-S_{kind}": 1 for kind in TINY["types"]}
        assert jobs == (cuda if engine == "cuda" else {"spin_up": 2})
        done = pipeline.run("spinups")
        assert done.returncode == 0, done.stdout
        assert pipeline.planned("spinups") == {}
        folder = pipeline.folder / "results/tiny/spinup"
        files[engine] = {path.relative_to(folder): io.read(path, "spinup") for path in folder.rglob("*.nc")}
        assert not list(folder.rglob("*.partial"))
    assert len(files["cpu"]) == 2 and files["cpu"].keys() == files["cuda"].keys()
    for name, expected in files["cpu"].items():
        found = files["cuda"][name]
        assert found.sizes == expected.sizes
        same = ("material", "type", "drive", "spin_up_law", "settings", "input_hash")
        assert {key: found.attrs[key] for key in same} == {key: expected.attrs[key] for key in same}
        for variable in expected.variables:
            values = expected[variable].values
            if values.dtype.kind == "f" and values.size:
                scale = np.nanmax(np.abs(values))
                np.testing.assert_allclose(found[variable].values, values, rtol=0, atol=1e-6 * scale, err_msg=variable)
            else:
                np.testing.assert_array_equal(found[variable].values, values, err_msg=variable)


def test_kernel_compiles_for_a_device(monkeypatch):
    """To PTX for compute capability 9.0, which takes the compiler of environment-gpu.txt but no device."""
    if device.numba_cuda.implementation != "NVIDIA":
        pytest.skip("needs the packages of environment-gpu.txt")
    from numba import types
    from numba.cuda import dispatcher
    from numba.cuda.typing.typeof import Purpose, typeof

    from ratd.cuda import advance, arena

    monkeypatch.setattr(dispatcher, "get_current_device", lambda: SimpleNamespace(compute_capability=(9, 0)))
    monkeypatch.setattr(arena, "upload", lambda array: array)
    grain = grow("BAM2", 55e-9, "q-S", 0)
    state = new_state(grain.position, grain.radius, grain.material, grain.contacts, timestep_factor=0.05)
    arrays = typeof(Batch([state], 2).device, Purpose.argument)
    arguments = (arrays, types.Array(types.int64, 1, "C"), types.float64, types.boolean)
    kernel = advance.advance_grains
    bounds = kernel.targetoptions["launch_bounds"]
    text, _ = device.numba_cuda.compile_ptx(kernel.py_func, arguments, cc=(9, 0), launch_bounds=bounds)
    assert ".target sm_90" in text and "fma.rn.f64" in text
    # so many threads then fit on a multiprocessor, whatever way the code takes through the linker
    assert f".maxntid {device.MAX_THREADS}" in text
