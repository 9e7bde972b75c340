"""Files against the checker of the CF conventions."""

import pytest

from files import grains_file, runs_file
from ratd.pipeline.io import CONVENTIONS

runner = pytest.importorskip("compliance_checker.runner")


@pytest.mark.parametrize("make", [grains_file, runs_file], ids=["grains", "runs"])
def test_the_checker_has_nothing_to_say(tmp_path, make):
    make(tmp_path / "file.nc")
    suite = runner.CheckSuite()
    suite.load_all_available_checkers()
    check = CONVENTIONS.lower().replace("-", ":")
    passed, errors = runner.ComplianceChecker.run_checker(
        str(tmp_path / "file.nc"), [check], 0, "strict", output_filename=str(tmp_path / "report.txt")
    )
    report = (tmp_path / "report.txt").read_text()
    assert passed and not errors and "All tests passed!" in report, report
