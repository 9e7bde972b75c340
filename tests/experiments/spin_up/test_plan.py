"""The config: what is refused, with which words, and what follows from what is accepted."""

import re
from pathlib import Path

import pytest

from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up.how import STRETCH, TIMESTEP_FACTOR
from ratd.experiments.spin_up.plan import COMMON_FIGURES, FIGURES, check, load
from ratd.experiments.spin_up.seeds import size_label
from ratd.experiments.spin_up.spin import arguments
from ratd.pipeline import config as configs
from ratd.pipeline.config import merge
from tiny_pipeline import ROOT

PARTS = ("materials", "types", "sizes_nm", "seeds", "block_size", "small_grains", "growth", "drives", "run", "literal")
PARTS += ("snapshots", "ensemble", "figures")
PACE = {"angular_acceleration": 1e15, "timestep_factor": 0.1}
"""Of a run of the calibration."""
DEFAULT, QUICK = (ROOT / "config" / "config.yaml", ROOT / "config" / "spin_up.yaml"), ROOT / "config" / "quick.yaml"
SHARED = ("results", "materials_file")
CELL = {"material": "q-S", "size_nm": 50, "seed": 0}
SMALL = CELL | {"type": "BA"}


@pytest.fixture(autouse=True)
def in_root(monkeypatch):
    monkeypatch.chdir(ROOT)


def with_changes(changes):
    """Plan of the config as it comes, with keys of the spin-up replaced, or shared ones."""
    shared = {key: changes[key] for key in SHARED if key in changes}
    own = {key: value for key, value in changes.items() if key not in SHARED}
    return check(merge(configs.load(*DEFAULT), shared | {"spin_up": own}))


def test_default_is_the_full_paper():
    plan = load(*DEFAULT)
    assert len(plan.cells) * len(plan.seeds) == 2970
    assert plan.config["materials"] == ["a-C", "q-S", "co-S"]
    assert plan.sizes == [str(size) for size in range(550, 0, -50)]
    assert plan.config["drives"] == ["prescribed"]
    assert plan.figures == list(FIGURES) and plan.common_figures == list(COMMON_FIGURES)


def test_quick_is_three_of_each():
    plan = load(*DEFAULT, QUICK)
    assert (len(plan.config["materials"]), len(plan.config["types"]), len(plan.sizes), len(plan.seeds)) == (3, 3, 3, 3)
    assert plan.results != load(*DEFAULT).results


