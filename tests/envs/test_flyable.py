"""What no environment can fly is refused when it is made, by a line that names the insect; all that flies is taken."""

import dataclasses
import math
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flapenv import INSECTS, HoverProblem, Insect, load_insect
from flapenv.envs import HoverVectorEnv
from flapenv.envs.flyable import FLYABLE, require_flyable
from flapenv.envs.heave_batch import HeaveVectorEnv
from flapenv.envs.hover_adapt import HoverAdaptVectorEnv
from flapenv.envs.waveform import WaveformVectorEnv
from flapenv.insects import pick
from flapenv.model import HoverModel
from flapenv.wing_pool import wing_pool

FAMILY: tuple[Any, ...] = (HoverVectorEnv, HoverAdaptVectorEnv, WaveformVectorEnv, HeaveVectorEnv)
QUICK: tuple[Any, ...] = (WaveformVectorEnv, HeaveVectorEnv)


def changed(wing: dict[str, float] | None = None, stroke: dict[str, float] | None = None, **own: Any) -> Insect:
    base = load_insect("bumblebee")
    parts = {
        "wing": dataclasses.replace(base.wing, **wing or {}),
        "stroke": dataclasses.replace(base.stroke, **stroke or {}),
    }
    return dataclasses.replace(base, name="mine", **parts, **own)


BEYOND = (
    (changed(mass=1e-15), "lift at its own stroke over weight"),
    (changed(mass=1e10), "lift at its own stroke over weight"),
    (changed(wing={"length": 1e5}), "wing length"),
    (changed(wing={"length": 1e-10}), "wing length"),
    (changed(wing={"mean_chord": 1e-14}), "wing length over mean chord"),
    (changed(stroke={"frequency": 1e14}), "reference frequency"),
    (changed(stroke={"frequency": 1e-14}), "reference frequency"),
    (changed(stroke={"flap_amplitude": 1e-14}), "reference amplitude"),
    (changed(k_table={"k_ind": 1e10, "k_tip": 1.0}), "induced power factor"),
)


@pytest.mark.parametrize("kind", FAMILY, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize(
    ("insect", "what"), BEYOND, ids=[f"{what} {number}" for number, (_, what) in enumerate(BEYOND)]
)
def test_an_insect_of_numbers_only_is_refused_by_every_environment(kind: Any, insect: Insect, what: str) -> None:
    with pytest.raises(ValueError, match=rf"insect mine: {what} = .* is not allowed in an environment; allowed: \["):
        kind(1, insect=insect)


def test_all_insects_and_the_wings_of_a_pool_are_far_within() -> None:
    pool = wing_pool(32)
    flyers = [*map(load_insect, INSECTS), *(pick(pool, number) for number in range(32))]
    with np.errstate(all="raise"):
        require_flyable(flyers, HoverModel())
    for low, high, _ in FLYABLE.values():
        assert low < high


def scaled(name: str, size: float) -> Insect:
    """An insect whose every length is so many times larger, flapping slower with it."""
    base = load_insect(name)
    return dataclasses.replace(
        base,
        name="mine",
        mass=max(base.mass * size**3, 1e-14),  # the least but a little that an insect may have
        wing=dataclasses.replace(base.wing, length=base.wing.length * size, mean_chord=base.wing.mean_chord * size),
        stroke=dataclasses.replace(base.stroke, frequency=base.stroke.frequency * size**-0.5),
        k_table=None,
    )


def test_from_a_thrips_to_an_ornithopter_of_16_m_everything_flies() -> None:
    smallest, largest = load_insect("fruitfly"), load_insect("hawkmoth")
    flyers = [scaled("fruitfly", 0.5e-3 / smallest.wing.length), scaled("hawkmoth", 8.0 / largest.wing.length)]
    with np.errstate(all="raise"):
        require_flyable(flyers, HoverModel())


@pytest.mark.parametrize(("name", "length"), [("fruitfly", 0.5e-6), ("hawkmoth", 8e3)])
def test_a_thousand_times_smaller_or_larger_is_refused(name: str, length: float) -> None:
    insect = scaled(name, length / load_insect(name).wing.length)
    with pytest.raises(ValueError, match=r"insect mine: wing length = .* is not allowed in an environment"):
        require_flyable([insect], HoverModel())


@given(
    scales=st.fixed_dictionaries({"length": st.floats(-2, 2), "mass": st.floats(-3, 3), "frequency": st.floats(-2, 2)}),
    kind=st.sampled_from(QUICK),
    bits=st.binary(min_size=40, max_size=40),
    dtype=st.sampled_from(("float32", "float64")),
)
def test_what_is_taken_gives_finite_numbers_whatever_the_actions(
    scales: dict[str, float], kind: Any, bits: bytes, dtype: str
) -> None:
    base, scale = load_insect("bumblebee"), {name: 10**power for name, power in scales.items()}
    insect = changed(
        wing={"length": base.wing.length * scale["length"], "mean_chord": base.wing.mean_chord * scale["length"]},
        stroke={"frequency": base.stroke.frequency * scale["frequency"]},
        mass=base.mass * scale["mass"],
        k_table=None,
    )
    with warnings.catch_warnings(), np.errstate(all="raise", under="ignore"):
        warnings.simplefilter("ignore", UserWarning)  # of wings that cannot hover
        try:
            env = kind(1, insect=insect, dtype=dtype)
        except ValueError:  # beyond what flies
            return
        env.reset(seed=0)
        size = env.action_space.shape[1]
        seen, rewards, _, _, info = env.step(np.resize(np.frombuffer(bits, np.int8), (1, size)) / np.float32(50))
    assert np.isfinite(seen).all()
    assert np.isfinite(rewards).all()
    for key, value in info.items():
        if not key.startswith("_") and value.dtype.kind == "f":
            assert np.isfinite(value[info[f"_{key}"]]).all(), key


@pytest.mark.parametrize("kind", [HoverVectorEnv, WaveformVectorEnv])
def test_a_frequency_whose_power_single_precision_cannot_hold_is_refused(kind: Any) -> None:
    problem = HoverProblem(box={"frequency": (1.0, 1e14)})
    with pytest.raises(ValueError, match=r"upper bound of frequency = 1e[+]14 is not allowed with dtype = 'float32'"):
        kind(1, insect="hawkmoth", problem=problem)


def test_an_accelerator_that_is_no_name_is_refused_like_a_wrong_one() -> None:
    with pytest.raises(ValueError, match=r"accelerator = \{\} is unknown; allowed: numpy, numba"):
        HoverVectorEnv(1, insect="hawkmoth", accelerator={})


@pytest.mark.parametrize("kind", FAMILY, ids=lambda kind: kind.__name__)
def test_wrong_actions_and_options_are_told_in_one_short_line(kind: Any) -> None:
    env = kind(64, insect="hawkmoth")
    env.reset(seed=0)
    several = np.full(env.action_space.shape, "x", dtype=object)
    for call in (
        lambda: env.step(several),
        lambda: env.reset(options={"x": several}),
        lambda: env.reset(options=several),
    ):
        with pytest.raises((TypeError, ValueError), match="allowed") as caught:
            call()
        assert str(caught.value).isprintable()
        assert len(str(caught.value)) < 500
    with pytest.raises(TypeError, match="is not an argument of this environment") as caught:
        kind(1, **{"a\nb": 1})
    assert str(caught.value).isprintable()
    assert math.isfinite(env.num_envs)
