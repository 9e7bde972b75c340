"""The RO-Crate: what a library that reads such finds in it."""

import json

from rocrate.rocrate import ROCrate

from files import grains_file
from ratd.pipeline.crate import PROFILE, describe
from ratd.pipeline.provenance import provenance


def test_a_crate_names_the_files_and_what_they_were_made_with(tmp_path):
    (tmp_path / "config.yaml").write_text("results: x\n")
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "figure1.png").write_bytes(b"PNG")
    grains_file(tmp_path / "grains.nc", attributes=provenance("0123", {"a": 1}))
    # a table that a figure needs, which nobody lists; and what is not finished
    for folder in ("pairs", "grains.nc.partial"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "q-S.csv").write_text("a\n1\n")
    files = [tmp_path / name for name in ("config.yaml", "grains.nc", "figures/figure1.png", "grains.nc")]
    said = []
    text = describe(files, {}, said.append)["crate"]
    assert said == ["3 files described"] and describe(files, {}, said.append)["crate"] == text
    (tmp_path / "ro-crate-metadata.json").write_text(text)

    crate = ROCrate(tmp_path)
    assert crate.root_dataset["conformsTo"].id == PROFILE
    (run,) = crate.get_by_type("CreateAction")
    assert [file.id for file in run["object"]] == ["config.yaml"]
    assert {file.id for file in run["result"]} == {"grains.nc", "figures/figure1.png", "pairs/q-S.csv"}
    assert run["instrument"]["name"] == "ratd"
    grains = crate.get("grains.nc")
    assert grains["encodingFormat"] == "application/x-netcdf" and "source 0123" in grains["description"]
    assert str(tmp_path) not in json.dumps(json.loads(text)["@graph"])