@pytest.mark.parametrize(
    ("changes", "key", "allowed"),
    [
        ({"materials": ["x-S"]}, "materials[0] is 'x-S'", "a-C, q-S"),
        ({"materials": []}, "materials is []", "at least one"),
        ({"materials": "q-S"}, "materials is 'q-S'", "a list"),
        ({"run": {"law": {"normal_force": "Hertz"}}}, "run.law.normal_force is 'Hertz'", "JKR or DMT"),
        ({"run": {"law": {"formulae": "own"}}}, "run.law.formulae is 'own'", "printed"),
        ({"literal": {"law": {}}}, "literal.law is {}", "or null for the law of the model"),
        ({"types": ["BA", "BAM3"]}, "types[1] is 'BAM3'", "BA, BAM1 or BAM2"),
        ({"sizes_nm": [50, -50]}, "sizes_nm[1] is -50", "above 0"),
        ({"sizes_nm": [0]}, "sizes_nm[0] is 0", "above 0"),
        ({"types": ["BA"], "sizes_nm": [12]}, "sizes_nm[0] is 12", "above 12.6 nm"),
        ({"sizes_nm": [50, 5000]}, "sizes_nm[1] is 5000", "at most 4089 nm"),
        ({"sizes_nm": [50, 50.0001]}, "sizes_nm[1] is 50.0001, which is within a picometre", "differ by more"),
        (
            {"sizes_nm": [61], "types": ["BA"], "growth": {"smallest_nm": 40, "largest_nm": 41}},
            "sizes_nm[0] is 61: a_eff is",
            "wider range of radii",
        ),
        ({"growth": {"sigma_ln": 3.0}}, "growth.sigma_ln is 3.0", "at most 2.5"),
        (
            {"literal": {"angular_acceleration": "1.25e14"}},
            "is '1.25e14' (text for YAML; as a number it is written 125000000000000.0)",
            "allowed: a number above 0",
        ),
        ({"literal": {"angular_acceleration": "1e22"}}, "as a number it is written 1.0e+22", "a number above 0"),
        ({"literal": {"angular_acceleration": "nan"}}, "angular_acceleration is 'nan'; allowed", "a number above 0"),
        ({"sizes_nm": [50, 50]}, "sizes_nm is [50, 50]", "different"),
        ({"sizes_nm": [float("nan")]}, "sizes_nm[0] is nan", "finite"),
        ({"block_size": 0}, "block_size is 0", "1 or more"),
        ({"block_size": 10.0}, "block_size is 10.0", "whole number"),
        ({"small_grains": {"up_to_nm": 200, "block_size": 0}}, "small_grains.block_size is 0", "1 or more"),
        ({"block_size": True}, "block_size is True", "whole number"),
        ({"seeds": {"number": 0}}, "seeds.number is 0", "1 or more"),
        ({"seeds": {"first": -1}}, "seeds.first is -1", "0 or more"),
        ({"seeds": {"fewer": [{"number": -1}]}}, "seeds.fewer[0].number is -1", "0 or more"),
        ({"seeds": {"fewer": [{"number": 31}]}}, "seeds.fewer[0].number is 31", "0 to 30"),
        ({"seeds": {"fewer": [{"types": ["BA"]}]}}, "seeds.fewer[0].number is missing", "0 or more"),
        ({"seeds": {"fewer": [{"size": [50], "number": 1}]}}, "the key 'size' in spin_up.seeds.fewer[0]", "sizes_nm"),
        ({"seeds": {"fewer": [{"sizes_nm": [75], "number": 1}]}}, "seeds.fewer[0].sizes_nm[0] is 75", "550"),
        ({"seeds": {"fewer": [{"drives": ["literal"], "number": 1}]}}, "seeds.fewer[0].drives[0]", "prescribed"),
        ({"seeds": {"fewer": [{"number": 0}]}, "snapshots": {"grains": []}}, "fewer leaves no grain", "at least one"),
        (
            {
                "seeds": {"fewer": [{"types": ["BAM2"], "number": 0}]},
                "figures": {"figure4": {"size_nm": 50}, "figure5": None},
            },
            "figures.figure4 is a cell that seeds.fewer leaves out",
            "or null",
        ),
        (
            {"seeds": {"fewer": [{"sizes_nm": [50], "number": 0}]}, "snapshots": {"grains": [SMALL]}, "figures": None},
            "snapshots.grains[0].seed is 0",
            "seeds.fewer leaves the cell out",
        ),
        (
            {
                "drives": ["prescribed", "literal"],
                "seeds": {"first": 3, "fewer": [{"drives": ["literal"], "number": 2}]},
            }
            | {
                "snapshots": {"grains": [{"material": "q-S", "type": "BAM2", "size_nm": 500, "seed": 6}]},
                "figures": {"figure1": None, "figure5": {"seed": 6}},
            },
            "figures.figure5.seed (drive literal) is 6",
            "3 to 4",
        ),
        ({"seed": 3}, "the key 'seed' in spin_up is unknown", "seeds"),
        ({"run": {"epsilom": 1}}, "the key 'epsilom' in spin_up.run is unknown", "epsilon"),
        ({"run": {"epsilon": "1e-2"}}, "spin_up.run.epsilon is '1e-2'", "a number above 0"),
        ({"run": {"epsilon": 0}}, "spin_up.run.epsilon is 0", "above 0"),
        ({"run": {"epsilon": {"BAM2": 2}}}, "spin_up.run.epsilon.BAM2 is 2", "above 0 and at most 1"),
        ({"run": {"epsilon": {"BAM3": 0.1}}}, "the key 'BAM3' in spin_up.run.epsilon is unknown", "BA, BAM1, BAM2"),
        ({"literal": {"epsilon": {"BA": 0.1}, "angular_acceleration": None}, "drives": ["literal"]}, "BAM1", "null"),
        ({"run": None}, "spin_up.run is None", "a mapping"),
        (
            {"run": {"angular_acceleration": 1e14}},
            "run give {'stretch': 2e-14, 'epsilon': None, 'angular",
            "null for the others",
        ),
        ({"drives": ["literal"], "literal": {"angular_acceleration": None}}, "run and literal together", "null"),
        ({"drives": ["radiation"]}, "drives[0] is 'radiation'", "torque"),
        (
            {"run": {"stretch": None, "epsilon": 0.1}, "drives": ["torque"]},
            "for the drive torque",
            "a number for stretch",
        ),
        ({"literal": {"stretch": 1e-14}, "drives": ["literal"]}, "for the drive literal", "null for stretch"),
        ({"growth": {"largest_nm": 5}}, "growth", "smallest must be below largest"),
        ({"snapshots": {"grains": [CELL]}}, "snapshots.grains[0].type is missing", "BA, BAM1"),
        ({"sizes_nm": [50, 50.0000000000001]}, "sizes_nm[1] is 50.0000000000001, which is the size 50", "different"),
        ({"seeds": {"first": 2**31}}, "seeds.first is 2147483648", "at most 2147483647"),
        ({"seeds": {"number": 10**6}}, "seeds.number is 1000000", "at most 100000"),
        ({"results": "/"}, "results is '/'", "the path of a folder"),
        ({"results": "."}, "results is '.'", "the path of a folder"),
        ({"results": ".."}, "results is '..'", "the path of a folder"),
        ({"results": "results/../src"}, "results is 'results/../src'", "the path of a folder"),
        ({"results": "docs/reproduction"}, "results is 'docs/reproduction'", "the path of a folder"),
        ({"results": ".snakemake"}, "results is '.snakemake'", "the path of a folder"),
        ({"results": str(Path.home())}, f"results is '{Path.home()}'", "the path of a folder"),
        (
            {"snapshots": {"grains": [{"material": "q-S", "type": "BA", "size_nm": 50, "seed": 30}]}},
            "snapshots.grains[0].seed is 30",
            "0 to 29",
        ),
        ({"figures": {"figure4": {"size_nm": 75}}}, "figures.figure4.size_nm is 75", "one of the sizes_nm, 50"),
        ({"figures": {"figure6": {"material": "ice"}}}, "figures.figure6.material is 'ice'", "a-C, q-S, co-S"),
        ({"figures": {"figure5": {"seed": 3}}}, "figures.figure5 is", "one of snapshots.grains"),
        ({"figures": {"figure1": {"seed": 99}}}, "figures.figure1.seed is 99", "0 to 29"),
        ({"figures": {"figure8": {"scaled_at_nm": 75}}}, "figures.figure8.scaled_at_nm is 75", "the sizes_nm, 50"),
        ({"figures": {"figure10": {"damped": {"epsilon": 2}}}}, "figures.figure10.damped.epsilon is 2", "at most 1"),
        (
            {"figures": {"figure9": {"types": ["BAM1"], "material": "ice"}}},
            "figures.figure9.material is 'ice'",
            "a-C, q-S",
        ),
        ({"figures": {"figure9": {"sizes_nm": [75]}}}, "figures.figure9.sizes_nm[0] is 75", "one of the sizes_nm, 50"),
        ({"figures": {"figure9": {"T_vis_ps": [0]}}}, "figures.figure9.T_vis_ps[0] is 0", "above 0"),
        (
            {"figures": {"figure9": {"literal": {"sizes_nm": [100, 75]}}}},
            "figures.figure9.literal.sizes_nm[1] is 75",
            "one of the sizes_nm, 50",
        ),
        (
            {"figures": {"figure9": {"literal": {"timestep_factor": 2}}}},
            "figures.figure9.literal.timestep_factor is 2",
            "at most 1",
        ),
        ({"figures": {"calibration": {"size_nm": 75}}}, "figures.calibration.size_nm is 75", "one of the sizes_nm, 50"),
        (
            {"figures": {"formulae": {"sizes_nm": [75]}}},
            "figures.formulae.sizes_nm[0] is 75",
            "one of the sizes_nm, 50",
        ),
        ({"figures": {"formulae": {"types": ["RA"]}}}, "figures.formulae.types[0] is 'RA'", "BA, BAM1 or BAM2"),
        ({"figures": {"calibration": {"reach": 0}}}, "figures.calibration.reach is 0", "above 0"),
        (
            {"figures": {"calibration": {"runs": [{"angular_acceleration": 1e15}]}}},
            "the key spin_up.figures.calibration.runs[0].timestep_factor is missing",
            "at most 1",
        ),
        (
            {"figures": {"calibration": {"runs": [PACE, PACE | {"reach": 0.8}]}}},
            "figures.calibration.runs[1] has the angular_acceleration and timestep_factor of an earlier one",
            "each pair once",
        ),
        ({"figures": {"calibration": {"runs": [PACE | {"reach": 0}]}}}, "calibration.runs[0].reach is 0", "above 0"),
        ({"ensemble": {"mean_monomer_radius_nm": ["mine"]}}, "ensemble.mean_monomer_radius_nm[0]", "the word own"),
        ({"results": ""}, "results is ''", "a folder"),
        ({"materials_file": "config/none.yaml"}, "config/none.yaml", "No such file"),
    ],
)
def test_what_is_wrong_is_named_in_one_sentence(changes, key, allowed):
    with pytest.raises(InputError) as error:
        with_changes(changes)
    message = str(error.value)
    assert key in message and allowed in message
    assert "\n" not in message


