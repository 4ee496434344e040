"""The explorer's answers: the numbers of `flapenv.evaluate`, one line for what is wrong, and a file that reads back."""

import json
import math
import statistics
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from dash import Dash

import flapenv
from agents.explorer import cases
from agents.explorer.app import make_app
from agents.explorer.controls import OWN_WING, stroke_controls
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.files import WingFile, read_strokes
from flapenv.optimum import optimum


def stroke_of(page: Any) -> flapenv.Stroke:
    sent = page.values
    return flapenv.Stroke(
        frequency=sent["frequency"],
        flap_amplitude=math.radians(sent["flap_amplitude"]),
        flap_shape=sent["flap_shape"],
        pitch_shape=sent["pitch_shape"],
        pitch_amplitude=math.radians(90 - sent["alpha_mid"]),
        pitch_phase=math.radians(sent["pitch_phase"]),
    )


@pytest.mark.parametrize("problem", cases.EXPLORED)
def test_the_numbers_are_those_of_evaluate_to_the_last_digit(page: Any, problem: str) -> None:
    page.choose(insect="hawkmoth", problem=problem)
    shown = page.numbers()
    found = flapenv.evaluate("hawkmoth", stroke_of(page), **vars(flapenv.PROBLEMS[problem].model))
    assert page.exact(shown)["weight_support"] == found.weight_support
    assert page.exact(shown)["specific_power"] == found.specific_power
    assert f"{found.weight_support:#.5g}" in page.words(shown)
    assert f"{found.specific_power:#.5g}" in page.words(shown)


def test_an_insect_comes_with_its_own_stroke_and_buttons_load_the_others(page: Any) -> None:
    answer = page.choose(insect="fruitfly")
    own = flapenv.load_insect("fruitfly").stroke
    assert answer["frequency"]["value"] == pytest.approx(own.frequency, rel=1e-9)
    assert answer["alpha_mid"]["value"] == pytest.approx(90 - math.degrees(own.pitch_amplitude), rel=1e-9)
    loaded = page.ask("frequency.value@", changed="load-optimal.n_clicks")
    shown = page.numbers(**{name: one["value"] for name, one in loaded.items()})
    best = optimum("fruitfly")
    assert page.exact(shown)["specific_power"] == pytest.approx(best.specific_power, rel=1e-6)
    assert page.exact(shown)["gap"] == pytest.approx(0, abs=1e-6)
    learned = page.ask("frequency.value@", changed="load-learned.n_clicks")
    shown = page.numbers(**{name: one["value"] for name, one in learned.items()})
    assert 0 < page.exact(shown)["gap"] < 0.01
    assert page.exact(shown)["saving"] > 0.3


def test_another_problem_keeps_the_stroke_that_was_moved(page: Any) -> None:
    page.choose(insect="hawkmoth")
    answer = page.ask("case.data", changed="problem.value", problem="profile-drag", frequency=33.0)
    assert answer["frequency"]["value"] == 33.0


def test_moving_a_slider_solves_no_optimum(page: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    page.choose(insect="cranefly")
    page.values["frequency"] = 40.0
    monkeypatch.setattr(cases, "assess", None)
    monkeypatch.setattr(sys.modules["flapenv.optimum"], "_solve", None)
    assert page.exact(page.numbers())["gap"] is not None


def test_numbers_are_answered_within_a_tenth_of_a_second(page: Any) -> None:
    page.choose(insect="hawkmoth")
    times = []
    for step in range(21):
        start = time.perf_counter()
        page.numbers(frequency=25.0 + 0.1 * step)
        times.append(time.perf_counter() - start)
    print(f"{1000 * statistics.median(times):.1f} ms (median), {1000 * max(times):.1f} ms (worst)")
    assert statistics.median(times) < 0.05  # the rest is the browser's


def test_pages_that_are_drawn_at_once_do_not_disturb_each_other(page: Any, app: Dash) -> None:
    page.choose(insect="fruitfly")  # beyond the range of some of the other models, whose warnings are silenced
    calm = [page.values["case"], "own", *(250.0, 75.0, 0.1, 5.0, 40.0, 90.0)]
    failed: list[BaseException] = []

    def draw() -> None:
        try:
            other = type(page)(app)
            assert other.ask("remarks.children", changed="calm.data", calm=calm)
        except AssertionError as mistake:
            failed.append(mistake)

    for _ in range(3):
        threads = [threading.Thread(target=draw) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert not failed


def test_the_own_stroke_is_not_said_to_beat_itself(page: Any) -> None:
    page.values |= {name: one["value"] for name, one in page.choose(insect="dronefly").items() if "value" in one}
    names = ("frequency", "flap_amplitude", "flap_shape", "pitch_shape", "alpha_mid", "pitch_phase")
    calm = [page.values["case"], "own", *(page.values[name] for name in names)]
    told = page.words(page.ask("remarks.children", changed="calm.data", calm=calm)["remarks"]["children"])
    assert "uncertainty: Λ ± 19 %, P* ± 14 %" in told
    assert "less power" not in told


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *[("frequency", bad) for bad in (None, math.nan, math.inf, "30", [30], {"a": 1}, True, -1, 1e9)],
        ("flap_amplitude", 91),
        ("flap_shape", 1.0),
        ("pitch_shape", -0.1),
        ("alpha_mid", math.nan),
        ("pitch_phase", 10**400),
        ("case", "made up"),
        ("case", ["hawkmoth"]),
    ],
)
def test_a_number_that_is_not_allowed_is_told_in_one_line(page: Any, field: str, value: Any) -> None:
    page.choose(insect="hawkmoth")
    shown = page.numbers(**{field: value})
    assert shown["props"]["role"] == "alert"
    text = shown["props"]["children"]
    assert "\n" not in text
    assert "Traceback" not in text
    label = {control.name: control.short_label for control in stroke_controls(flapenv.load_insect("hawkmoth"))}
    assert label.get(field, "reload the page") in text
    assert "[" not in text.replace(repr(value), "")  # neither of an array nor of an interval


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("insect", "bat"),
        ("insect", None),
        ("problem", "inertial"),
        ("mass", 0),
        ("mass", math.nan),
        ("mass", 1e6),
        ("wing_length", "13"),
        ("mean_chord", 0.05),
        ("r1_hat", 0.9),
        ("reference_frequency", None),
        ("wing-name", "  "),
        ("wing-name", "two\nlines"),
        ("wing-name", "x" * 61),
        ("wing-name", "hawkmoth"),
        ("wing-name", 5),
    ],
)
def test_a_wing_that_is_not_allowed_is_told_in_one_line(page: Any, field: str, value: Any) -> None:
    answer = page.ask("case.data", **{"insect": OWN_WING} | {field.replace("-", "__"): value})
    assert answer["case"]["data"] is None
    assert answer["note"]["children"]["props"]["role"] == "alert"
    assert "\n" not in answer["note"]["children"]["props"]["children"]


