"""Judging strokes from the command line: published ones, files, and wings of one's own."""

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import pytest

import train as command
from agents.evaluation.evaluated import Asked
from agents.evaluation.evaluated import evaluated as judged
from flapenv import INSECTS, HoverProblem, Stroke, load_insect, optimum, read_strokes
from flapenv.files import NamedStroke, WingFile, write_strokes, write_wing
from flapenv.simulation import evaluate_by_blade_element
from flapenv.validation import table3

SLOW = Stroke(frequency=100.0, flap_amplitude=1.0, pitch_amplitude=0.9)
FINE = {"strips": 6, "spacing": "gauss", "steps": 40_000}


def evaluated(capsys: pytest.CaptureFixture[str], *arguments: Any) -> tuple[int, str, str]:
    code = command.main(["evaluate", *map(str, arguments)])
    return code, *capsys.readouterr()


def line_of(text: str, insect: str) -> list[str]:
    return next(line for line in text.splitlines() if line.startswith(f"{insect} ")).split()


def test_a_published_stroke_is_its_line_of_table_3(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = evaluated(capsys, "published")
    assert code == 0
    for row in table3():
        words = line_of(out, row.insect)
        assert words[1] == f"{row.weight_support:.4f}"
        assert float(words[3]) == pytest.approx(row.specific_power, abs=0.005)
        assert words[2:] == line_of(evaluated(capsys, row.insect)[1], row.insect)[2:]
        assert words[-3:-1] == ["-", "-"]  # nothing is saved of itself


@pytest.mark.parametrize("ending", ["json", "csv"])
def test_strokes_of_a_file_are_judged_as_they_were_written(
    ending: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / f"best.{ending}"
    write_strokes(file, [NamedStroke(insect=name, stroke=optimum(name).stroke) for name in INSECTS])
    code, out, _ = evaluated(capsys, file, "--out", tmp_path / "kept")
    assert code == 0
    assert "mean 0.000 %, worst 0.000 %" in out
    kept = json.loads((tmp_path / "kept" / "best" / "results.json").read_text(encoding="utf-8"))
    for name in INSECTS:
        entry = kept["insects"][name]
        assert Stroke(**entry["stroke"]) == optimum(name).stroke
        assert line_of(out, name)[3:5] == [f"{entry['specific_power']:.2f}", f"{entry['power_uncertainty']:.1f}"]
    assert (tmp_path / "kept" / "best" / "learned.png").stat().st_size > 10_000


def test_the_shipped_policy_needs_less_than_every_insects_own_stroke_and_the_oracle_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, _ = evaluated(capsys, "hover", "--out", tmp_path)
    assert code == 0
    kept = json.loads((tmp_path / "hover" / "results.json").read_text(encoding="utf-8"))["insects"]
    assert list(kept) == list(INSECTS)
    for name, entry in kept.items():
        insect, learned = load_insect(name), Stroke(**entry["stroke"])
        support, power = evaluate_by_blade_element(insect, learned, **FINE)
        own_support, own_power = evaluate_by_blade_element(insect, insect.stroke, **FINE)
        assert (entry["weight_support"], entry["specific_power"]) == pytest.approx((support, power), rel=1e-4)
        assert support == pytest.approx(1, abs=2e-4)
        assert power < own_power / own_support**1.5
        uncertainty = abs(power - power * insect.cfd.specific_power / own_power)
        assert entry["power_uncertainty"] == pytest.approx(uncertainty, rel=1e-3)
        carried = [one / lift**1.5 for lift, one in ((support, power), (own_support, own_power))]
        saving, of_cfd = 1 - carried[0] / carried[1], 1 - carried[0] / insect.cfd.specific_power
        assert saving > abs(saving - of_cfd)
        assert power + uncertainty < insect.cfd.specific_power
        words = line_of(out, name)
        assert [words[1], *words[3:5]] == [f"{support:.4f}", f"{power:.2f}", f"{uncertainty:.1f}"]
        assert words[-3:] == [
            f"{entry[key]:.0f}" for key in ("saving_percent", "saving_uncertainty_percent", "saving_to_cfd_percent")
        ]
        assert [entry["saving_percent"], entry["saving_to_cfd_percent"]] == pytest.approx(
            [100 * saving, 100 * of_cfd], abs=0.05
        )
    assert "29 of 30 cases of other models; not with positive power: hawkmoth\n" in out


def test_a_stroke_of_nobody_is_beaten_by_whom_it_is_given_to(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_strokes(tmp_path / "one.csv", [NamedStroke(stroke=SLOW)])
    assert "allowed: an insect with every stroke" in evaluated(capsys, tmp_path / "one.csv")[2]
    _, out, _ = evaluated(capsys, tmp_path / "one.csv", "--insects", "fruitfly", "honeybee")
    assert line_of(out, "fruitfly") != line_of(out, "honeybee")


def test_a_wing_of_ones_own_is_held_against_its_limits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = dataclasses.replace(load_insect("dronefly"), name="robot", k_table=None, cfd=None)
    narrow = {"flap_amplitude": (math.radians(40), math.radians(60))}
    write_wing(tmp_path / "robot.json", WingFile(insect=robot, limits=narrow))
    code, out, _ = evaluated(capsys, "random-wings", "--wing", tmp_path / "robot.json")
    assert code == 0
    assert "beyond 40 to 60°: robot" in out
    assert line_of(out, "robot")[4] == f"{0.109 * float(line_of(out, 'robot')[3]):.1f}"  # the rms of the eight
    moth = dataclasses.replace(load_insect("hawkmoth"), name="moth", k_table=None)
    write_wing(tmp_path / "moth.json", WingFile(insect=moth, limits={"frequency": (22.0, 30.0)}))
    files = [word for name in ("robot", "moth") for word in ("--wing", tmp_path / f"{name}.json")]
    _, both, _ = evaluated(capsys, "random-wings", *files)
    alone = evaluated(capsys, "random-wings", "--wing", tmp_path / "moth.json")[1]
    assert [line_of(both, name) for name in ("robot", "moth")] == [line_of(out, "robot"), line_of(alone, "moth")]
    write_strokes(tmp_path / "stroke.json", [NamedStroke(insect=robot, stroke=SLOW)])
    _, out, _ = evaluated(capsys, tmp_path / "stroke.json", "--wing", tmp_path / "robot.json")
    assert line_of(out, "robot")[1] == f"{evaluate_by_blade_element(robot, SLOW, **FINE)[0]:.4f}"


def test_strokes_of_a_file_are_judged_in_the_problem_that_is_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "moth.JSON"
    write_strokes(file, [NamedStroke(insect="hawkmoth", stroke=load_insect("hawkmoth").stroke)])
    code, out, _ = evaluated(capsys, file, "--problem", "profile-drag", "--out", tmp_path)
    assert code == 0
    kept = json.loads((tmp_path / "moth" / "results.json").read_text(encoding="utf-8"))
    best = optimum("hawkmoth", "profile-drag")
    assert kept["problem"]["name"] == "profile-drag"
    assert kept["insects"]["hawkmoth"]["optimum_specific_power"] == best.specific_power
    assert line_of(out, "hawkmoth")[5] == f"{best.specific_power:.2f}"


def test_limits_of_a_wing_bound_the_optimum_its_strokes_are_held_against_and_the_picture_shows_that_one(
    tmp_path: Path,
) -> None:
    robot = dataclasses.replace(load_insect("dronefly"), name="robot", k_table=None, cfd=None)
    wing = WingFile(insect=robot, limits={"flap_amplitude": (math.radians(40), math.radians(50))})
    write_strokes(tmp_path / "one.json", [NamedStroke(insect=robot, stroke=SLOW)])
    for subject in (tmp_path / "one.json", "random-wings"):
        found = judged(subject, Asked(wings=[wing]))
        (one,) = found.verdict.assessments
        assert one.best == optimum(robot, wing.problem(HoverProblem()))
        assert one.best.specific_power > 1.01 * optimum(robot).specific_power
        (panel,) = [axes for axes in found.draw().axes if axes.get_visible()]
        assert f"(optimal {one.best.stroke.frequency:.4g})" in panel.get_title()


def test_what_is_kept_of_a_wing_of_ones_own_can_be_judged_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = dataclasses.replace(load_insect("dronefly"), name="robot", k_table=None, cfd=None)
    limits = {"flap_amplitude": (math.radians(40), math.radians(60))}
    wing = tmp_path / "robot.json"
    write_wing(wing, WingFile(insect=robot, limits=limits))
    _, first, _ = evaluated(capsys, "random-wings", "--wing", wing, "--out", tmp_path)
    results = tmp_path / "random-wings" / "results.json"
    (read,) = read_strokes(results)
    assert read.insect == robot
    entry = json.loads(results.read_text(encoding="utf-8"))["insects"]["robot"]
    assert HoverProblem(**entry["problem"]) == WingFile(insect=robot, limits=limits).problem(HoverProblem())
    _, again, _ = evaluated(capsys, results, "--wing", wing)
    assert line_of(again, "robot") == line_of(first, "robot")
    page = (tmp_path / "random-wings" / "report.html").read_text(encoding="utf-8")
    assert "train.py evaluate random-wings --wing robot.json" in page
    _, _, _ = evaluated(capsys, results, "--out", tmp_path / "again")
    kept = (tmp_path / "again" / "results").iterdir()
    assert all(str(tmp_path).encode() not in file.read_bytes() for file in kept)


def test_insects_without_a_wing_mass_are_left_out_of_the_published_where_it_counts(
    capsys: pytest.CaptureFixture[str],
) -> None:
    code, out, _ = evaluated(capsys, "published", "--problem", "inertial")
    assert code == 0
    assert [word for word in INSECTS if f"\n{word} " in out] == ["fruitfly", "bumblebee", "hawkmoth"]
    assert "left out, as their wing masses are not known: honeybee, cranefly" in out
    assert evaluated(capsys, "published", "--insects", "honeybee", "--problem", "inertial")[0] == 2


def test_what_fails_leaves_no_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.json").write_text("{")
    (tmp_path / "file").touch()
    for arguments, said in (
        ((tmp_path / "bad.json", "--out", tmp_path / "out"), "bad.json is not JSON"),
        (("..", "--out", tmp_path / "out"), "safetensors"),
        (("hawkmoth", "--out", tmp_path / "file"), "file is a file; allowed: a folder"),
        (("hawkmoth", "--problem", "free", "--out", tmp_path / "out"), "'free' is unknown"),
    ):
        code, out, err = evaluated(capsys, *arguments)
        assert (code, out) == (2, "")
        assert said in err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.json", "file"]


def test_too_little_memory_is_one_line(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: Any) -> None:
        raise MemoryError

    monkeypatch.setattr("agents.evaluation.evaluated.evaluated", full)
    assert evaluated(capsys, "hawkmoth") == (2, "", "train.py evaluate: not enough memory\n")


def test_bad_input_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bee = [NamedStroke(insect="honeybee", stroke=SLOW)]
    write_strokes(tmp_path / "bee.json", bee)
    write_strokes(tmp_path / "two.json", bee * 2)
    wide = dataclasses.replace(SLOW, flap_amplitude=2.0)
    write_strokes(tmp_path / "wide.json", [NamedStroke(insect="honeybee", stroke=wide)])
    write_wing(tmp_path / "wing.json", WingFile(insect=load_insect("hawkmoth")))
    write_strokes(tmp_path / "one.csv", [NamedStroke(stroke=SLOW)])
    fixed = "--problem", "fixed-frequency"
    far = WingFile(insect=dataclasses.replace(load_insect("hawkmoth"), name="moth"), limits={"frequency": (50, 60)})
    write_wing(tmp_path / "far.json", far)
    text = (tmp_path / "bee.json").read_text(encoding="utf-8")
    (tmp_path / "degrees.json").write_text(text.replace('"flap_amplitude": 1.0', '"flap_amplitude": 60'), "utf-8")
    (tmp_path / "cut.json").write_text(text[: len(text) // 2], encoding="utf-8")
    (tmp_path / "empty.csv").touch()
    for arguments, said in (
        (("missing.json",), "missing.json"),
        ((tmp_path / "cut.json",), "cut.json"),
        ((tmp_path / "empty.csv",), "empty.csv"),
        ((tmp_path / "degrees.json",), "degrees"),
        ((tmp_path / "two.json",), "several strokes of honeybee"),
        ((tmp_path / "bee.json", "--insects", "hawkmoth"), "no stroke of hawkmoth; allowed: honeybee"),
        ((tmp_path / "bee.json", "--wing", tmp_path / "wing.json"), "no stroke of hawkmoth"),
        ((tmp_path / "bee.json", "--noise", "0.1"), "--noise is not told of strokes"),
        ((tmp_path / "bee.json", "--pool-seed", "1"), "--pool-seed is not told of strokes"),
        ((tmp_path / "bee.json", "--pool-seed", "0"), "--pool-seed is not told of strokes"),
        (("published", "--insects", "hawkmoth", "hawkmoth"), "published has several strokes of hawkmoth"),
        (("hover", "--noise", "nan"), "--noise: share = nan"),
        ((tmp_path / "one.csv", "--wing", tmp_path / "far.json", *fixed), "--wing, moth: limits of frequency leave"),
        (("a\nb\x1b[31m" * 100,), r"'a\nb\x1b[31m"),
        (("a" * 5000 + ".json",), "File name too long"),
        (("hawkmoth", "--wing", tmp_path / "wing.json"), "belong to the insects"),
        (("hawkmoth", "--insects", "honeybee"), "published --insects"),
        (("hover", "--wing", tmp_path / "wing.json", "--insects", "honeybee"), "allowed: one of them"),
        (("hover", "--wing", tmp_path / "bee.json"), "bee.json"),
        ((tmp_path / "wide.json",), "wide.json, honeybee: flap_amplitude (where k_flap is used) = 2 is not allowed"),
        (("hawkmot",), "did you mean 'hawkmoth'"),
    ):
        code, out, err = evaluated(capsys, *arguments)
        assert (code, out) == (2, ""), arguments
        assert said in err
        assert err.removesuffix("\n").isprintable(), err
        assert len(err) < 1200