def test_all_mistakes_are_named_at_once_a_line_each():
    with pytest.raises(InputError) as error:
        with_changes({"block_size": 0, "typos": 1, "seed": 2, "run": {"epsilon": 5}})
    assert str(error.value).splitlines() == [
        "config: the keys seed, typos in spin_up are unknown; allowed: " + ", ".join(PARTS),
        "config: spin_up.block_size is 0; allowed: a whole number of 1 or more",
        *[line for line in str(error.value).splitlines() if line.startswith("config: spin_up.run.epsilon is 5; ")],
    ]
    with pytest.raises(InputError) as error:
        with_changes({"materials": ["x-S", "q-S"], "sizes_nm": [5, 50], "figures": {"figure4": {"size_nm": 75}}})
    keys = [line.split(" is ")[0] for line in str(error.value).splitlines()]
    beginnings = ["materials[0]", "sizes_nm[0]", "sizes_nm[0]", "sizes_nm[0]", "figures.figure4.size_nm"]
    assert keys == [f"config: spin_up.{key}" for key in beginnings]


def test_mistakes_of_all_files_are_named_at_once(tmp_path):
    changes = {"results": "docs", "block_size": 0} | materials_file(tmp_path, "sn.ow: {mix: {a-C: 1.0}}\n")
    with pytest.raises(InputError) as error:
        with_changes(changes)
    said = ("config: spin_up.block_size is 0; ", "config: results is 'docs'; ", "the key 'sn.ow' is no name; ")
    assert len(str(error.value).splitlines()) == 3 and all(words in str(error.value) for words in said)


