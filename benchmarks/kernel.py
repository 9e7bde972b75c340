"""Part (a): ns per contact and step beside LAMMPS, alternately on one core, and us per step of ten monomers."""

from benchmarks import engine, grains, peer, tables

MOTIONS = {"at rest": 0.0, "slowly turning": 0.2}
"""Angular velocity in units of the bound at which the aggregate must break."""
TYPES = ("BAM2", "BA")
SMALL = 10
SEED = 0


def aggregates(n, files):
    """Name -> aggregate to measure: grown ones of both types, or those of the files.

    Parameters
    ----------
    n : int
        Number of monomers of those that are grown.
    files : list of pathlib.Path
    """
    if files:
        return {path.stem: grains.read(path) for path in files}
    return {kind: grains.grown(kind, n, SEED) for kind in TYPES}


def measure(out, *, pairs, steps, monomers, small_steps, files, program, about, say):
    """Measure and write ``kernel.csv`` and ``small.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    pairs : int
        Runs of each code, in alternation.
    steps, small_steps : int
        Steps of each run, and of each run with ten monomers.
    monomers : int
        Monomers of the aggregates that are grown.
    files : list of pathlib.Path
        Aggregates to read instead.
    program : str or None
        LAMMPS.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.
    """
    rows = []
    for name, grain in aggregates(monomers, files).items():
        classes = None
        for motion, part in MOTIONS.items():
            body, _ = engine.timed(engine.turning(grain, part), steps // 10)  # also compiles
            if program and classes is None:
                classes = peer.best_classes(program, grain, timestep=body.timestep, steps=min(steps, peer.TRIAL_STEPS))
            for pair in range(pairs):
                before = body.contacts
                body, seconds = engine.timed(body, steps)
                rows.append(
                    _row(name, motion, grain, "ratd", "", 0, pair, steps, before, body.contacts, seconds) | about
                )
                if program:
                    timing = peer.run(
                        program, grain, omega=body.omega, timestep=body.timestep, steps=steps, warm=steps // 10,
                        classes=classes,
                    )  # fmt: skip
                    rows.append(
                        _row(
                            name, motion, grain, "LAMMPS", timing.version, classes, pair, steps,
                            timing.contacts_before, timing.contacts, timing.seconds,
                        ) | about
                    )  # fmt: skip
                latest = rows[-1 - bool(program) :]
                latest = ", ".join(f"{row['code']} {row['ns_per_contact_step']:.1f}" for row in latest)
                say(f"kernel: {name} {motion}, pair {pair + 1} of {pairs}: {latest} ns per contact and step")
    tables.write(out / "kernel.csv", rows)

    rows = []
    for kind in TYPES:
        grain = grains.grown(kind, SMALL, SEED)
        for motion, part in MOTIONS.items():
            body, _ = engine.timed(engine.turning(grain, part), small_steps // 10)
            for pair in range(pairs):
                before = body.contacts
                body, seconds = engine.timed(body, small_steps)
                rows.append(
                    _row(kind, motion, grain, "ratd", "", 0, pair, small_steps, before, body.contacts, seconds) | about
                )
            say(f"kernel: {SMALL} monomers, {kind} {motion}: {rows[-1]['us_per_step']:.2f} us per step")
    tables.write(out / "small.csv", rows)


def _row(name, motion, grain, code, version, classes, pair, steps, before, contacts, seconds):
    return {
        "aggregate": name,
        "motion": motion,
        "code": code,
        "version": version,
        "size_classes": classes,
        "pair": pair,
        "monomers": grain.n_monomers,
        "contacts_before": before,
        "contacts": contacts,
        "steps": steps,
        "seconds": seconds,
        "us_per_step": seconds / steps * 1e6,
        "ns_per_contact_step": seconds / steps / contacts * 1e9,
    }
