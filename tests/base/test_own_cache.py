"""Compiled code that several processes and checkouts need: one compiles it, the others load it."""

import os
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import ratd
from ratd.base import own_cache

PROCESS = textwrap.dedent(
    """
    import sys, time
    from pathlib import Path
    sys.path.insert(0, sys.argv[1])
    import module
    ready, other = (Path(sys.argv[1], name) for name in sys.argv[2:4])
    ready.touch()
    while not other.exists():
        time.sleep(0.001)
    value = eval(sys.argv[4])
    one = module.twice(value)
    assert one == 2 * value, one
    stats = module.twice.stats
    print(sum(stats.cache_misses.values()), sum(stats.cache_hits.values()))
    """
)
MODULE = textwrap.dedent(
    """
    from ratd.base.jit import jit

    @jit
    def inner(x):
        total = x
        for k in range(3):
            total += k * x
        return total / 4

    @jit
    def twice(x):
        return inner(x) * 2 + inner(x) * 0
    """
)


def both(folder, values):
    """Compile in two processes that begin at the same moment: (misses, hits) of each."""
    (folder / "module.py").write_text(MODULE)
    environment = os.environ | {"RATD_CACHE": str(folder / "cache")}
    names = ("first", "second")
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", PROCESS, str(folder), own, other, value],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for own, other, value in zip(names, reversed(names), values, strict=True)
    ]
    said = [process.communicate(timeout=600) for process in processes]
    assert [process.returncode for process in processes] == [0, 0], said
    return [tuple(map(int, out.split())) for out, _ in said]


def test_one_compiles_and_the_other_loads(tmp_path):
    assert sorted(both(tmp_path, ("1.0", "1.0"))) == [(0, 1), (1, 0)]


def test_other_signatures_are_compiled_side_by_side_and_none_is_lost(tmp_path):
    """Which numba's own cache may lose, or write under the name of the other."""
    assert both(tmp_path, ("1.0", "1j")) == [(1, 0), (1, 0)]
    for name in ("first", "second"):
        (tmp_path / name).unlink()
    assert both(tmp_path, ("1.0", "1j")) == [(0, 1), (0, 1)]


def misses_and_hits(checkout, cache):
    """Run one compiled function of a copy of the package: (misses, hits)."""
    program = "from ratd.base import fastmath as m; assert m.__file__.startswith(__import__('sys').argv[1]); "
    program += "assert m.reciprocal(4.0) == 0.25; stats = m.reciprocal.stats; "
    program += "print(sum(stats.cache_misses.values()), sum(stats.cache_hits.values()))"
    environment = os.environ | {"RATD_CACHE": str(cache), "PYTHONPATH": str(checkout)}
    done = subprocess.run(
        [sys.executable, "-c", program, str(checkout)], env=environment, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr
    return tuple(map(int, done.stdout.split()))


def test_checkouts_with_the_same_source_share_the_code_and_others_do_not(tmp_path):
    source = Path(ratd.__file__).parent
    first, second = tmp_path / "first", tmp_path / "elsewhere" / "second"
    for checkout in (first, second):
        shutil.copytree(source, checkout / "ratd", ignore=shutil.ignore_patterns("__pycache__"))
    assert misses_and_hits(first, tmp_path / "cache") == (1, 0)
    assert misses_and_hits(second, tmp_path / "cache") == (0, 1)
    # a file that the function does not stand in
    with open(second / "ratd" / "engine" / "layout.py", "a") as file:
        file.write("\nNEW = 1\n")
    assert misses_and_hits(second, tmp_path / "cache") == (1, 0)
    assert misses_and_hits(first, tmp_path / "cache") == (0, 1)


def test_one_that_dies_while_it_compiles_keeps_nobody_waiting(tmp_path):
    lock = tmp_path / "a.lock"
    holds = "import sys; from ratd.base import own_cache; from pathlib import Path; "
    holds += "own_cache._take(Path(sys.argv[1])); print('held', flush=True); sys.stdin.read()"
    process = subprocess.Popen(
        [sys.executable, "-c", holds, str(lock)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "held\n"
    process.kill()
    process.communicate()
    assert own_cache._take(lock) and own_cache._take(lock)
    own_cache._give(lock)
    assert lock not in own_cache._held


def test_patience_ends(tmp_path, monkeypatch):
    lock = tmp_path / "a.lock"
    holds = "import sys; from ratd.base import own_cache; from pathlib import Path; "
    holds += "own_cache._take(Path(sys.argv[1])); print('held', flush=True); sys.stdin.read()"
    process = subprocess.Popen(
        [sys.executable, "-c", holds, str(lock)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout.readline() == "held\n"
        monkeypatch.setattr(own_cache, "PATIENCE", 0.2)
        assert not own_cache._take(lock)
    finally:
        process.communicate("")
    assert own_cache._take(lock)
    own_cache._give(lock)


def test_where_nothing_can_be_written_each_is_on_its_own(tmp_path):
    (tmp_path / "file").touch()
    assert not own_cache._take(tmp_path / "file" / "a.lock")