def test_ones_own_wing_is_judged_like_any_other(page: Any) -> None:
    page.choose(insect=OWN_WING)
    shown = page.numbers(frequency=110.0)
    wing = flapenv.Wing(length=13e-3, mean_chord=4e-3, r1_hat=0.49)
    own = flapenv.Stroke(frequency=100, flap_amplitude=math.radians(60), pitch_amplitude=math.radians(55))
    insect = flapenv.Insect(name="my wing", mass=100e-6, wing=wing, stroke=own)
    found = flapenv.evaluate(insect, stroke_of(page))
    assert page.exact(shown)["specific_power"] == pytest.approx(found.specific_power, rel=1e-12)


def test_a_name_is_text_wherever_it_is_shown(page: Any) -> None:
    answer = page.choose(insect=OWN_WING, wing__name="<script>alert(1)</script>")
    assert "<script>alert(1)</script>: 100 mg" in page.words(answer["note"]["children"])  # a child, which React escapes
    shown = page.ask("download.data", changed="export.n_clicks", frequency=100.0)["download"]["data"]
    assert shown["filename"] == "script-alert-1-script-stroke.json"


def test_a_name_of_a_file_is_no_part_of_the_pages_html(base: str) -> None:
    hawkmoth, name = flapenv.load_insect("hawkmoth"), "</script><script>alert(1)</script>"
    insect = flapenv.Insect(name=name, mass=hawkmoth.mass, wing=hawkmoth.wing, stroke=hawkmoth.stroke)
    client = make_app(WingFile(insect=insect)).server.test_client()
    assert "alert" not in client.get("/", base_url=base).text
    layout = client.get("/_dash-layout", base_url=base)
    assert layout.mimetype == "application/json"
    assert name in json.dumps(layout.get_json())


@pytest.mark.parametrize("insect", ["hawkmoth", OWN_WING])
def test_the_exported_file_gives_the_same_stroke_and_insect(page: Any, tmp_path: Path, insect: str) -> None:
    page.choose(insect=insect)
    page.values["frequency"] = 60.0 if insect == OWN_WING else 31.5
    shown = page.ask("download.data", changed="export.n_clicks")["download"]["data"]
    path = tmp_path / shown["filename"]
    path.write_text(shown["content"], encoding="utf-8")
    (read,) = read_strokes(path)
    wanted = stroke_of(page)
    assert {name: getattr(read.stroke, name) for name in STROKE_PARAMETERS} == {
        name: getattr(wanted, name) for name in STROKE_PARAMETERS
    }
    numbers = page.exact(page.numbers())
    assert flapenv.evaluate(read.insect, read.stroke).specific_power == numbers["specific_power"]


def test_figures_and_remarks_follow_the_sliders(page: Any) -> None:
    page.choose(insect="hawkmoth")
    names = ("frequency", "flap_amplitude", "flap_shape", "pitch_shape", "alpha_mid", "pitch_phase")
    calm = [page.values["case"], "optimal", *(page.values[name] for name in names)]
    answer = page.ask("remarks.children", changed="calm.data", calm=calm)
    assert {"figure-beat", "figure-forces", "figure-waveforms", "figure-terms"} < set(answer)
    assert "NaN" not in json.dumps(answer)
    for bad in (None, [], [None] * 8, [*calm[:2], *[math.nan] * 6], [calm[0], "own stroke", *calm[2:]], "x"):
        assert not page.ask("remarks.children", changed="calm.data", calm=bad)