def test_a_config_says_only_what_it_wants():
    """Of the file that comes with ratd, what names other cells is left out, and said."""
    plan = with_changes({"materials": ["co-S"], "sizes_nm": [100], "seeds": {"number": 5}})
    assert plan.figures == ["figure2", "figure7", "figure8"] and plan.common_figures == ["figure10"]
    assert plan.snapshot_grains == [] and plan.parameter_ways == [] and plan.calibration_labels == []
    left_out = {note.split(" is left out")[0] for note in plan.notes}
    gone = ("figure1", "figure4", "figure5", "figure6", "figure9", "calibration", "formulae")
    assert left_out == {"config: spin_up.snapshots.grains[0]"} | {f"config: spin_up.figures.{name}" for name in gone}
    assert "(figures.figure4.material is 'q-S')" in plan.notes[2]
    # what the user's own file names is not
    with pytest.raises(InputError, match="figures.figure4.material is 'q-S'; allowed: one of the materials, co-S"):
        with_changes({"materials": ["co-S"], "figures": {"figure4": {"size_nm": 50}}})
    assert load(*DEFAULT).notes == load(*DEFAULT, QUICK).notes == []


def test_null_for_all_figures_and_snapshots():
    plan = with_changes({"figures": None, "snapshots": None})
    assert plan.figures == ["figure2", "figure7"] and plan.common_figures == []
    assert plan.spin_up("prescribed", "q-S", "BAM2", "500", "0-9")["snapshot_every"] == 0 and plan.notes == []


def test_sizes_are_the_same_when_their_labels_are():
    plan = with_changes({"sizes_nm": [50.0, 100], "figures": {"figure6": {"sizes_nm": [50, 100.0]}}})
    assert plan.config["figures"]["figure6"] is not None


def test_missing_key_is_named():
    config = configs.load(*DEFAULT)
    with pytest.raises(InputError, match="the key spin_up is missing; allowed: a mapping"):
        check({key: config[key] for key in SHARED})
    del config["spin_up"]["block_size"]
    with pytest.raises(InputError, match="the key spin_up.block_size is missing; allowed: a whole number"):
        check(config)


