"""Source hashes: what they follow, what they leave out."""

import re
import tokenize
from io import StringIO

import pytest

from ratd.base.errors import InputError
from ratd.pipeline.provenance import (
    PLUMBING,
    closure,
    essential_text,
    file_hash,
    imported_modules,
    module_files,
    provenance,
    settings_hash,
    source_hash,
)
from tiny_pipeline import ROOT

SCRIPTS = ROOT / "workflow" / "scripts"


@pytest.fixture
def package(tmp_path):
    """A small package in ratd's place: top -> middle -> low, and a sub-package with a relative import."""
    root = tmp_path / "ratd"
    (root / "sub").mkdir(parents=True)
    (root / "__init__.py").write_text("")
    (root / "top.py").write_text("from ratd.middle import f\n")
    (root / "middle.py").write_text("def f():\n    from ratd import low\n    return low.g()\n")
    (root / "low.py").write_text("def g():\n    return 1\n")
    (root / "other.py").write_text("import ratd.sub.leaf\n")
    (root / "sub" / "__init__.py").write_text("from .leaf import h\n")
    (root / "sub" / "leaf.py").write_text("from .. import low\nfrom . import twig\n\n\ndef h():\n    return low.g()\n")
    (root / "sub" / "twig.py").write_text("")
    return root


def test_closure_follows_imports_wherever_they_stand(package):
    assert closure(["ratd.top"], package) == ["ratd.low", "ratd.middle", "ratd.top"]


@pytest.mark.parametrize(
    "head",
    [
        "if x:",
        "if x:\n    pass\nelse:",
        "for x in y:\n    pass\nelse:",
        "while x:",
        "with x:",
        "try:\n    pass\nexcept ValueError:",
        "try:\n    pass\nfinally:",
        "match x:\n  case 1:",
        "async def f():",
        "class A:",
    ],
)
def test_imports_are_found_and_texts_left_out_in_every_kind_of_block(head):
    source = f"{head}\n    import ratd.base.units\n"
    assert imported_modules(source) == {"ratd", "ratd.base", "ratd.base.units"}
    assert essential_text(f'{head}\n    """Text."""\n    import ratd.base.units\n') == essential_text(source)


def test_closure_follows_relative_imports_and_packages(package):
    found = closure(["ratd.other"], package)
    assert found == ["ratd.low", "ratd.other", "ratd.sub", "ratd.sub.leaf", "ratd.sub.twig"]


def test_closure_of_two_modules_that_import_each_other_ends(package):
    (package / "low.py").write_text("import ratd.top\n")
    assert closure(["ratd.top"], package) == ["ratd.low", "ratd.middle", "ratd.top"]


def test_closure_leaves_plumbing_out_and_does_not_follow_it(package):
    (package / "pipeline").mkdir()
    (package / "pipeline" / "__init__.py").write_text("")
    (package / "pipeline" / "io.py").write_text("import ratd.sub.twig\n")
    (package / "top.py").write_text("from ratd.pipeline import io\n")
    assert closure(["ratd.top"], package) == ["ratd.top"]


def test_unknown_module_is_named(package):
    with pytest.raises(InputError, match="ratd.nothing"):
        closure(["ratd.nothing"], package)


def test_hash_changes_with_what_is_imported_and_with_nothing_else(package):
    before = source_hash(modules=["ratd.top"], root=package)
    (package / "sub" / "leaf.py").write_text("def h():\n    return 5\n")
    (package / "low.py").touch()
    assert source_hash(modules=["ratd.top"], root=package) == before
    (package / "low.py").write_text("def g():\n    return 2\n")
    assert source_hash(modules=["ratd.top"], root=package) != before


def test_hash_of_a_script_follows_its_imports_and_its_text(package, tmp_path):
    script = tmp_path / "script.py"
    script.write_text("from ratd.top import f\n\nf()\n")
    before = source_hash(script, root=package)
    (package / "low.py").write_text("def g():\n    return 2\n")
    after = source_hash(script, root=package)
    assert after != before
    script.write_text("from ratd.top import f\n\nf(2)\n")
    assert source_hash(script, root=package) != after
    assert source_hash(script, root=package, extra=["more"]) != source_hash(script, root=package)


def test_comments_docstrings_and_blank_lines_do_not_count():
    plain = 'A = "# no comment"\ndef f(x):\n    return x\nclass B:\n    c = """text\n\nin lines"""\n'
    explained = (
        '"""Module."""\n\n# a remark\nA = "# no comment"  # another\n"""About A."""\n\n\ndef f(x):\n    """Doc\n    of'
        ' f.\n    """\n    # why\n    return x\n\n\nclass B:\n    """B."""\n\n    c = """text\n\nin lines"""\n'
    )
    assert essential_text(explained) == essential_text(plain)


def tokenized(source):
    """Source without comments and the lines that they leave blank, by Python's own tokens; docstrings stay."""
    lines, left_out = source.splitlines(), set()
    for token in tokenize.generate_tokens(StringIO(source).readline):
        row, column = token.start[0] - 1, token.start[1]
        if token.type == tokenize.COMMENT:
            lines[row] = lines[row][:column].rstrip()
        if token.type == tokenize.NL and not lines[row].strip():
            left_out.add(row)
    return "\n".join(line for row, line in enumerate(lines) if row not in left_out)


