"""docs/compression.md: what is committed is what its data give, and a sentence that no longer holds is an error."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import ratd
from pictures_alike import unlike
from ratd.base.measured import Measured
from ratd.experiments.compression import document
from ratd.experiments.compression.findings import findings, of_sizes
from ratd.experiments.compression.pairs import BY_SIZE
from ratd.experiments.compression.plan import load
from ratd.experiments.compression.repeats import of_repeats
from ratd.experiments.compression.strength import measured, scatter_at
from ratd.experiments.compression.tables import joined
from ratd.experiments.compression.tension_findings import of_spun, of_tension
from ratd.experiments.compression.verdicts import below
from ratd.pipeline import io
from ratd.pipeline.documents import fill
from templates import slots

PAGE, APPENDIX = (path.read_text(encoding="utf-8") for path in document.DOCUMENTS.values())
TEMPLATE = "\n".join(path.read_text(encoding="utf-8") for path in document.DOCUMENTS)


@pytest.fixture(scope="module")
def values():
    return findings(*document.read_data())


def test_the_committed_documents_are_what_their_data_give(values):
    assert fill(TEMPLATE, values) == "\n".join([PAGE, APPENDIX])
    # as many lines as the page of the spin-up may have
    assert PAGE.count("\n") <= 250


def test_the_committed_figures_are_those_of_the_data(tmp_path):
    document.redraw(into=tmp_path)
    assert unlike(tmp_path / document.FIGURES, document.FIGURES) == [], "redraw the document"


def test_every_figure_of_the_document_is_there():
    lines = (PAGE + APPENDIX).splitlines()
    shown = [line.split("(compression/")[1].rstrip(")") for line in lines if line.startswith("![")]
    assert len(shown) >= 12 and len(set(shown)) == len(shown)
    assert [name for name in shown if not (document.FIGURES / name).is_file()] == []


def test_a_sentence_that_no_longer_holds_is_an_error(values):
    verdicts = [name for name in slots(TEMPLATE) if isinstance(values.get(name), str)]
    assert {"exponent", "line_0.3", "slow_line", "silicate_300", "leader_0.48"} <= set(verdicts)
    for name in verdicts:
        with pytest.raises(ratd.InputError, match=f"the verdict {name} is 'other'"):
            fill(TEMPLATE, values | {name: "other"})


def test_a_number_that_changes_flips_the_verdict_on_it(values):
    sets, *_ = document.read_data()
    assert values["line_0.03"] == "below" and values["exponent"] == "above 3"
    base = sets["base"].copy(deep=True)
    base["pressure"] = base["pressure"] * 1.5
    changed = findings({"base": base, "n_16384": base}, None, None)
    assert changed["line_0.03"] == "on"
    base["pressure"] = base["pressure"] / base["phi"]
    assert findings({"base": base}, None, None)["exponent"] == "below 3"
    loose = {name: sets[name] for name in ("base", "slow_16384", "short_16384")}
    assert values["short_steps"] == findings(loose, None, None)["short_steps"] == "less than a tenth"
    loose["short_16384"] = loose["short_16384"].assign(pressure=1.1 * loose["short_16384"]["pressure"])
    assert findings(loose, None, None)["short_steps"] == "a tenth or more"
    loose["loose_16384"] = sets["loose_16384"]
    assert values["slow_enough"] == findings(loose, None, None)["slow_enough"] == "the same"
    assert values["loose_line"] == "below"
    loose["loose_16384"] = sets["loose_16384"].assign(pressure=4.0 * sets["loose_16384"]["pressure"])
    found = findings(loose, None, None)
    assert found["slow_enough"] == "another" and found["loose_line"] == "on"
    small = sets["n_1024"].assign(pressure=sets["n_1024"]["pressure"] / sets["n_1024"]["phi"])
    assert findings({"base": sets["base"], "n_16384": small}, None, None)["exponent"] == "differs"


def test_it_lies_where_an_independent_code_finds_it(values):
    """Of ice, 1024 monomers, explicit steps; what that code found stands in the document."""
    for name in ("beside_3e-6", "beside_1e-5"):
        assert values[f"{name}.n"] >= 5 and values[f"{name}.N"] == 1024
        assert values[f"{name}.ratio_0.1"].value == pytest.approx(0.95, abs=0.20)
        assert values[f"{name}.exponent"].value == pytest.approx(3.1, abs=0.3)
    assert values["beside_3e-6.gyration"].value == pytest.approx(37.0, abs=2.0)


def test_missing_data_are_one_sentence(tmp_path):
    with pytest.raises(ratd.FileError, match="holds no base.nc"):
        document.read_data(tmp_path)
    with pytest.raises(ratd.FileError, match="holds no tables of the compression"):
        document.collect(tmp_path)


def test_clusters_that_are_made_later_are_added_to_their_set(tmp_path):
    whole = io.read(document.DATA / "sets/n_1024.nc", "compression_set")
    for name, seeds in (("first", [0, 2, 4, 6, 7, 8, 9]), ("later", [5, 1, 3])):
        part = whole.isel(seed_number=seeds).assign_attrs(code_hash=f"source of the {name}")
        filled = part["pressure"].notnull().any("seed_number")
        io.write(tmp_path / name / "compression/n_1024.nc", part.isel(phi_bin=filled.values), "compression_set")
        document.collect(tmp_path / name, tmp_path / "data")
    found = io.read(tmp_path / "data/sets/n_1024.nc", "compression_set")
    assert found["seed"].values.tolist() == list(range(10))
    assert found.attrs["code_hash"] == "source of the first; source of the later" and found.attrs["input_hash"] == ""
    assert found.attrs["versions"] == whole.attrs["versions"]
    for name in whole.variables:
        assert found[name].values == pytest.approx(whole[name].values, rel=1e-12, nan_ok=True), name
    # a seed that is there already: the new cluster takes the place of the old one, and the others stay
    again = io.read(tmp_path / "later/compression/n_1024.nc", "compression_set")
    again["pressure"] = 2.0 * again["pressure"]
    io.write(tmp_path / "later/compression/n_1024.nc", again, "compression_set")
    document.collect(tmp_path / "later", tmp_path / "data")
    twice = io.read(tmp_path / "data/sets/n_1024.nc", "compression_set")
    assert twice["seed"].values.tolist() == list(range(10))
    factor = (twice["pressure"] / found["pressure"]).mean("phi_bin").values
    assert factor == pytest.approx([1, 2, 1, 2, 1, 2, 1, 1, 1, 1])


def test_positions_of_a_larger_cluster_stay(tmp_path):
    whole = io.read(document.DATA / "snapshots.nc", "compression_snapshots")
    for name, n in (("small", 64), ("large", 128), ("small", 64)):
        path = tmp_path / name / "compression/snapshots.nc"
        io.write(path, whole.isel(monomer=slice(n)), "compression_snapshots")
        document.collect(tmp_path / name, tmp_path / "data")
        found = io.read(tmp_path / "data/snapshots.nc", "compression_snapshots")
        assert found.sizes["monomer"] == (128 if (tmp_path / "large").exists() else 64)


def test_pulls_that_are_made_later_are_added(tmp_path):
    whole = io.read(document.DATA / "tension.nc", "tension_set")
    for name, chosen in (("first", slice(None, None, 2)), ("later", slice(1, None, 2))):
        io.write(tmp_path / name / "tension/x/phi_0.1_seed_0.nc", whole.isel(entry=chosen), "tension_set")
        document.collect(tmp_path / name, tmp_path / "data")
    found = io.read(tmp_path / "data/tension.nc", "tension_set")
    pair = [table.to_dataframe().sort_values(list(table.variables), ignore_index=True) for table in (whole, found)]
    pd.testing.assert_frame_equal(pair[0], pair[1][pair[0].columns])
    # those that are there already are replaced
    again = whole.isel(entry=[3, 4])
    again["strength"] = 2.0 * again["strength"]
    # a pull begins where a step of time ends
    again["phi_compressed"] = again["phi_compressed"] + 1e-6
    io.write(tmp_path / "again/tension/x/phi_0.1_seed_0.nc", again, "tension_set")
    document.collect(tmp_path / "again", tmp_path / "data")
    twice = io.read(tmp_path / "data/tension.nc", "tension_set")
    more = twice["strength"].values.sum() - whole["strength"].values.sum()
    assert twice.sizes == whole.sizes and more == pytest.approx(whole["strength"].values[[3, 4]].sum())


def test_clusters_made_in_another_way_do_not_take_the_place_of_some(tmp_path):
    """Else a set would have two sorts of clusters, or lose some without a word."""
    table = io.read(document.DATA / "sets/n_1024.nc", "compression_set")
    target = tmp_path / "data/sets/n_1024.nc"
    io.write(target, table, "compression_set")
    other = table.isel(seed_number=[0, 1, 2]).assign_attrs(integrator="other steps")
    io.write(tmp_path / "some/compression/n_1024.nc", other, "compression_set")
    with pytest.raises(ratd.InputError, match="n_1024.nc: has 7 clusters that the new table lacks, and .* integrator"):
        document.collect(tmp_path / "some", tmp_path / "data")
    assert io.read(target, "compression_set")["seed"].values.tolist() == list(range(10))
    io.write(tmp_path / "all/compression/n_1024.nc", table.assign_attrs(integrator="other steps"), "compression_set")
    document.collect(tmp_path / "all", tmp_path / "data")
    assert io.read(target, "compression_set").attrs["integrator"] == "other steps"


def pulls(strength, seeds=(0, 1), *, phi=0.1, n_axes=1, rate=3e-6, n=1024, unloaded=0):
    """Entries of the kind tension_set, a strength a seed."""
    of_each = {
        "seed": seeds, "strength": strength, "phi": np.full(2, phi), "phi_compressed": np.full(2, phi),
        "phi_strength": np.full(2, 0.5 * phi), "residual": np.full(2, 0.1), "strain_rate": np.full(2, rate),
        "n_axes": np.full(2, n_axes), "n_monomers": np.full(2, n), "unloaded": np.full(2, unloaded),
        "surface_energy": np.full(2, 0.1), "monomer_radius": np.full(2, 1e-7),
    }  # fmt: skip
    return xr.Dataset({name: ("entry", np.asarray(values)) for name, values in of_each.items()})


def test_pulls_of_other_sorts_are_told_apart():
    entries = [pulls([1e4, 2e4]), pulls([2e4, 6e4], phi=0.2), pulls([1e3, 3e3], n_axes=3)]
    entries += [pulls([1.1e4, 2.2e4], rate=1e-6), pulls([3e4, 3e4], n=4096), pulls([9e3, 1.8e4], unloaded=1)]
    found = of_tension(xr.concat(entries, "entry"))
    unit = 0.6 * 0.1 / 1e-7 * 0.1**1.8
    assert found["tension_x.rate"] == 3e-6 and found["tension_x.N"] == 1024
    assert found["tension_x.0.1"].value == pytest.approx(1.5e4 / unit)
    assert found["tension_xyz.0.1"].value == pytest.approx(2e3 / unit)
    assert found["tension_x.residual_0.1"].value == pytest.approx(0.1 / 1.5e4)
    assert found["tension_x.peak_0.2"].value == pytest.approx(0.5)
    assert found["tension_x.exponent"].value == pytest.approx(np.log(np.sqrt(1200 / 200)) / np.log(2))
    # of the same clusters: each by the same part
    assert found["tension_rate_1e-06.over_0.1"] == pytest.approx((1.1, 0.0))
    assert found["tension_unloaded.over_0.1"] == pytest.approx((0.9, 0.0))
    assert found["tension_ways"] == "by more"
    # of others: 15 +- 5 kPa beneath 30 +- 0
    assert found["tension_N_4096.over_0.1"] == pytest.approx((2.0, 2.0 / 3.0))
    assert not any(name.endswith("over_0.2") for name in found)


def test_the_formula_of_the_tensile_strength_holds_or_fails():
    """It is asked of pulls along one axis from 0.05 on; looser clusters, and three axes, may be far from it."""
    units = {phi: 0.6 * 0.1 / 1e-7 * phi**1.8 for phi in (0.02, 0.1, 0.2)}
    near = [pulls([0.9 * units[0.1], 1.0 * units[0.1]]), pulls([1.1 * units[0.2], 1.1 * units[0.2]], phi=0.2)]
    apart = [pulls([9.0 * units[0.02]] * 2, phi=0.02), pulls([0.1 * units[0.1]] * 2, n_axes=3)]
    found = of_tension(xr.concat(near + apart, "entry"))
    assert found["tension_formula"] == "holds"
    assert found["tension_x.kPa_0.1"].value == pytest.approx(0.95e-3 * units[0.1])
    found = of_tension(xr.concat([*near, pulls([1.2 * units[0.1]] * 2, phi=0.1)], "entry"))
    assert found["tension_formula"] == "holds"
    found = of_tension(xr.concat([*near, pulls([0.6e6 * 0.4**1.8 * 1.2] * 2, phi=0.4)], "entry"))
    assert found["tension_formula"] == "fails"


def test_pulls_without_tension_count_in_means_alone():
    entries = [pulls([0.0, 2e4]), pulls([2e4, 4e4], phi=0.2), pulls([0.0, 0.0], phi=0.4)]
    table = xr.concat(entries, "entry")
    table["phi_strength"] = table["phi_strength"].where(table["strength"] > 0.0)
    found = of_tension(table)
    assert found["tension_x.0.1"].value == pytest.approx(1e4 / (0.6 * 0.1 / 1e-7 * 0.1**1.8))
    assert [found[f"tension_x.held_{phi}"] for phi in (0.1, 0.2, 0.4)] == [1, 2, 0]
    assert found["tension_x.peak_0.1"].value == 0.5
    assert np.isnan(found["tension_x.peak_0.4"].value) and np.isnan(found["tension_x.residual_0.4"].value)
    assert found["tension_x.exponent"].value == pytest.approx(np.log2(np.sqrt(20 * 40) / 20))


def test_a_cluster_that_bears_next_to_nothing_does_not_hold():
    unit = 0.6 * 0.1 / 1e-7 * 0.1**1.8
    found = of_tension(pulls([1.5 * unit, 1e-3 * unit]))
    assert found["tension_x.held_0.1"] == 1 and found["tension_x.of_held_0.1"].value == pytest.approx(1.5)
    assert found["tension_x.0.1"].value == pytest.approx(0.7505)


def test_the_strength_that_spin_implies_crosses_the_formula_where_its_power_law_does():
    phi = np.geomspace(0.1, 0.8, 12)
    formula = 0.6 * phi**1.8
    over = (phi / 0.4) ** 1.5
    other = 2.0 * (phi / 0.4) ** 2
    spun = {"phi": np.tile(phi, 2), "strength": np.concatenate([over * formula, other * formula])}
    spun |= {"type": np.full(24, "BA"), "material": np.repeat(["q-S", "a-C"], 12)}
    found = of_spun(spun)
    told = [found[f"spun.BA {end} {name}"] for name in ("power", "phi") for end in ("least", "most")]
    assert told == pytest.approx([1.5, 2.0, 0.4 / 2.0**0.5, 0.4])
    found = of_spun({name: own[:12] for name, own in spun.items()})
    assert found["spun.BA least"] == pytest.approx(over[0]) and found["spun.BA most"] == pytest.approx(over[-1])


def test_the_fractal_dimension_gives_the_power_that_the_paper_derives():
    """N goes as r_g^D, and P as phi^(3/(3 - D)); the line is D = 2."""
    for D in (2.0, 1.8):
        n = np.array([1024, 4096, 16384])
        square = [xr.Dataset({"n_monomers": k, "mean_square_gyration": k ** (2.0 / D)}) for k in n]
        error = [table.assign(mean_square_gyration_error=0.02 * table["mean_square_gyration"]) for table in square]
        found = of_sizes(dict(zip(BY_SIZE, error, strict=True)))
        assert found["dimension"].value == pytest.approx(D)
        assert found["derived_power"].value == pytest.approx(3.0 / (3.0 - D))
        # the slope of ln r_g^2 over ln N is known to 0.02/(ln 4 sqrt 2)
        spread = 0.5 * D**2 * 0.02 / np.log(4.0) / np.sqrt(2.0)
        assert found["dimension"].error == pytest.approx(spread)


def test_a_verdict_on_few_clusters_needs_more_than_two_errors():
    """Student's t: 0.5 with an error of 0.15 is below 1 in five clusters, and may be chance in three."""
    assert below(Measured(0.5, 0.15), 5) and not below(Measured(0.5, 0.15), 3)


