"""Table 3 of the paper, and the report that prints it."""

import runpy

import numpy as np
import pytest

from flapenv.validation import specific_power_errors, table3, validation_report, weight_support_errors


def test_table_3_is_met_for_all_eight_insects() -> None:
    rows = table3()
    lift, power = weight_support_errors(rows), specific_power_errors(rows)
    paper = np.array([row.paper.weight_support for row in rows])
    assert np.max(np.abs(lift)) <= 0.05
    assert np.max(np.abs(power)) <= 1.0
    assert np.sqrt(np.mean((lift / paper) ** 2)) <= 0.025
    assert np.sqrt(np.mean(power**2)) <= 0.5


def test_power_lies_within_a_fifth_of_cfd() -> None:
    for row in table3():
        assert row.specific_power == pytest.approx(row.cfd.specific_power, rel=0.2), row.insect


def test_the_report_prints_both_tables_for_every_insect(capsys: pytest.CaptureFixture[str]) -> None:
    report = validation_report()
    assert report.count("hoverfly") == 2
    assert "k_tip: differs in the second decimal for dronefly" in report
    assert "k_flap: differs in the second decimal for none" in report
    with pytest.warns(RuntimeWarning, match=r"flapenv\.validation"):  # run again though imported above
        runpy.run_module("flapenv.validation", run_name="__main__")
    assert capsys.readouterr().out.strip() == report
