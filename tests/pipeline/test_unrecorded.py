"""Results that Snakemake has no record of: what of them is told."""

from types import SimpleNamespace

import pytest

from files import grains_file
from ratd.base.errors import InputError
from ratd.pipeline.provenance import provenance
from ratd.pipeline.unrecorded import check


def rule(settings, source="0123"):
    """A rule that makes the grains of a material."""
    params = SimpleNamespace(task={"hash": source}, settings=settings)
    return SimpleNamespace(
        name="grow",
        params=params,
        is_producer=lambda path: path.endswith("q-S.nc"),
        get_wildcards=lambda path: {"material": "q-S"},
    )


@pytest.fixture
def results(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    grains_file(tmp_path / "results/q-S.nc", attributes=provenance("0123", {"a": 1}))
    return "results"


def test_files_of_other_settings_or_another_source_are_told(results):
    check([rule({"a": 1}), rule({"a": 1})], results)
    check([rule(lambda wildcards: {"a": 1} if wildcards.material == "q-S" else None)], results)
    for other in (rule({"a": 2}), rule({"a": 1}, "4567")):
        with pytest.raises(InputError, match="1 in results/q-S.nc.*--forcerun grow makes them anew"):
            check([other], results)
        check([other], results, forced=["grow"])


def test_files_of_a_study_that_the_config_leaves_out_are_nobodys_business(results):
    check([rule(lambda wildcards: None)], results)
