"""Random wings that hover: the pool on which policies and optimisers are compared beyond the eight insects."""

import functools
import inspect
import math
from typing import Any, Literal

import numpy as np

from flapenv.aero import induced
from flapenv.aero.checks import require_count, require_name, require_scalar, shown
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing
from flapenv.insects import Insect, WingFactors, as_insect
from flapenv.many_optima import best_frequency, largest_weight_support
from flapenv.model import HoverModel
from flapenv.problem import PROBLEMS, HoverProblem, as_problem

Split = Literal["train", "test", "outside"]
SPLITS: tuple[Split, ...] = ("train", "test", "outside")
ASPECT_RATIO = (2.6, 5.6)
OUTSIDE_ASPECT_RATIO = ((2.2, 2.6), (5.6, 6.5))
R1_HAT = (0.45, 0.57)
LENGTH = (2e-3, 55e-3)
"""R [m]."""
WING_LOADING = (1.8, 17.0)
"""m g/(2S) [N/m²]; Table 1 spans 1.85 to 16.6."""
FREQUENCY_RATIO = (0.53, 1.30)
"""Frequency of problem A's optimum over the reference frequency; Table 1 spans 0.535 to 1.241."""
FREQUENCY = (15.0, 1000.0)
"""Reference frequencies kept [Hz]."""
AMPLITUDE = (math.radians(45), math.radians(90))
"""φmax of the own stroke [rad]."""
ITERATIONS = 30
"""Of k_tip and the frequency that depend on each other; the change shrinks tenfold and more in each."""
LIKE_ASPECT_RATIO, LIKE_R1_HAT = 0.3, 0.015
"""Wings nearer than both to a species that is left out are its like."""
MOST_BLOCKS, LEAST_SHARE = 8, 0.01
"""After so many blocks a smaller share of accepted wings is taken for a demand that cannot be met."""
BLOCK = 1024
"""Wings drawn at once; a pool is the beginning of an endless sequence, whatever its size."""


def wing_pool(
    size: int,
    *,
    seed: int = 0,
    split: Split = "train",
    min_weight_support: float | None = None,
    problem: HoverProblem | str = "fixed-frequency",
    leave_out: Insect | str | None = None,
) -> Insect:
    """Random wings, their weights and own strokes, as one insect with array fields.

    Aspect ratio, r̂₁, length (log-uniform), wing loading (log-uniform) and u are drawn independently. The reference
    frequency is f_A/u, f_A that of problem A's optimum, so that no single action solves every wing; k_tip
    belongs to the own stroke. φmax of that is uniform, for the problem of fixed amplitude.

    Args:
        size: number of wings.
        seed: of the pool; the splits of a seed are independent of each other.
        split: "train", "test", or "outside", with aspect ratios of 2.2-2.6 and 5.6-6.5 in place of 2.6-5.6.
        min_weight_support: keep only wings whose largest weight support in `problem` is at least this; None keeps all.
        problem: a `HoverProblem` with a proven bound, or a name of `PROBLEMS`; counts with `min_weight_support`.
        leave_out: an insect whose like is left out, wings that differ by less than 0.3 in aspect ratio and by less than
            0.015 in r̂₁.

    Returns:
        An `Insect` named after the pool, every number an array of shape (size,).

    Raises:
        TypeError: for a size or seed that is not a whole number.
        ValueError: for one out of range, an unknown split, or demands that next to no wing meets.
    """
    return _checked_pool(size, seed, split, min_weight_support, problem, leave_out)[0]


def pool_acceptance(size: int, **pool: Any) -> float:
    """The share of draws that a pool keeps, as over the blocks that `wing_pool` drew for it [-]; its arguments."""
    given = inspect.signature(wing_pool).bind(size, **pool)
    given.apply_defaults()
    return _checked_pool(**given.arguments)[1]


def _checked_pool(
    size: int,
    seed: int,
    split: Split,
    min_weight_support: float | None,
    problem: HoverProblem | str,
    leave_out: Insect | str | None,
) -> tuple[Insect, float]:
    """The pool of checked arguments, kept."""
    require_count("size", size)
    require_count("seed", seed, low=0)
    require_name("split", split, SPLITS)
    asked = None
    if min_weight_support is not None:
        min_weight_support = require_scalar("min_weight_support", min_weight_support, 0.0, 3.0)
        asked = as_problem(problem)
        if not asked.model.has_proven_bound:
            raise ValueError(f"problem = {shown(asked.name)} knows no largest weight support of many wings at once")
    unlike = None if leave_out is None else as_insect(leave_out)
    return _pool(size, seed, split, min_weight_support, asked, unlike)


