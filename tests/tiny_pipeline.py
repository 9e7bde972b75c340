"""The pipeline in a folder of its own, on a few very small grains, for tests of it as a whole."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

from ratd.pipeline.provenance import file_hash

ROOT = Path(__file__).parents[1]
TINY = yaml.safe_load((ROOT / ".test" / "tiny.yaml").read_text())["spin_up"]
"""What differs from the config of the spin-up as it comes."""


class Pipeline:
    """The pipeline in a folder of its own, with ratd as installed or, once `own_source` was called, a copy of it."""

    def __init__(self, folder):
        self.folder = folder
        self.environment = dict(os.environ)
        for name in ("config", "profiles", "workflow"):
            shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "Snakefile", folder)
        self.write_config(TINY)

    def write_config(self, spin_up):
        config = {"results": "results/tiny", "spin_up": spin_up}
        (self.folder / "tiny.yaml").write_text(yaml.safe_dump(config))

    def own_source(self):
        """Copy ratd into the folder, so that a test can change it."""
        source = self.folder / "src"
        if not source.exists():
            shutil.copytree(ROOT / "src" / "ratd", source / "ratd", ignore=shutil.ignore_patterns("__pycache__"))
            self.environment["PYTHONPATH"] = str(source)
        return source / "ratd"

    def command(self, *arguments):
        return [sys.executable, "-m", "snakemake", "--cores", "2", *arguments, "--configfile", "tiny.yaml"]

    def run(self, *arguments):
        return subprocess.run(
            self.command(*arguments),
            cwd=self.folder,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=1800,
        )

    def start(self, *arguments):
        with open(self.folder / "output.txt", "w") as output:
            return subprocess.Popen(
                self.command(*arguments),
                cwd=self.folder,
                env=self.environment,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def planned(self, *arguments):
        """Names of the rules that would run -> number of jobs."""
        done = self.run("--dry-run", *arguments)
        assert done.returncode == 0, done.stdout
        if "Nothing to be done" in done.stdout:
            return {}
        table = done.stdout.split("Job stats:")[1].split("total")[0]
        return {rule: int(n) for rule, n in re.findall(r"^([\w-]+) +(\d+)$", table, re.M) if rule != "all"}

    def files(self):
        """Path of every result -> hash of its content; not the logs and benchmarks, which tell the time."""
        return {
            str(path.relative_to(self.folder)): file_hash(path)
            for path in sorted((self.folder / "results").rglob("*"))
            if path.is_file() and not {"logs", "benchmarks"} & set(path.parts)
        }