NASTY = r"""
A = 'it\'s # none'  # 'one
B = r"\" # none"  # "two
C = f"{A[0]} # none"  # three
D = '#' '''  # none

# none of \''' either '''  # four
E = (
    1,  # five

    # six
    2,
)
F = 1 + \
    2  # seven
"""


@pytest.mark.parametrize("folder", ["src", "tests"])
def test_comments_are_those_that_python_sees(folder):
    for path in (ROOT / folder).rglob("*.py"):
        source = path.read_text()
        assert essential_text(source) == essential_text(tokenized(source)), path


def test_comments_beside_every_kind_of_string_are_those_that_python_sees():
    compile(NASTY, "nasty", "exec")
    assert essential_text(NASTY) == tokenized(NASTY)
    assert not re.search("'one|two|three|four|five|six|seven", essential_text(NASTY))
    assert essential_text(NASTY).count("# none") == 5


@pytest.mark.parametrize(
    "other",
    ["A = 2\n", "A = 1\nB = 1\n", 'A = 1\nf("text")\n', 'A = 1\nif A:\n    B = "x"\n'],
)
def test_statements_do_count(other):
    assert essential_text(other) != essential_text("A = 1\n")


def test_text_within_a_string_counts():
    assert essential_text('A = """x\n\n# y\n"""\n') != essential_text('A = """x\n"""\n')


def test_imported_modules_tells_modules_from_names():
    found = imported_modules("from ratd.base.errors import FileError\nimport numpy\nfrom ratd.base import units\n")
    assert found == {"ratd", "ratd.base", "ratd.base.errors", "ratd.base.units"}
    assert "ratd.base.errors.InputError" not in module_files() and "ratd.Errors" not in module_files()


def test_plumbing_exists():
    assert set(PLUMBING) <= module_files().keys()


def test_a_page_beside_a_module_is_part_of_its_source(package):
    before = source_hash(modules=["ratd.top"], root=package)
    (package / "low.html").write_text("<p>")
    after = source_hash(modules=["ratd.top"], root=package)
    (package / "low.html").write_text("<b>")
    assert len({before, after, source_hash(modules=["ratd.top"], root=package)}) == 3


SPIN_UP = "ratd.experiments.spin_up"
COMPILED = {"ratd.laws.jkr_with_springs", "ratd.engine", f"{SPIN_UP}.run"}


@pytest.mark.parametrize(
    ("module", "contains", "lacks"),
    [
        ("grow", {"ratd.aggregates.growth", "ratd.aggregates.grain", "ratd.geometry.shape"}, COMPILED),
        ("spin", {f"{SPIN_UP}.run", "ratd.laws.jkr_with_springs", "ratd.engine"}, {"ratd.aggregates.growth"}),
        ("disrupt", {f"{SPIN_UP}.marks"}, COMPILED),
        ("tables", {f"{SPIN_UP}.eq33"}, COMPILED),
        ("figures.figure7", {f"{SPIN_UP}.eq33", "ratd.pictures.style"}, COMPILED | {f"{SPIN_UP}.figures.figure8"}),
    ],
)
def test_stages_depend_on_what_they_should(module, contains, lacks):
    found = set(closure([f"{SPIN_UP}.{module}"]))
    assert contains <= found
    assert not lacks & found


def test_every_script_imports_what_it_hashes():
    # `import ratd` alone would reach the library without being seen
    for script in SCRIPTS.glob("*.py"):
        assert "ratd.pipeline.jobs" in imported_modules(script.read_text()), script.name
        assert "import ratd\n" not in script.read_text()


def test_settings_hash_depends_on_content_alone():
    assert settings_hash({"a": 1, "b": [1.5, None]}) == settings_hash({"b": [1.5, None], "a": 1})
    assert settings_hash({"a": 1}) != settings_hash({"a": 2})


def test_provenance_names_source_settings_inputs_and_versions(tmp_path):
    file = tmp_path / "input"
    file.write_text("x")
    attributes = provenance("0123", {"b": 1, "a": 2.5}, [file])
    assert attributes["code_hash"] == "0123"
    assert attributes["settings"] == '{"a":2.5,"b":1}'
    assert attributes["settings_hash"] == settings_hash({"a": 2.5, "b": 1})
    assert attributes["input_hash"] == file_hash(file)
    assert "numba" in attributes["versions"] and str(tmp_path) not in str(attributes)
    file.write_text("y")
    assert provenance("0123", {}, [file])["input_hash"] != attributes["input_hash"]
    assert provenance("0123", {})["input_hash"] == ""


def test_import_of_a_module_that_is_not_there_is_named(package):
    (package / "low.py").write_text("from ratd.none import f\n")
    with pytest.raises(InputError, match="ratd.low imports ratd.none"):
        closure(["ratd.top"], package)
