"""The first error of a run of the pipeline, kept for the end, where a reader looks.

Many jobs may fail for one reason, each with pages of Snakemake's own, and on a full disk no job can write why. So the
room for one sentence is taken while there is still some.
"""

import fcntl
import os
import sys
from contextlib import suppress
from pathlib import Path

ROOM = 2000
"""Bytes."""
PLACE = Path(".snakemake", "ratd.first_error")


def begin(place=PLACE):
    """Make room for the first error of a run, and forget an older one."""
    place = Path(place)
    place.parent.mkdir(exist_ok=True)
    with open(place, "wb") as file:
        file.write(b" " * ROOM)
        file.flush()
        os.fsync(file.fileno())


def keep(sentence, place=PLACE):
    """Keep a sentence, if it is the first since `begin`. Never fails."""
    with suppress(OSError), open(place, "r+b") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        if not file.read(ROOM).strip():
            file.seek(0)
            file.write(sentence.replace("\n", " ").encode()[:ROOM])


def tell_again(place=PLACE):
    """Print the sentence, if there is one."""
    if sentence := kept(place):
        print(sentence, file=sys.stderr)


def kept(place=PLACE):
    """The sentence, or an empty text."""
    try:
        return Path(place).read_bytes().decode(errors="ignore").strip()
    except OSError:
        return ""