def test_text_that_is_not_yaml_is_named_with_its_line(tmp_path):
    file = tmp_path / "broken.yaml"
    file.write_text("materials: [a-C\ntypes: [BA]\n")
    for text in ("? [1, 2]\n: a\n", "a: 2001-13-45\n", "a: !foo b\n"):
        (tmp_path / "odd.yaml").write_text(text)
        with pytest.raises(InputError, match=r"odd.yaml: (is not YAML|line 1: could not determine a constructor)"):
            load(tmp_path / "odd.yaml")
    with pytest.raises(InputError, match=r"broken.yaml: line 2: is not YAML"):
        load(file)


def test_a_file_that_is_no_mapping_is_named(tmp_path):
    file = tmp_path / "list.yaml"
    file.write_text("- a-C\n")
    with pytest.raises(InputError, match="list.yaml: is .* a mapping"):
        load(*DEFAULT, file)


def test_later_files_stand_over_earlier_ones_key_by_key():
    merged = merge({"a": {"b": 1, "c": [1, 2]}, "d": 1}, {"a": {"c": [3]}, "e": 2})
    assert merged == {"a": {"b": 1, "c": [3]}, "d": 1, "e": 2}


def test_blocks_cover_all_seeds_once_and_keep_their_bounds_when_seeds_are_added():
    plan = with_changes(
        {
            "seeds": {"first": 5, "number": 7},
            "block_size": 3,
            "snapshots": {"grains": []},
            "figures": {"figure1": None, "figure5": None},
        }
    )
    assert plan.blocks() == ["5-7", "8-10", "11-11"]
    more = with_changes(
        {
            "seeds": {"first": 5, "number": 12},
            "block_size": 3,
            "snapshots": {"grains": []},
            "figures": {"figure1": None, "figure5": None},
        }
    )
    assert more.blocks()[:2] == plan.blocks()[:2]
    assert with_changes({"block_size": 1}).blocks()[-1] == "29-29"
    assert with_changes({"block_size": 100}).blocks() == ["0-29"]


def test_small_grains_have_blocks_of_their_own():
    changes = {"block_size": 10, "small_grains": {"up_to_nm": 200, "block_size": 20}}
    plan = with_changes(changes)
    assert plan.blocks(("q-S", "BA", "200")) == ["0-19", "20-29"]
    assert plan.blocks(("q-S", "BA", "250")) == ["0-9", "10-19", "20-29"]
    assert plan.grown_block(("q-S", "BA", "200"), "20-29") == "20-29"
    assert re.fullmatch(plan.pattern("blocks"), "0-19") and re.fullmatch(plan.pattern("blocks"), "10-19")
    assert with_changes(changes | {"small_grains": None}).blocks(("q-S", "BA", "200")) == ["0-9", "10-19", "20-29"]


FEWER = {
    "small_grains": None,
    "drives": ["prescribed", "literal"],
    "seeds": {
        "number": 12,
        "fewer": [
            {"types": ["BA"], "sizes_nm": [500, 550], "number": 3},
            {"drives": ["literal"], "sizes_nm": [100, 500, 550], "number": 1},
            {"types": ["BA"], "sizes_nm": [550], "number": 0},
        ],
    },
}


def test_later_entries_of_fewer_stand_over_earlier_ones():
    plan = with_changes(FEWER)
    numbers = {
        (drive, size): len(plan.seeds_of(("q-S", "BA", size), drive))
        for drive in ("prescribed", "literal")
        for size in ("550", "500", "100", "50")
    }
    prescribed = {"550": 0, "500": 3, "100": 12, "50": 12}
    literal = {"550": 0, "500": 1, "100": 1, "50": 12}
    assert numbers == {("prescribed", size): n for size, n in prescribed.items()} | {
        ("literal", size): n for size, n in literal.items()
    }
    assert len(plan.seeds_of(("a-C", "BAM2", "550"), "literal")) == 1


def test_fewer_seeds_of_drives_are_counted_from_the_first_seed():
    fewer = [{"number": 2}, {"materials": ["q-S"], "drives": ["literal"], "number": 7}]
    changes = {"seeds": {"first": 5, "number": 12, "fewer": fewer}, "block_size": 5, "snapshots": {"grains": []}}
    figures = {"figure1": None, "figure5": None}
    plan = with_changes(changes | {"small_grains": None, "drives": FEWER["drives"], "figures": figures})
    cell = ("q-S", "BA", "100")
    # the later entry stands over the earlier one also where it has more
    assert plan.seeds_of(cell, "prescribed") == range(5, 7) and plan.seeds_of(cell, "literal") == range(5, 12)
    # what is grown is the most that any drive wants
    assert plan.seeds_of(cell) == range(5, 12) and plan.blocks(cell) == ["5-9", "10-11"]
    assert plan.grown_block(cell, "5-6") == "5-9" and plan.grown_block(cell, "10-14") == "10-11"
    # a grain that no drive wants is in the block of a cell with all seeds
    assert plan.grown_block(cell, "15-16") == "15-16"


