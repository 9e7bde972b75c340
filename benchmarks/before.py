"""The engine of another checkout of the repository, timed in a process of its own on the same aggregate.

The other process runs this file as a script, with the other checkout on its path: what it times is what the
`benchmarks.engine` there has to offer, whatever its engine looks like (`turning` and `timed`, as here).
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path


class Before:
    """Aggregates of another checkout; use it in a `with` statement.

    Parameters
    ----------
    checkout : path-like
        Folder of the other checkout.

    Attributes
    ----------
    version : str
        Its commit.
    """

    def __init__(self, checkout):
        checkout = Path(checkout).resolve()
        done = subprocess.run(
            ["git", "-C", checkout, "describe", "--always", "--dirty"], capture_output=True, text=True, check=False
        )
        self.version = done.stdout.strip() or "unknown"
        self._folder = tempfile.TemporaryDirectory()
        # -P: this folder has modules with names of the standard library
        self._child = subprocess.Popen(
            [sys.executable, "-P", __file__],
            env=os.environ | {"PYTHONPATH": f"{checkout / 'src'}{os.pathsep}{checkout}"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._child.stdin.close()
        self._child.wait()
        self._folder.cleanup()

    def turn(self, grain, part, *, relaxed=True):
        """Take an aggregate and let its frame turn, see `benchmarks.engine.turning`; the number of contacts."""
        path = Path(self._folder.name) / "aggregate.txt"
        rows = zip(grain.position.tolist(), grain.radius.tolist(), strict=True)
        path.write_text("\n".join(" ".join(map(repr, (*place, radius))) for place, radius in rows) + "\n")
        return self._ask(path=str(path), part=part, relaxed=relaxed)["contacts"]

    def go_on(self, steps):
        """Make some steps; processor time [s] and the number of contacts then."""
        answer = self._ask(steps=steps)
        return answer["seconds"], answer["contacts"]

    def _ask(self, **question):
        self._child.stdin.write(json.dumps(question) + "\n")
        self._child.stdin.flush()
        line = self._child.stdout.readline()
        if not line:
            raise RuntimeError("the engine of --before has ended with an error, see above")
        return json.loads(line)


def _answer():
    from benchmarks import engine, grains

    body = None
    for line in sys.stdin:
        question = json.loads(line)
        seconds = 0.0
        if "path" in question:
            body = engine.turning(grains.read(question["path"]), question["part"], relaxed=question["relaxed"])
        else:
            body, seconds = engine.timed(body, question["steps"])
        print(json.dumps({"seconds": seconds, "contacts": body.contacts}), flush=True)


if __name__ == "__main__":
    _answer()