@functools.lru_cache(maxsize=16)
def _pool(
    size: int,
    seed: int,
    split: Split,
    min_weight_support: float | None,
    problem: HoverProblem | None,
    unlike: Insect | None,
) -> tuple[Insect, float]:
    """Draw blocks until enough are accepted; the pool and the share that was."""
    rng = np.random.default_rng(np.random.SeedSequence([seed, SPLITS.index(split)]))
    name, kept, count = f"{split}-{seed}", [], 0
    while count < size:
        drawn, accepted = _block(rng, split, name)
        if problem is not None:
            accepted &= largest_weight_support(drawn, problem) >= min_weight_support
        if unlike is not None:
            near = np.abs(np.asarray(drawn.wing.aspect_ratio) - unlike.wing.aspect_ratio) < LIKE_ASPECT_RATIO
            accepted &= ~(near & (np.abs(np.asarray(drawn.wing.r1_hat) - unlike.wing.r1_hat) < LIKE_R1_HAT))
        table = drawn.k_table
        assert table is not None
        wing, stroke = drawn.wing, drawn.stroke
        columns = (
            *(wing.length, wing.mean_chord, wing.r1_hat, drawn.mass),
            *(stroke.frequency, stroke.flap_amplitude, table.k_ind, table.k_tip),
        )
        kept.append(np.stack(columns)[:, accepted])
        count += int(np.sum(accepted))
        if len(kept) >= MOST_BLOCKS and count < LEAST_SHARE * BLOCK * len(kept):
            raise ValueError(
                f"min_weight_support = {min_weight_support} keeps {count} of {BLOCK * len(kept)} wings; "
                "allowed: what one in a hundred meets"
            )
    return _insects(name, *np.concatenate(kept, axis=1)[:, :size]), count / (BLOCK * len(kept))


def _block(rng: np.random.Generator, split: Split, name: str) -> tuple[Insect, np.ndarray]:
    """`BLOCK` draws and which of them have a frequency that is kept."""
    aspect_ratio, r1_hat = _aspect_ratios(rng, split), rng.uniform(*R1_HAT, BLOCK)
    length, loading = (
        np.exp(rng.uniform(math.log(low), math.log(high), BLOCK)) for low, high in (LENGTH, WING_LOADING)
    )
    ratio, amplitude = rng.uniform(*FREQUENCY_RATIO, BLOCK), rng.uniform(*AMPLITUDE, BLOCK)
    model, problem = HoverModel(), PROBLEMS["free-frequency"]
    wing = Wing(length=length, mean_chord=length / aspect_ratio, r1_hat=r1_hat)
    mass = 2 * wing.area * loading / model.gravity
    k_ind = induced.k_ind(wing)
    downwash = induced.hover_downwash(wing, mass * model.gravity, model.air_density)
    frequency = np.full(BLOCK, 100.0)
    for _ in range(ITERATIONS):  # k_tip belongs to the own stroke, whose frequency follows from the optimum's
        k_tip = induced.k_tip(downwash, 4 * amplitude * frequency * length)
        drawn = _insects(name, length, wing.mean_chord, r1_hat, mass, frequency, amplitude, k_ind, k_tip)
        frequency = best_frequency(drawn, problem) / ratio
    return drawn, (frequency > FREQUENCY[0]) & (frequency < FREQUENCY[1])


def _aspect_ratios(rng: np.random.Generator, split: Split) -> np.ndarray:
    """Aspect ratios of a split; outside, from both ranges in proportion to their width."""
    if split != "outside":
        return rng.uniform(*ASPECT_RATIO, BLOCK)
    (first, last), (start, end) = OUTSIDE_ASPECT_RATIO
    place = rng.uniform(0, last - first + end - start, BLOCK)
    return np.where(place < last - first, first + place, start + place - (last - first))


def _insects(name: str, *columns: np.ndarray) -> Insect:
    """Insects from their columns."""
    length, mean_chord, r1_hat, mass, frequency, amplitude, k_ind, k_tip = columns
    return Insect(
        name=name,
        mass=mass,
        wing=Wing(length=length, mean_chord=mean_chord, r1_hat=r1_hat),
        stroke=Stroke(frequency=frequency, flap_amplitude=amplitude, pitch_amplitude=math.radians(55)),
        k_table=WingFactors(k_ind=k_ind, k_tip=k_tip),
    )
