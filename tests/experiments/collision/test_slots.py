"""Slots of documents."""

import pytest

from ratd.base.errors import InputError
from ratd.experiments.collision.slots import fill, slots

TEXT = "X is {{X of a}}, N is {{ N }} and again {{X of a}}; {{later | not yet computed}}."


def test_slots_are_filled():
    assert slots(TEXT) == ["X of a", "N", "later"]
    assert fill(TEXT, {"X of a": "0.5", "N": "3", "more": "7"}) == "X is 0.5, N is 3 and again 0.5; not yet computed."
    assert fill(TEXT, {"X of a": "0.5", "N": "3", "later": "8"}).endswith("; 8.")


def test_a_slot_without_a_value_is_named():
    with pytest.raises(InputError, match="page.md: the slot 'N' has no value; 1 slots have none"):
        fill(TEXT, {"X of a": "0.5"}, "page.md")
