"""Pages as a browser shows them: what Markdown would take for a tag, or for the end of a list, is lost or misleads."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [*sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "docs/model").glob("*.md")), ROOT / "config/README.md"]


def tags(text):
    """What stands in angle brackets outside of code and formulae."""
    for code in (r"```.*?```", r"^ {4}.*?$", r"`[^`]*`", r"\$[^$]*\$"):
        text = re.sub(code, "", text, flags=re.DOTALL | re.MULTILINE)
    return re.findall(r"<[A-Za-z/][^>]*>", text)


def tables_that_end_a_list(text):
    """Rows of tables below an item of a numbered list that do not stand 4 deep: the next item would be the first."""
    found, numbered = [], False
    for line in text.splitlines():
        if re.match(r"\d+\. ", line):
            numbered = True
        elif line and not line.startswith(" "):
            numbered = False
        elif numbered and re.match(r" {1,3}\|", line):
            found.append(line)
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_nothing_is_taken_for_a_tag(page):
    assert tags(page.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_numbered_lists_go_on_behind_a_table(page):
    assert tables_that_end_a_list(page.read_text(encoding="utf-8")) == []


def test_what_a_browser_would_lose_is_found():
    assert tags("the mean radius <a> and `x<y>` and $<r>$ of 3 < 4 > 2\n\n    <code>\n") == ["<a>"]
    lost = "1. one\n   two\n\n   | a |\n   |---|\n2. three\n\n    | b |\n\ntext\n   | c |\n"
    assert tables_that_end_a_list(lost) == ["   | a |", "   |---|"]
