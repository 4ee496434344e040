"""The command line that prints optima: its numbers are `optimum`'s, and its files are read again."""

import json
import math
from pathlib import Path

import pytest

import train
from agents.commands.optimum import cases, parser
from flapenv import INSECTS, HoverProblem, load_insect, optimum, read_strokes, read_wing

ROBOT = Path(__file__).parents[3] / "docs" / "examples" / "robot.json"


def line_of(name: str, text: str) -> list[str]:
    """The cells of an insect's line."""
    (found,) = [line.split() for line in text.splitlines() if line.startswith(f"{name} ") and "INFEASIBLE" not in line]
    return found


def test_the_table_is_the_optimum_of_every_insect(capsys: pytest.CaptureFixture[str]) -> None:
    assert train.main(["optimum"]) == 0
    out = capsys.readouterr().out
    for name in INSECTS:
        best = optimum(name)
        cells = line_of(name, out)
        assert cells[1:4] == ["1.0000", f"{best.specific_power:.2f}", f"{best.lower_bound:.2f}"]
        assert cells[6] == f"{best.stroke.frequency:.4g}"
        assert {"φmax:upper", "Cφ:upper", "Cθ:upper", "θmax:upper"} <= set(cells)
    assert "SLSQP" in out
    assert "refined blade element" in out


def test_a_wing_of_ones_own_is_solved_within_its_limits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["optimum", "hawkmoth", "--wing", str(ROBOT), "--problem", "profile-drag"]
    assert train.main([*asked, "--out", str(tmp_path / "a.json")]) == 0
    out = capsys.readouterr().out
    moth, robot = read_strokes(tmp_path / "a.json")
    wing = read_wing(ROBOT)
    assert (moth.insect, robot.insect) == (load_insect("hawkmoth"), wing.insect)
    assert moth.stroke == optimum("hawkmoth", "profile-drag").stroke
    low, high = wing.limits["flap_amplitude"]
    assert low <= robot.stroke.flap_amplitude <= high + 1e-9
    assert line_of("invented-robot", out)[6] == f"{robot.stroke.frequency:.4g}"
    assert f"kept in {tmp_path / 'a.json'}" in out
    assert out.index("profile-drag ") < out.index("hawkmoth ") < out.index("profile-drag within limits ")
    assert out.index("profile-drag within limits ") < out.index("invented-robot ")


def test_csv_keeps_the_strokes_of_named_insects(tmp_path: Path) -> None:
    assert train.main(["optimum", "fruitfly", "hawkmoth", "--out", str(tmp_path / "a.csv")]) == 0
    found = read_strokes(tmp_path / "a.csv")
    assert [one.stroke for one in found] == [optimum(name).stroke for name in ("fruitfly", "hawkmoth")]


def test_what_no_cfd_covers_is_told_of_limits_wider_than_the_problem(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    steep = wing_of(tmp_path, limits={"pitch_amplitude": [0.2, 1.5]})
    assert train.main(["optimum", "--wing", steep]) == 0
    out = capsys.readouterr().out
    (stroke,) = [optimum(one.insect, one.problem(HoverProblem())).stroke for one in [read_wing(steep)]]
    angle = math.degrees(stroke.angle_of_attack(0.0))
    assert angle < 10
    assert f"α at mid-stroke = {angle:.4g}, beyond 25 to 45°: invented-robot" in out


def test_too_little_memory_is_one_line(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: object) -> None:
        raise MemoryError

    monkeypatch.setattr("agents.commands.optimum.cases", full)
    assert train.main(["optimum"]) == 2
    assert capsys.readouterr().err == "train.py optimum: not enough memory\n"


def test_limits_that_leave_nothing_name_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    far = wing_of(tmp_path, limits={"frequency": [1, 2]})
    for asked in (["optimum", "--problem", "fixed-frequency"], ["--problem", "fixed-frequency"]):
        assert train.main([*asked, "--wing", far]) == 2
        assert f"{far}: limits of frequency leave invented-robot nothing" in capsys.readouterr().err


def test_what_cannot_hover_says_how_much_it_can_carry(capsys: pytest.CaptureFixture[str]) -> None:
    assert train.main(["optimum", "fruitfly", "hawkmoth", "--problem", "fixed-frequency"]) == 0
    out = capsys.readouterr().out
    largest = optimum("fruitfly", "fixed-frequency").max_weight_support
    assert f"fruitfly is INFEASIBLE: no stroke of the box supports more than {largest:.3f} of its weight" in out
    assert "hawkmoth is INFEASIBLE" not in out
    assert line_of("fruitfly", out)[2] == "none"


def test_insects_of_unknown_wing_mass_are_left_out_by_name(capsys: pytest.CaptureFixture[str]) -> None:
    asked = cases(parser().parse_args(["--problem", "inertial"]))
    assert [insect.name for insect, _ in asked] == ["fruitfly", "bumblebee", "hawkmoth"]
    assert capsys.readouterr().err.startswith("left out, as their wing masses are not known: honeybee, cranefly")


def wing_of(folder: Path, **changes: object) -> str:
    """A wing file like the example's with other fields."""
    content = json.loads(ROBOT.read_text(encoding="utf-8")) | changes
    (folder / "robot_planform.csv").write_bytes((ROBOT.parent / "robot_planform.csv").read_bytes())
    (folder / "wing.json").write_text(json.dumps(content))
    return str(folder / "wing.json")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["hawkmot"], "insect = 'hawkmot' is unknown; allowed: fruitfly"),
        (["hawkmoth", "hawkmoth"], "2 are called 'hawkmoth'; allowed: each name once"),
        (["--wing", str(ROBOT), "--wing", str(ROBOT)], "2 are called 'invented-robot'"),
        (["--problem", "free"], "problem = 'free' is unknown"),
        (["honeybee", "--problem", "inertial"], "'inertial' needs wing masses, which honeybee lacks"),
        (["--wing", "nowhere.json"], "nowhere.json does not exist; allowed: a wing file"),
        (["--out", "a.txt"], "a.txt does not end in .json or .csv"),
        (["--out", "nowhere/a.csv"], "nowhere is not a folder; allowed: one that exists"),
        (["--wing", str(ROBOT), "--out", "a.csv"], "insect 'invented-robot' is none of fruitfly"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert train.main(["optimum", *arguments]) == 2
    out, err = capsys.readouterr()
    assert err.startswith("train.py optimum: ")
    assert said in err
    assert err.removesuffix("\n").isprintable()
    assert not out
    assert not list(tmp_path.iterdir())


def test_a_wing_beyond_its_limits_is_told_with_its_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert train.main(["optimum", "--wing", wing_of(tmp_path, mass=100)]) == 2
    assert "wing.json: mass = 100 is not allowed" in (err := capsys.readouterr().err)
    assert "100 looks like milligrams: 0.0001 kg" in err
    assert train.main(["optimum", "--wing", wing_of(tmp_path, mass=1e-3)]) == 0
    assert "invented-robot is INFEASIBLE: no stroke of the box supports more than 0." in capsys.readouterr().out


def test_help_teaches(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        train.main(["optimum", "--help"])
    assert end.value.code == 0
    out = capsys.readouterr().out
    for word in ("examples:", "--wing", "--problem", "--out", "proven", "hawkmoth"):
        assert word in out
