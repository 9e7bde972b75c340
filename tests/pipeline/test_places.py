"""Files hold what their paths say."""

import pytest

from files import grains_file, runs_file
from ratd.base.errors import FileError, InputError
from ratd.pipeline import io, kinds
from ratd.pipeline.places import contradiction, seeds_of, size_label

OWN = "results/mine/grains/q-S/BA/50nm/seeds_0-2.nc"


@pytest.fixture
def grains(tmp_path):
    grains_file(tmp_path / "grains.nc")
    grains = io.read(tmp_path / "grains.nc", "grains")
    grains["a_eff"][:] = [50 * 1e-9, 5e-8, 50.000000000001e-9]  # the same to the digits of a label
    return grains


@pytest.mark.parametrize(
    ("path", "said"),
    [
        (OWN, ""),
        ("elsewhere/BAM2.nc", ""),
        (f"{OWN}.17.tmp", ""),
        (OWN.replace("q-S", "a-C"), "has the material q-S, but lies where a-C belongs"),
        (OWN.replace("BA", "BAM2"), "has the type BA, but lies where BAM2 belongs"),
        (OWN.replace("50nm", "62.5nm"), "has the size 50, but lies where 62.5 belongs"),
        (OWN.replace("0-2", "0-3"), "has the seeds 0-2, but lies where 0-3 belongs"),
    ],
)
def test_a_file_in_a_wrong_place_is_noticed(grains, path, said):
    assert contradiction(grains, kinds.kind_of("grains").places, path) == said


def test_sizes_and_seeds_that_do_not_belong_together_are_listed(grains):
    grains["a_eff"][1] = 1e-7
    grains["seed"][:] = [0, 2, 3]
    places = kinds.kind_of("grains").places
    assert contradiction(grains, places, OWN) == "has the size 50, 100, but lies where 50 belongs"
    grains["a_eff"][1] = 5e-8
    assert contradiction(grains, places, OWN) == "has the seeds 0, 2, 3, but lies where 0-2 belongs"


def test_a_file_is_neither_read_nor_written_where_another_belongs(tmp_path):
    runs_file(tmp_path / "runs.nc")
    wrong = tmp_path / "spinup" / "literal" / "q-S" / "BA" / "50nm" / "seeds_0-2.nc"
    wrong.parent.mkdir(parents=True)
    (tmp_path / "runs.nc").rename(wrong)
    with pytest.raises(FileError, match="has the drive prescribed, but lies where literal belongs: remove it"):
        io.read(wrong, "spinup")
    wrong.rename(tmp_path / "runs.nc")
    with pytest.raises(InputError, match="has the drive prescribed"):
        io.write(wrong, io.read(tmp_path / "runs.nc", "spinup"), "spinup")


def test_every_place_ends_in_a_file():
    for name in kinds.HOMES:
        assert all(place.endswith(".nc") for place in kinds.kind_of(name).places)


def test_labels():
    assert size_label(62.5) == "62.5" and list(seeds_of("3-5")) == [3, 4, 5]