def test_grains_are_grown_for_the_drive_that_wants_most_and_shared():
    plan = with_changes(FEWER)
    cell = ("q-S", "BA", "500")
    assert plan.blocks(cell, "prescribed") == ["0-2"] and plan.blocks(cell, "literal") == ["0-0"]
    assert plan.blocks(cell) == ["0-2"] and plan.grown_block(cell, "0-0") == "0-2"
    assert plan.blocks(("q-S", "BA", "50"), "literal") == ["0-9", "10-11"]
    path = "{material}/{type}/{size}/{seeds}"
    assert len(plan.files(path, "prescribed")) == 3 * (3 * 9 * 2 + 2 * 2 * 2 + 1)
    assert len(plan.files(path)) == len(plan.files(path, "prescribed"))
    # of BAM1 and BAM2 at 500 and 550 nm, and of all at 100 nm, literal needs the first block only
    assert len(plan.grown_files(path, "literal")) == 3 * (3 * 8 * 2 + 3 + 2 * 2 + 1)
    assert "q-S/BA/500/0-2" in plan.grown_files(path, "literal")
    assert not [name for name in plan.files(path) if "/BA/550/" in name]
    assert set(plan.pattern("blocks").split("|")) == {"0\\-9", "10\\-11", "0\\-2", "0\\-0"}


def test_figure_1_grows_what_nothing_else_needs():
    plan = with_changes(FEWER | {"figures": {"figure1": {"sizes_nm": [550]}}})
    assert "q-S/BA/550/0-9" in plan.figure1_files("{material}/{type}/{size}/{seeds}")


def test_fewer_seeds_leave_the_jobs_of_other_cells_alone():
    plan, all_seeds = with_changes(FEWER), with_changes({"drives": FEWER["drives"], "seeds": {"number": 12}})
    cell = ("q-S", "BAM2", "350")
    assert plan.blocks(cell, "prescribed") == all_seeds.blocks(cell, "prescribed") == ["0-9", "10-11"]
    assert plan.spin_up("prescribed", *cell, "0-9") == all_seeds.spin_up("prescribed", *cell, "0-9")
    assert plan.grow(*cell) == all_seeds.grow(*cell)


def test_settings_hold_what_a_stage_depends_on_and_nothing_else():
    plan = load(*DEFAULT)
    other = with_changes({"run": {"stretch": 1e-14}, "figures": {"figure6": {"sizes_nm": [50]}}})
    assert other.grow("q-S", "BA", "50") == plan.grow("q-S", "BA", "50")
    assert other.spin_up("prescribed", "q-S", "BA", "50", "0-9") != plan.spin_up("prescribed", "q-S", "BA", "50", "0-9")
    assert other.ensemble("prescribed") == plan.ensemble("prescribed")
    assert other.figure("figure7", "prescribed") == plan.figure("figure7", "prescribed")
    assert other.figure("figure6", "prescribed") != plan.figure("figure6", "prescribed")


def test_settings_are_in_si_units():
    settings = load(*DEFAULT).grow("q-S", "BA", "350")
    assert settings["a_eff"] == pytest.approx(350e-9, rel=1e-15)
    assert settings["radii"]["median"] == pytest.approx(20e-9, rel=1e-15)
    assert settings["material"]["surface_energy"] == MATERIALS["q-S"].surface_energy


def test_drives_have_spin_up_laws_of_their_own():
    plan = with_changes({"drives": ["prescribed", "literal"]})
    prescribed, literal = (plan.spin_up(drive, "q-S", "BA", "50", "0-9") for drive in ("prescribed", "literal"))
    assert (prescribed["stretch"], prescribed["epsilon"]) == (STRETCH, None)
    assert (literal["epsilon"], literal["angular_acceleration"]) == (None, 1.25e14)
    assert prescribed["records"] == literal["records"]