def test_tables_of_other_sets_are_not_joined():
    one, other = (io.read(document.DATA / f"sets/{name}.nc", "compression_set") for name in ("n_1024", "rate_1e-6"))
    with pytest.raises(ratd.InputError, match="they differ in .*strain_rate"):
        joined(one, other)
    with pytest.raises(ratd.InputError, match="both tables have the seed 0"):
        joined(one, one)


def test_the_command_says_how_it_is_used(capsys):
    assert document.main([]) == 2 and "redraw" in capsys.readouterr().out
    assert document.main(["collect", "nowhere"]) == 1 and "nowhere" in capsys.readouterr().err


def test_parts_without_data_are_left_out():
    text = "a\n<!-- if x -->\nb {{x.n}}\n<!-- if not y -->\nc\n<!-- end -->\n<!-- end -->\nd\n"
    assert fill(text, {"x.n": 2}) == "a\nb 2\nc\nd\n"
    assert fill(text, {"y.n": 2.0}) == "a\nd\n"
    with pytest.raises(ratd.InputError, match="an 'if' without an 'end'"):
        fill("<!-- if x -->\n", {"x.n": Measured(1.0)})
    assert Path("docs/compression/data/sets/base.nc").is_file()


def test_where_hardly_anything_rolls_the_pressure_does_not_go_with_the_rolling_displacement(values):
    """Four times xi_c: the same pressure at 0.01, and much more where monomers roll."""
    for times in ("xi_16", "xi_32"):
        assert abs(values[f"{times}.pressure_over_0.01"].value - 1.0) < 0.02
    assert values["xi_32.pressure_over_0.03"].value > 1.4
    assert values["slow_16384.lost_rolling_0.01"] < 0.15 < 0.4 < values["slow_16384.lost_rolling_0.02"]


