"""Templates of documents: slots, errors, verdicts, parts; the command of a document."""

import math

import pytest

from ratd.base.errors import FileError, InputError
from ratd.base.measured import Measured
from ratd.pipeline.documents import command, fill


def test_slots_are_filled():
    values = {"a": 0.12345, "b": Measured(1.5, 0.25), "c": "ice", "d": 3e-6, "e": Measured(2.0), "n": 7}
    text = "{{a:.2f}} {{ b:.2f± }} {{b:.1f}} {{c}} {{d:.1e}} {{e:.0f±}} {{n}} {{a:.0%}}"
    assert fill(text, values) == "0.12 1.50 ± 0.25 1.5 ice 3.0·10⁻⁶ 2 7 12%"


def test_an_error_is_never_rounded_to_nothing():
    values = {
        "a": Measured(1.6988, 0.0003),
        "b": Measured(0.0, 0.0),
        "c": Measured(0.0133, 0.0002),
        "d": Measured(3, 1e-9),
    }
    assert fill("{{a:.3f±}} {{a:.2f±}} {{b:.1%±}} {{c:.1%±}} {{d:.2f±}}", values) == (
        "1.6988 ± 0.0003 1.6988 ± 0.0003 0 1.33% ± 0.02% 3.00 ± 0.00"
    )


def test_a_verdict_that_flips_is_an_error():
    assert fill("It {{line=holds}}.", {"line": "holds"}) == "It holds."
    with pytest.raises(InputError, match="the verdict line is 'fails', but the template says 'holds'"):
        fill("It {{line=holds}}.", {"line": "fails"})


def test_a_number_below_0_has_a_minus_sign():
    assert fill("{{a:.1f}} {{b:.1e}}", {"a": -1.5, "b": -3e6}) == "−1.5 −3.0·10⁶"
    assert fill("{{a:.1f}} {{a:.0%}}", {"a": -1e-4}) == "0.0 0%"


@pytest.mark.parametrize(("value", "said"), [({}, "has no value"), ({"a": math.nan}, "is nan, no finite number")])
def test_what_cannot_be_filled_is_one_sentence(value, said):
    with pytest.raises(InputError, match=said):
        fill("{{a:.2f}}", value)


TEXT = "X is {{X of a}}, N is {{ N }} and again {{X of a}}; {{later | not yet computed}}."


def test_slots_with_words_of_their_own_need_no_value():
    assert fill(TEXT, {"X of a": "0.5", "N": "3", "more": "7"}) == "X is 0.5, N is 3 and again 0.5; not yet computed."
    assert fill(TEXT, {"X of a": "0.5", "N": "3", "later": "8"}).endswith("; 8.")


def test_a_slot_without_a_value_is_named():
    with pytest.raises(InputError, match="page.md: the slot 'N' has no value; 1 slots have none"):
        fill(TEXT, {"X of a": "0.5"}, "page.md")


PARTS = """\
<!-- if a -->
A
<!-- if not b -->
no B
<!-- end -->
<!-- end -->
<!-- if b -->
B
<!-- if a -->
both
<!-- end -->
<!-- end -->
"""


@pytest.mark.parametrize(
    ("names", "left"), [(["a.x"], "A\nno B\n"), (["b.x"], "B\n"), (["a.x", "b.x"], "A\nB\nboth\n"), (["a"], "")]
)
def test_parts_stand_where_there_are_data_of_their_name(names, left):
    """A value of just this name is no data of it."""
    assert fill(PARTS, dict.fromkeys(names, 1)) == left


@pytest.mark.parametrize(
    ("text", "said"), [("<!-- if a -->\n", "'if' without an 'end'"), ("<!-- end -->\n", "'end' without an 'if'")]
)
def test_a_part_without_one_of_its_ends_is_an_error(text, said):
    with pytest.raises(InputError, match=said):
        fill(text, {})


def test_the_command_of_a_document_collects_or_redraws(capsys):
    def fails():
        raise FileError("x.nc: is not there")

    done = []
    assert command(["collect", "results"], "How.", done.append, fails) == 0 and done == ["results"]
    assert command(["redraw"], "How.", done.append, fails) == 1
    assert command(["draw"], "How.", done.append, fails) == 2
    said = capsys.readouterr()
    assert said.err == "x.nc: is not there\n" and said.out == "How.\n"
