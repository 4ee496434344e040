"""The figure of the beating wing: the numbers of the film, few bytes, one scale, no name that acts."""

import json
import re

import numpy as np
import pytest

import flapenv
from agents.plots.beat import beat
from flapenv.animation.beat import drawn_beat

HAWKMOTH = flapenv.load_insect("hawkmoth")
MODEL = flapenv.HoverModel()
STROKES = {"learned": flapenv.optimum("hawkmoth").stroke, "own": HAWKMOTH.stroke}


def test_the_mean_of_the_drawn_arrows_is_the_weight_support() -> None:
    figure = beat(HAWKMOTH, {"own": HAWKMOTH.stroke}, MODEL)
    bar = next(trace for trace in figure.data if trace.text and "1 weight" in trace.text[1])
    unit = bar.y[1] - bar.y[0]
    arrows = [frame["y"][2] for frame in figure.layout.meta["beat"]["frames"]]
    lifts = [(tip - foot) / unit for foot, tip in arrows]
    assert np.mean(lifts) == pytest.approx(flapenv.evaluate(HAWKMOTH).weight_support, rel=2e-3)


def test_the_sections_are_those_of_the_film() -> None:
    figure = beat(HAWKMOTH, {"own": HAWKMOTH.stroke}, MODEL, frames=12)
    film = drawn_beat(HAWKMOTH, frames=12)
    for frame, row in zip(figure.layout.meta["beat"]["frames"], film.rows, strict=True):
        chord = np.array([frame["x"][0], frame["y"][0]]).T
        assert chord == pytest.approx(np.array([film.trailing[row], film.leading[row]]), rel=1e-3, abs=1e-3)


def test_all_strokes_share_one_scale_and_stay_inside() -> None:
    figure = beat(HAWKMOTH, STROKES, MODEL)
    assert figure.layout.xaxis.range == figure.layout.xaxis2.range
    assert figure.layout.yaxis.range == figure.layout.yaxis2.range
    low, high = figure.layout.yaxis.range
    left, right = figure.layout.xaxis.range
    for frame in figure.layout.meta["beat"]["frames"]:
        for x, y in zip(frame["x"], frame["y"], strict=True):
            assert left <= min(x) <= max(x) <= right
            assert low <= min(y) <= max(y) <= high


def test_two_strokes_of_48_frames_take_less_than_40_kb() -> None:
    text = beat(HAWKMOTH, STROKES, MODEL).to_json()
    assert len(text) < 40_000
    meta = json.loads(text)["layout"]["meta"]["beat"]
    assert len(meta["frames"]) == 48
    assert len(meta["traces"]) == len(meta["frames"][0]["x"]) == len(meta["frames"][0]["y"])


def test_the_first_frame_is_drawn() -> None:
    figure = beat(HAWKMOTH, STROKES, MODEL)
    meta = figure.layout.meta["beat"]
    for number, x in zip(meta["traces"], meta["frames"][0]["x"], strict=True):
        assert list(figure.data[number].x) == list(x)


def test_a_label_is_text_and_not_markup() -> None:
    text = beat(HAWKMOTH, {"<script>alert(1)</script>": HAWKMOTH.stroke}, MODEL, frames=4).to_json()
    assert "<script>alert" not in text


def test_the_beat_is_the_model_s_and_counts_what_the_model_counts() -> None:
    for model in (flapenv.HoverModel(profile_drag=0.5), flapenv.HoverModel(accounting="positive")):
        frames = beat(HAWKMOTH, {"own": HAWKMOTH.stroke}, model).layout.meta["beat"]["frames"]
        told = [frame["text"][3][0] for frame in frames]
        lifts, powers = zip(*(re.findall(r"lift (\S+) weights, (\S+) W/kg", text)[0] for text in told), strict=True)
        film = drawn_beat(HAWKMOTH, model=model, frames=48)
        counted = film.history.paid_power(model.accounting)[film.rows] / HAWKMOTH.mass
        assert [float(power) for power in powers] == pytest.approx(counted, abs=0.06)
        assert np.mean(film.history.paid_power(model.accounting)) / HAWKMOTH.mass == pytest.approx(film.mean_power)
        assert [float(lift) for lift in lifts] == pytest.approx(film.force[film.rows, 1], abs=0.006)


def test_the_title_says_how_much_slower_the_wing_beats_than_in_life() -> None:
    figure = beat(HAWKMOTH, {"own": HAWKMOTH.stroke}, MODEL)
    slower = HAWKMOTH.stroke.frequency * figure.layout.meta["beat"]["seconds"]
    assert figure.layout.annotations[0].text == f"<b>own</b>: 26.3 Hz, shown {slower:.0f}× slower"
