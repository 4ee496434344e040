"""Fixtures and strategies shared by the tests."""

import math

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st

from flapenv import INSECTS, Insect, Stroke, Wing, load_insect

settings.register_profile("flapenv", deadline=None, max_examples=60, derandomize=True)
settings.load_profile("flapenv")


def strokes(*, sharpest_flap: float = 0.99, sharpest_pitch: float = 10.0) -> st.SearchStrategy[Stroke]:
    """Strokes of problem A's box, opened towards the triangle and the square wave."""
    return st.builds(
        Stroke,
        frequency=st.floats(5, 500),
        flap_amplitude=st.floats(math.radians(40), math.radians(90)),
        pitch_amplitude=st.floats(math.radians(45), math.radians(65)),
        flap_shape=st.floats(0.0, sharpest_flap),
        pitch_shape=st.floats(0.0, sharpest_pitch),
        pitch_phase=st.floats(math.radians(60), math.radians(120)),
    )


def wings() -> st.SearchStrategy[Wing]:
    """Wings of insects' sizes and shapes."""
    return st.builds(
        Wing,
        length=st.floats(2e-3, 60e-3),
        mean_chord=st.floats(5e-4, 2e-2),
        r1_hat=st.floats(0.44, 0.58),
    )


def yardstick_stroke(frequency: float) -> Stroke:
    """The stroke of Λ_ref and P*_felt: φmax = 60°, constant speed and constant α = 35°."""
    return Stroke(
        frequency=frequency,
        flap_amplitude=math.radians(60),
        pitch_amplitude=math.radians(55),
        flap_shape=1.0,
        pitch_shape=1e9,
    )


@pytest.fixture(params=INSECTS)
def insect(request: pytest.FixtureRequest) -> Insect:
    """Each of the eight insects in turn."""
    return load_insect(request.param)


@pytest.fixture
def hawkmoth() -> Insect:
    """The hawkmoth."""
    return load_insect("hawkmoth")


@pytest.fixture
def rng() -> np.random.Generator:
    """A seeded generator."""
    return np.random.default_rng(20141)
