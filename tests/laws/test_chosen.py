"""The law that a user means: by its name, with its options, or one that the step does not know."""

import pytest

import ratd
from ratd.base.errors import InputError
from ratd.laws.chosen import law_of

PAIR = ratd.Grain([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9] * 2, "q-S")


def test_a_law_has_a_name():
    assert law_of("jkr", ratd.laws.dmt) == ratd.laws.jkr() and law_of(None, ratd.laws.dmt) == ratd.laws.dmt()
    assert law_of(ratd.laws.dmt(friction="none"), None) == ratd.laws.dmt(friction="none")


@pytest.mark.parametrize(
    "call",
    [
        lambda law: ratd.evolve(PAIR.position, PAIR.radius, material="q-S", duration=1e-10, law=law),
        lambda law: ratd.spin_up(PAIR, law=law),
        lambda law: ratd.compress(PAIR, 1e-4, 0.3, law=law),
        lambda law: ratd.collide(PAIR, PAIR, 1.0, law=law),
    ],
    ids=["evolve", "spin_up", "compress", "collide"],
)
@pytest.mark.parametrize("law", ["hertz", 3, "JKR"])
def test_another_law_is_refused_in_one_sentence(call, law):
    with pytest.raises(InputError, match=f"law is {law!r}; allowed are 'dmt', 'jkr', or a law of"):
        call(law)


@pytest.mark.parametrize(
    ("call", "instead"),
    [
        (lambda law: ratd.spin_up(PAIR, law=law), "give epsilon"),
        (lambda law: ratd.compress(PAIR, 1e-4, 0.3, law=law), "give long_steps=None"),
    ],
    ids=["spin_up", "compress"],
)
def test_a_law_without_stiffness_is_told_which_step_it_may_take(call, instead):
    with pytest.raises(InputError, match=f"law is DMT, which does not tell its stiffness, .*; {instead}"):
        call("dmt")


def test_what_was_compressed_under_a_law_is_pulled_under_it():
    cluster = ratd.grow_bcca(16, "ice", seed=3)
    run = ratd.compress(cluster, 1e-3, 0.2, law="dmt", long_steps=None, balance=False)
    with pytest.raises(InputError, match=r"law is JKR\(.*it must be that of the compression, DMT\("):
        ratd.stretch(run, 1e-3)
