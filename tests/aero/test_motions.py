"""Motions from Fourier series, samples and functions against the strokes they draw."""

import math

import numpy as np
import pytest
from conftest import strokes
from hypothesis import given, settings

from flapenv import FourierMotion, SampledMotion, Stroke
from flapenv.aero.motions import Kinematics

PHASE = np.linspace(0, 2 * math.pi, 97)
SMOOTH = Stroke(frequency=30.0, flap_amplitude=1.0, pitch_amplitude=0.9, flap_shape=0.0, pitch_shape=0.0)
"""Sinusoids both: φ = sin ωt, θ = 0.9 cos ωt."""
SERIES = FourierMotion(frequency=30.0, flap_sines=[1.0], pitch_cosines=[0.0, 0.9])


def assert_same(a: Kinematics, b: Kinematics, tolerance: float) -> None:
    for name, value in vars(a).items():
        scale = np.max(np.abs(value))
        np.testing.assert_allclose(vars(b)[name], value, atol=tolerance * scale, err_msg=name)


@given(strokes(sharpest_flap=0.9, sharpest_pitch=5.0))
@settings(max_examples=20)
def test_rates_and_accelerations_of_a_stroke_are_derivatives(stroke: Stroke) -> None:
    step = 1e-5
    ahead, here, behind = (Kinematics.of(stroke, PHASE + i * step) for i in (1, 0, -1))
    for angle in ("flap", "pitch"):
        for lower, upper in (("", "_rate"), ("_rate", "_acceleration")):
            change = getattr(ahead, angle + lower) - getattr(behind, angle + lower)
            slope = change / (2 * step) * 2 * math.pi * stroke.frequency
            exact = getattr(here, angle + upper)
            np.testing.assert_allclose(slope, exact, atol=1e-6 * np.max(np.abs(exact)))


def test_a_fourier_series_is_its_sinusoids() -> None:
    assert_same(Kinematics.of(SMOOTH, PHASE), Kinematics.of(SERIES, PHASE), 1e-7)
    assert SERIES.flap_amplitude == pytest.approx(1.0, rel=1e-6)
    assert SERIES.mean_flap_speed == pytest.approx(4 * 30.0, rel=1e-6)  # 4 f φmax


def test_the_mean_of_a_fourier_series_is_half_of_its_first_cosine() -> None:
    offset = FourierMotion(frequency=1.0, flap_cosines=[0.4], flap_sines=[1.0])
    assert np.mean(offset.flap_angle(PHASE[:-1])) == pytest.approx(0.2)


def test_a_spline_through_samples_of_a_stroke_converges_to_it() -> None:
    stroke = Stroke(frequency=26.3, flap_amplitude=1.05, pitch_amplitude=1.0, flap_shape=0.5, pitch_shape=3.0)
    exact, errors = stroke.pitch_angle(PHASE), []
    for n in (16, 64, 256):
        phase = 2 * math.pi * np.arange(n) / n
        motion = SampledMotion(
            frequency=26.3,
            flap_angle_samples=stroke.flap_angle(phase),
            pitch_angle_samples=stroke.pitch_angle(phase),
        )
        errors.append(np.max(np.abs(motion.pitch_angle(PHASE) - exact)))
    assert errors[1] < errors[0] / 30
    assert errors[2] < errors[1] / 100  # fourth order


def test_functions_and_uneven_samples_give_the_stroke_back() -> None:
    exact = Kinematics.of(SMOOTH, PHASE)
    drawn = SampledMotion.from_functions(30.0, SMOOTH.flap_angle, SMOOTH.pitch_angle)
    assert_same(exact, Kinematics.of(drawn, PHASE), 1e-4)
    assert drawn.mean_flap_speed == pytest.approx(SMOOTH.mean_flap_speed, rel=1e-6)
    base = np.linspace(0, 1, 301)
    time = base + 0.05 * np.sin(2 * math.pi * base) / (2 * math.pi)  # runs to 1 and repeats the first sample
    uneven = SampledMotion(
        frequency=30.0,
        flap_angle_samples=SMOOTH.flap_angle(2 * math.pi * time),
        pitch_angle_samples=SMOOTH.pitch_angle(2 * math.pi * time),
        time=time,
    )
    assert_same(exact, Kinematics.of(uneven, PHASE), 1e-3)


def test_samples_that_begin_late_are_closed_over_the_end_of_the_cycle() -> None:
    time = 0.013 + np.arange(200) / 200 * 0.99
    late = SampledMotion(
        frequency=30.0,
        flap_angle_samples=SMOOTH.flap_angle(2 * math.pi * time),
        pitch_angle_samples=SMOOTH.pitch_angle(2 * math.pi * time),
        time=time,
    )
    np.testing.assert_allclose(late.flap_angle(PHASE), SMOOTH.flap_angle(PHASE), atol=1e-6)


