"""flapenv/Hover-v0: one step is one wingbeat; hover with the least power."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from flapenv.aero.accelerators import Accelerator
from flapenv.coordinates import StrokeCoordinates
from flapenv.envs.arguments import checked_actions
from flapenv.envs.batch import Info
from flapenv.envs.describe import action_table, described, stroke_rows
from flapenv.envs.hover_batch import HoverVectorEnv
from flapenv.envs.hover_of_one import HoverOfOne, serves
from flapenv.envs.single import SingleEnv
from flapenv.problem import HoverProblem


@described(actions=action_table(stroke_rows(HoverProblem().box, StrokeCoordinates(HoverProblem().box).axis_names)))
class HoverEnv(SingleEnv):
    """One step is one wingbeat: choose its kinematics, hover with the least aerodynamic power.

    ## Description
    A pair of wings beats in a horizontal stroke plane with the waveforms (2.1), (2.2) of Nabawy & Crowther (2014, Part
    II). Their quasi-steady model gives the weight support Λ and the specific power P*. Each episode is one wingbeat
    of one insect; its optimum is known, with a proven lower bound (`flapenv.optimum`).

    ## Action space
    `Box(-1, 1, (n,), float32)`, one row a free parameter, fixed ones dropped. In the default problem:

    {actions}

    Finite actions outside [-1, 1] are clipped, as is a frequency q/φmax outside its bounds; `info["clipped"]` says so
    of both. NaN and inf are refused.

    ## Observation space
    `Box(-5, 5, (6,), float32)`, 7 in problem "fixed-frequency". Nothing in it needs the optimum or names the insect.

    | Num | Observation |
    |---|---|
    | 0 | AR - 4, aspect ratio of one wing |
    | 1 | (r̂₁ - 0.51)/0.04, centre of area |
    | 2 | log Λ_ref, weight support at the reference frequency, φmax = 60°, constant speed and α = 35° |
    | - | log(f/f_ref) at both bounds of f, only where the box has them in Hz |
    | - | (φmax - 67.5°)/22.5° at both bounds of φmax, only where the box takes them from the insect; one if fixed |
    | 3 | last Λ - 1; 0 at the start |
    | 4 | last log(P*/P*_felt), P*_felt from the same yardstick stroke; 0 at the start |
    | 5 | fraction of the episode left |

    ## Rewards
    -P*/P*_ref - λ max(0, 1 - Λ), not below -20. P*_ref is the proven lower bound (the optimum where the
    coefficients leave no proof), so the best return is about -1.045 in the default problem. λ exceeds the multiplier of
    the constrained optimum, so that the reward's optimum is the constrained optimum itself, globally so in the default
    problem (docs/optimum.md). Terms: `info["reward/power"]`, `info["reward/lift"]`. With `reward="vector"` it is the
    pair (-P*/P*_ref, -max(0, 1 - Λ)) instead, each not below -20. `info["cost"]` = max(0, 1 - Λ) is the cost that
    constrained learners ask for.

    ## Starting state
    An insect drawn uniformly, or `options={"insect": name}`. `insect="random-wing"` draws from a pool of wings that no
    single action solves (`flapenv.wing_pool`), with splits for training and test.

    ## Episode end
    Terminates after one wingbeat; never truncates. A discount factor has nothing to act on.

    ## Arguments
    `insect` and `problem` choose what is flown, `pool_...`, `leave_out` and `gap_to` belong to "random-wing",
    `action_scaling`, `reward`, `infos`, `dtype`, `threads` and `accelerator` how it is put. `HoverVectorEnv` and the
    documentation list all with their defaults. Infos, the same keys on every step: `insect`, `weight_support`,
    `specific_power` [W/kg], `lift_deficit`, `cost`, the reward's terms, `stroke/...` [SI], `clipped`, `bound_gap` and
    `optimality_gap`, None where there is none.

    ## Version history
    - v0: first version.
    """

    batch_class = HoverVectorEnv

    def __init__(self, *, render_mode: str | None = None, **arguments: Any) -> None:
        """Make a batch of one; arguments as `SingleEnv`."""
        super().__init__(render_mode=render_mode, **arguments)
        batch = self._hover
        self._beat: HoverOfOne | None = None
        if serves(batch.problem.model):
            self._beat = HoverOfOne(batch.objective, batch.coordinates, _compiled_beat(batch.accelerator))
        self._shape = self.action_space.shape

    @property
    def _hover(self) -> HoverVectorEnv:
        """The batch."""
        assert isinstance(self.batch, HoverVectorEnv)
        return self.batch

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[np.ndarray, Info]:
        """Begin an episode; `options={"insect": name}` chooses the insect.

        Raises:
            TypeError: for a seed or options of another type.
            ValueError: for an unknown option.
        """
        if seed is not None or options is not None or self._beat is None:
            return super().reset(seed=seed, options=options)
        return self._hover.start_one(self.np_random)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, Any, bool, bool, Info]:
        """One wingbeat, in plain numbers where the model allows it; all else as `SingleEnv`."""
        if self._beat is None:
            return super().step(action)
        plain = type(action) is np.ndarray and action.dtype == np.float32 and action.shape == self._shape
        if not plain or not math.isfinite(sum(action.tolist())):
            action = checked_actions("action", action, self._shape)
        return self._hover.advance_one(self._beat, action)


def _compiled_beat(accelerator: Accelerator) -> Callable[..., None] | None:
    """What `HoverOfOne` runs in place of plain Python, if anything."""
    if accelerator == "numpy":
        return None
    from flapenv.envs.hover_compiled import beat

    run: Callable[..., None] = beat
    return run