def test_figure9_has_a_pace_of_its_own_for_each_drive():
    own = {"literal": {"angular_acceleration": 3e13, "timestep_factor": 0.04}}
    plan = with_changes({"drives": ["prescribed", "literal"], "figures": {"figure9": own}})
    laws = {drive: plan.parameters(drive, "BA", "100")[0]["spin_up"] for drive in ("prescribed", "literal")}
    names = ("epsilon", "angular_acceleration", "timestep_factor")
    assert [laws["prescribed"][name] for name in names] == [None, None, TIMESTEP_FACTOR]
    assert [laws["literal"][name] for name in names] == [None, 3e13, 0.04]


def test_figure9_may_have_sizes_of_its_own_for_the_literal_drive():
    def sizes(literal, drive):
        own = {"sizes_nm": [100, 150], "literal": literal}
        plan = with_changes({"drives": ["prescribed", "literal"], "figures": {"figure9": own}})
        files = plan.parameter_files("{drive} {type} {size} {label}", drive)
        assert len(files) == len(set(files)) and {file.split()[0] for file in files} == {drive}
        assert "sizes_nm" not in plan.parameters(drive, "BA", "100")[0]["spin_up"]
        return list(dict.fromkeys(file.split()[2] for file in files))

    assert sizes({}, "prescribed") == sizes({}, "literal") == ["100", "150"]
    assert sizes({"sizes_nm": [50]}, "prescribed") == ["100", "150"]
    assert sizes({"sizes_nm": [50]}, "literal") == ["50"]


def test_the_literal_paces_of_the_config_have_one_ratio():
    """Only d omega/dt over the step counts (docs/model/drives.md), so the ensemble and figure 9 are of one ratio."""
    config = load(*DEFAULT).config
    first, second = config["literal"], config["figures"]["figure9"]["literal"]
    ratio = first["angular_acceleration"] / first["timestep_factor"]
    assert second["angular_acceleration"] / second["timestep_factor"] == pytest.approx(ratio)


def test_a_run_of_the_calibration_may_have_seeds_and_an_end_of_its_own():
    other = PACE | {"timestep_factor": 0.2, "seeds": {"first": 3, "number": 2}, "reach": 0.5}
    plan = with_changes({"figures": {"calibration": {"runs": [PACE, other]}}})
    own = plan.config["figures"]["calibration"]
    common, special = (plan.calibration_runs(label)[0] for label in plan.calibration_labels)
    assert (common["seeds"], common["reach"]) == (list(range(own["seeds"]["number"])), own["reach"])
    assert (special["seeds"], special["reach"], special["spin_up"]["timestep_factor"]) == ([3, 4], 0.5, 0.2)
    assert not {"seeds", "reach"} & set(special["spin_up"])
    assert special["grain"] == common["grain"]


def test_epsilon_is_one_for_all_types_or_one_for_each():
    paces = {"BA": 0.02, "BAM1": 0.005, "BAM2": 0.01}
    each, same = (with_changes({"run": {"stretch": None, "epsilon": value}}) for value in (paces, 0.05))
    for kind, epsilon in paces.items():
        assert each.spin_up("prescribed", "q-S", kind, "50", "0-9")["epsilon"] == epsilon
        assert same.spin_up("prescribed", "q-S", kind, "50", "0-9")["epsilon"] == 0.05
    default = load(*DEFAULT)
    assert default.spin_up_of("prescribed")["timestep_factor"] == TIMESTEP_FACTOR
    assert same.pace("prescribed") == "epsilon = 0.05" and each.pace("literal") == "d omega/dt = 1.25e+14 rad/s²"
    assert each.pace("prescribed") == "epsilon = 0.02 (BA), 0.005 (BAM1), 0.01 (BAM2)"
    assert default.pace("prescribed") == "stretch = 2e-14 m"


def test_a_law_is_a_setting_only_where_one_is_named():
    block = ("q-S", "BA", "50", "0-9")
    plain = load(*DEFAULT)
    own = plain.spin_up("prescribed", *block)
    assert "law" not in own and "law" not in arguments(own)
    force = {"normal_force": "DMT"}
    named = with_changes({"run": {"law": force}})
    assert named.spin_up("prescribed", *block) == own | {"law": force}
    assert arguments(named.spin_up("prescribed", *block))["law"] == force
    assert named.parameters("prescribed", "BA", "100")[0]["spin_up"]["law"] == force
    # each of these has a law of its own, beside the model
    assert named.formula_runs("damping") == plain.formula_runs("damping")