def test_two_clusters_have_the_scatter_of_many(values):
    own = values["silicate_16384.ratio_0.1_of_few"]
    assert own.value == values["silicate_16384.ratio_0.1"].value
    wanted = own.value * values["n_16384.scatter_0.1"].value / 2**0.5
    assert abs(own.error / wanted - 1.0) < 1e-12 and own.error > 2 * values["silicate_16384.ratio_0.1"].error


def test_a_slow_squeeze_is_said_to_suggest_what_five_clusters_do_not_show(values):
    """Ten clusters of the usual rate at six tenths of their pressure show it; at more than it they deny it."""
    assert (values["slow_0.01"], values["slow_0.02"]) == ("suggest", "show")
    sets, *_ = document.read_data()
    for times, word in ((0.6, "show"), (1.05, "deny")):
        slow = sets["n_16384"].assign(pressure=times * sets["n_16384"]["pressure"])
        chosen = {"base": sets["base"], "n_16384": sets["n_16384"], "slow_16384": slow}
        found = findings(chosen, None, None)
        assert found["slow_0.01"] == found["slow_0.02"] == word


def test_sets_that_were_made_once_more_agree_in_their_means():
    """Those of ten and all together within three errors, and single clusters by less than two clusters do."""
    sets, entries, *_, repeats, pulled = document.read_data()
    found = of_repeats(sets, repeats, entries, pulled)
    assert {name.split(".")[0] for name in found} == {*repeats, "repeats"}
    # every set of the default config
    assert set(repeats) == set(load(*document.CONFIGS[:4]).sets)
    many = ("repeats", *(name for name in repeats if found[f"{name}.repeated"] >= 10))
    over = [value for name, value in found.items() if ".over_first_" in name and name.startswith(many)]
    assert len(over) >= 12 and all(abs(one.value - 1.0) <= 3.0 * one.error for one in over)
    strength = found["repeats.strength"]
    assert found["repeats.pulls"] >= 40 and abs(strength.value - 1.0) < 3.0 * strength.error
    assert found["n_1024.parted_0.1"] < 0.5 * float(measured(scatter_at(sets["n_1024"], 0.1)).value)
    # a set beside itself
    same = of_repeats(sets, {"base": sets["base"]}, entries, entries)
    assert same["base.parted_0.1"] == 0.0 and same["base.over_first_0.1"].value == pytest.approx(1.0)
    assert same["repeats.pulls"] == entries.sizes["entry"] and same["repeats.strength"] == (1.0, 0.0)
    stronger = of_repeats(sets, {}, entries, entries.assign(strength=1.1 * entries["strength"]))
    assert stronger["repeats.strength"].value == pytest.approx(1.1)