def test_samples_from_just_after_the_start_to_the_end_of_the_cycle_are_whole() -> None:
    time = np.arange(1, 201) / 200
    motion = SampledMotion(
        frequency=30.0,
        flap_angle_samples=SMOOTH.flap_angle(2 * math.pi * time),
        pitch_angle_samples=SMOOTH.pitch_angle(2 * math.pi * time),
        time=time,
    )
    np.testing.assert_allclose(motion.flap_angle(PHASE), SMOOTH.flap_angle(PHASE), atol=1e-6)


def test_mean_speed_counts_every_reversal() -> None:
    triple = FourierMotion(frequency=2.0, flap_sines=[0.0, 0.0, 0.5])
    assert triple.mean_flap_speed == pytest.approx(3 * 4 * 2.0 * 0.5, rel=1e-5)
    assert triple.flap_amplitude == pytest.approx(0.5, rel=1e-5)


WAVE = np.sin(2 * math.pi * np.arange(20) / 20).tolist()
CLOSED = np.sin(np.linspace(0, 2 * math.pi, 20)).tolist()


@pytest.mark.parametrize(
    ("fields", "kind", "said"),
    [
        ({"pitch_angle_samples": [*WAVE[:-1], math.nan]}, ValueError, r"pitch_angle_samples\[19\] = nan"),
        ({"pitch_angle_samples": WAVE[:-1]}, TypeError, "columns of equal length"),
        ({"flap_angle_samples": [0.5] * 20}, ValueError, "flapping amplitude of the motion = 0 "),
        ({"flap_angle_samples": [4 * w for w in WAVE]}, ValueError, r"flapping amplitude of the motion = 4 .*3.14159"),
        ({"frequency": 0.0}, ValueError, "frequency = 0 "),
        ({"time": [*np.linspace(0, 0.5, 19), 0.51]}, ValueError, "gap of 0.49 cycles after 0.51, 17.6 times"),
        ({"time": [*np.linspace(0, 0.9, 19), 0.2]}, ValueError, r"time\[19\] = 0.2 does not exceed time\[18\]"),
        (
            {"time": np.linspace(0, 1, 20)},
            ValueError,
            "flap_angle_samples is not periodic: 0 rad, and -0.309017 rad a cycle",
        ),
        ({"time": np.linspace(0, 1.2, 20)}, ValueError, r"time\[16\] = 1.01"),
        ({"time": np.linspace(0.5, 1, 20)}, ValueError, "gap of 0.5 cycles after 1, 19.0 times"),
        (
            {"pitch_angle_samples": CLOSED, "flap_angle_samples": CLOSED},
            ValueError,
            "the last sample repeats the first",
        ),
        ({"tiem": WAVE}, TypeError, "did you mean 'time'"),
    ],
)
def test_bad_samples_are_refused(fields: dict[str, object], kind: type[Exception], said: str) -> None:
    good = {"frequency": 30.0, "flap_angle_samples": WAVE, "pitch_angle_samples": WAVE}
    with pytest.raises(kind, match=said):
        SampledMotion(**{**good, **fields})


@pytest.mark.parametrize(
    ("flap", "kind", "said"),
    [
        (lambda phase: phase, ValueError, "flap_angle is not periodic: 1.72788 rad, and 8.01106 rad a cycle later"),
        (lambda phase: np.sin(phase / 2), ValueError, "flap_angle is not periodic"),
        (lambda phase: np.sin(phase) / (phase < 3), ValueError, r"flap_angle's value\[344\] = (nan|inf)"),
        (lambda phase: 1.0, TypeError, r"flap_angle gives shape \(\)"),
        ("sin", TypeError, "flap_angle = 'sin'"),
    ],
)
def test_bad_functions_are_refused(flap: object, kind: type[Exception], said: str) -> None:
    with np.errstate(all="ignore"), pytest.raises(kind, match=said):
        SampledMotion.from_functions(30.0, flap, np.cos)


def test_bad_coefficients_are_refused() -> None:
    with pytest.raises(ValueError, match=r"flap_sines\[1\] = inf"):
        FourierMotion(frequency=1.0, flap_sines=[1.0, math.inf])
    with pytest.raises(ValueError, match="flapping amplitude of the motion = 0 "):
        FourierMotion(frequency=1.0, pitch_sines=[1.0])
    with pytest.raises(TypeError, match="flap_sines has shape"):
        FourierMotion(frequency=1.0, flap_sines=[[1.0]])