def test_a_drive_may_have_its_own_law():
    printed = {"formulae": "printed"}
    plan = with_changes({"drives": ["prescribed", "literal"], "literal": {"law": printed}})
    assert plan.spin_up_of("literal", "BA")["law"] == printed and "law" not in plan.spin_up_of("prescribed", "BA")
    other = with_changes({"run": {"law": printed}, "literal": {"law": None}})
    assert other.spin_up_of("prescribed", "BA")["law"] == printed and "law" not in other.spin_up_of("literal", "BA")


def test_snapshots_concern_the_block_of_the_grain_only():
    plan = load(*DEFAULT)
    assert plan.spin_up("prescribed", "q-S", "BAM2", "500", "0-9")["snapshot_seeds"] == [0]
    for cell in (("q-S", "BAM2", "500", "10-19"), ("q-S", "BAM1", "500", "0-9"), ("a-C", "BAM2", "500", "0-9")):
        settings = plan.spin_up("prescribed", *cell)
        assert settings["snapshot_seeds"] == [] and settings["snapshot_every"] == 0


def test_a_figure_can_be_left_out():
    plan = with_changes({"figures": {"figure4": None}})
    assert plan.figures == [name for name in FIGURES if name != "figure4"]
    assert plan.figure4_files("{material}/{seeds}") == []
    assert load(*DEFAULT).figure4_files("{material}/{size}/{seeds}")[0] == "q-S/350/0-9"


@pytest.mark.parametrize(("size", "label"), [(50, "50"), (50.0, "50"), (62.5, "62.5")])
def test_sizes_stand_in_names_without_needless_digits(size, label):
    assert size_label(size) == label


ICE = "surface_energy_mJ_m2: 100, youngs_modulus_GPa: 7, poisson_number: 0.25, density_kg_m3: 1000"
MATERIALS_OF_FIGURES = ("a-C", "q-S", "co-S")


def materials_file(tmp_path, text):
    file = tmp_path / "materials.yaml"
    file.write_text(text)
    return {"materials_file": str(file)}


def test_materials_of_the_user_stand_beside_those_of_ratd(tmp_path):
    snow = f"snow: {{{ICE}}}\n"
    half = "half: {mix: {snow: 0.5, q-S: 0.5}}\n"
    plan = with_changes(materials_file(tmp_path, snow + half) | {"materials": ["snow", "half", *MATERIALS_OF_FIGURES]})
    assert plan.material("snow")["youngs_modulus"] == pytest.approx(7e9)
    assert plan.material("snow")["viscous_time"] == MATERIALS["a-C"].viscous_time
    assert plan.material("half")["density"] == pytest.approx((1000 + 2650) / 2)
    assert plan.materials["q-S"] == MATERIALS["q-S"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("q-S: {mix: {a-C: 1.0}}\n", "'q-S' is a material of ratd already"),
        ("a/b: {mix: {a-C: 1.0}}\n", "the key 'a/b' is no name; allowed: a name of letters"),
        ("snow: {density_kg_m3: 1000, poisson_number: 0.2, youngs_modulus_GPa: 1}\n", "snow.surface_energy_mJ_m2 is"),
        (
            "sn.ow: {mix: {a-C: 1.0}}\n",
            "the key 'sn.ow' is no name; allowed: a name of letters, digits",
        ),
        ("snow: {mix: {a-C: 1.0}}\nsnow: {mix: {q-S: 1.0}}\n", "line 2: the key 'snow' stands in one mapping twice"),
        ("snow: {mix: {a-C: 0.4}}\n", "add up to 1"),
        ("snow: {mix: {b-C: 1.0}}\n", "b-C"),
        ("snow: {mix: {a-C: 1.0}, density_kg_m3: 5}\n", "with the one key mix"),
        (f"snow: {{{ICE}, gamma: 1}}\n", "the key 'gamma' in snow is unknown"),
        ("snow: 5\n", "snow is 5; allowed: a mapping"),
    ],
)
def test_what_is_wrong_with_a_material_is_named_with_the_file(tmp_path, text, said):
    with pytest.raises(InputError) as error:
        with_changes(materials_file(tmp_path, text))
    assert said in str(error.value) and "materials.yaml" in str(error.value)
    assert "\n" not in str(error.value)


def test_time_limits_grow_with_size_grains_and_tries():
    minutes = load(*DEFAULT).spin_up_minutes
    assert 20 * 10 < minutes("550", "0-9") < 2 * 1440
    assert minutes("50", "0-29") < 60 < minutes("350", "0-9") < minutes("550", "0-9") < minutes("550", "0-9", attempt=2)
