"""The length of the step: shortened while something is fast, and back afterwards."""

import numpy as np

from ratd.base.materials import MATERIALS
from ratd.drives.free import rest
from ratd.engine.layout import DT, DT_CONTACTS, FASTEST, STEPS
from ratd.engine.leapfrog import GROW_EVERY, leapfrog
from ratd.engine.state import new_state
from ratd.engine.step import run, until
from ratd.geometry.box import open_space
from ratd.laws import jkr
from systems import rest_distance


def test_a_step_shortened_by_a_fast_sphere_grows_back_when_it_is_slow():
    size, law, box, integrator = 30e-9, jkr(), open_space(), leapfrog()
    x = rest_distance(size, size, "q-S")
    position = np.array([[0.0, 0.0, 0.0], [x, 0.0, 0.0], [0.0, 400e-9, 0.0]])
    velocity = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 3000.0, 0.0]])
    state = new_state(
        position, np.full(3, size), MATERIALS["q-S"], np.array([[0, 1]]), law, box, integrator, velocity=velocity
    )
    allowed = state.scalar[DT]
    assert state.scalar[DT_CONTACTS] == allowed
    drag = rest(1.0 / (200 * allowed))
    steps, fastest = [], []
    for goal in range(1, 2000):
        state, _ = run(state, law, drag, box, integrator, until(steps=goal))
        assert state.counter[STEPS] == goal
        steps.append(state.scalar[DT])
        fastest.append(state.scalar[FASTEST])
    steps, fastest = np.array(steps), np.array(fastest)
    farthest = integrator.timestep_factor * size
    assert (fastest * steps <= farthest * (1 + 1e-12)).all()
    assert steps[0] < 0.5 * allowed
    assert steps[-1] == allowed
    grown = np.flatnonzero(np.diff(steps) > 0) + 2  # steps made by then
    assert len(grown) > 2 and (grown % GROW_EVERY == 0).all()
