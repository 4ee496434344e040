"""flapenv/Hover-v0 as a native vector environment: one step is one wingbeat in every row."""

import math
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode

from flapenv.aero.accelerators import Accelerator
from flapenv.aero.arrays import as_numpy, as_numpy_type, is_tensor
from flapenv.aero.checks import require_count, require_flag, require_name
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.coordinates import Scaling, StrokeCoordinates
from flapenv.envs.arguments import InfoChoice, checked_actions, refuse_unknown, refuse_unused
from flapenv.envs.batch import Info
from flapenv.envs.hover_of_one import HoverOfOne
from flapenv.envs.insect_choice import RANDOM_WING, InsectChoice, choose_insects, choose_pool
from flapenv.envs.one_beat import FIRST_FELT, SMALLEST_POWER, OneBeatEnv
from flapenv.envs.wing_features import OBSERVATION_LIMIT
from flapenv.insects import Insect
from flapenv.objective import HoverObjective, Score
from flapenv.problem import PROBLEMS, HoverProblem, as_problem
from flapenv.references import GapTo
from flapenv.wing_pool import Split

ProblemChoice = str | HoverProblem | Mapping[str, Any]
RewardKind = Literal["scalar", "vector"]
REWARD_KINDS: tuple[RewardKind, ...] = ("scalar", "vector")
DEFAULT_PROBLEM = next(iter(PROBLEMS))


class HoverVectorEnv(OneBeatEnv):
    """Batched `HoverEnv`, which describes actions, observations and rewards: one step is one wingbeat in every row.

    Rows are independent but for the one generator that draws their insects, in row order, whatever the others do.
    Batches of different sizes agree to rounding.
    """

    kept = (*OneBeatEnv.kept, "_stroke")
    info_keys = (
        "insect",
        "weight_support",
        "specific_power",
        "lift_deficit",
        "cost",
        "reward/power",
        "reward/lift",
        *(f"stroke/{name}" for name in STROKE_PARAMETERS),
        "clipped",
        "bound_gap",
        "optimality_gap",
    )

    def __init__(
        self,
        num_envs: int = 1,
        *,
        insect: InsectChoice = "all",
        problem: ProblemChoice = DEFAULT_PROBLEM,
        include_infeasible: bool = False,
        pool_size: int = 4096,
        pool_seed: int = 0,
        pool_split: Split = "train",
        leave_out: Insect | str | None = None,
        gap_to: GapTo = "bound",
        action_scaling: Scaling = "tip-speed",
        reward: RewardKind = "scalar",
        infos: InfoChoice = "all",
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        dtype: Any = "float32",
        threads: int = 1,
        accelerator: Accelerator = "numpy",
        render_mode: str | None = None,
        **unknown: Any,
    ) -> None:
        """Solve the references of all insects (once per process) and set up the spaces.

        Args:
            num_envs: rows.
            insect: "all", a name, an `Insect`, the dict of one, or a list of these; or "random-wing", a pool of wings.
                Drawn uniformly at each reset.
            problem: a name of `PROBLEMS`, a `HoverProblem` or the dict of one.
            include_infeasible: whether "all" keeps insects that no stroke of the box lifts.
            pool_size: of "random-wing", the number of wings.
            pool_seed: of "random-wing", which pool.
            pool_split: of "random-wing": "train", "test" or "outside", see `flapenv.wing_pool.wing_pool`.
            leave_out: of "random-wing", an insect whose like is left out.
            gap_to: of "random-wing": "optimum" solves every wing of the pool, for `info["optimality_gap"]`.
            action_scaling: how actions run over the box; see `StrokeCoordinates`.
            reward: "scalar", or "vector" for (power, deficit), shape (num_envs, 2).
            infos: "all", "none", or the keys wanted.
            autoreset_mode: an `AutoresetMode` or its name.
            dtype: "float32" or "float64", of the computation; observations and actions are float32 always.
            threads: how many work at once; worth it from some 16,384 rows on.
            accelerator: "numpy", or "numba" (the extra "fast"), the same compiled, for forces normal to the chord.
            render_mode: "rgb_array" or None.
            **unknown: refused, with the names that exist.

        Raises:
            TypeError: for an unknown argument or one of another kind.
            ValueError: for an unknown name or a value outside its range.
            ImportError: where the accelerator is not installed.
        """
        refuse_unknown(unknown, type(self))
        require_flag("include_infeasible", include_infeasible)
        require_count("threads", threads)
        require_name("reward", reward, REWARD_KINDS)
        self.problem = as_problem(problem)
        self.dtype = np.dtype(require_name("dtype", getattr(dtype, "__name__", str(dtype)), ("float32", "float64")))
        self.coordinates = StrokeCoordinates(self.problem.box, scaling=action_scaling)
        if not len(self.coordinates):
            raise ValueError("box fixes every parameter; allowed: at least one with lower < upper")
        own: dict[str, Any] = {"pool_size": pool_size, "pool_seed": pool_seed, "pool_split": pool_split}
        own |= {"leave_out": leave_out, "gap_to": gap_to}
        if isinstance(insect, str) and insect == RANDOM_WING:
            refuse_unused({"include_infeasible": include_infeasible}, type(self), "insect = 'all'")
            insects: Any = choose_pool(
                self.problem, size=pool_size, seed=pool_seed, split=pool_split, leave_out=leave_out
            )
        else:
            refuse_unused(own, type(self), f"insect = {RANDOM_WING!r}")
            insects = choose_insects(insect, self.problem, include_infeasible=include_infeasible)
        self.objective = HoverObjective(
            insects, self.problem, self.dtype, gap_to=gap_to, threads=threads, accelerator=accelerator
        )
        self.flyers, self.accelerator = self.objective.flyers, accelerator

        self._require_finite_power()
        super().__init__(
            num_envs,
            cases=self.objective.cases,
            names=self.flyers.names,
            r1_hat=self.flyers.r1_hat,
            problem=self.problem,
            dtype=self.dtype,
            actions=len(self.coordinates),
            autoreset_mode=autoreset_mode,
            render_mode=render_mode,
            infos=infos,
            reward_space=spaces.Box(self.problem.reward_floor, 0.0, (2,), np.float64) if reward == "vector" else None,
        )
        self._stroke = {name: np.zeros(num_envs, dtype=self.dtype) for name in STROKE_PARAMETERS}

    def _require_finite_power(self) -> None:
        """Refuse frequencies whose power the type of the computation cannot hold."""
        cases, box = self.objective.cases, self.problem.box
        frequency, amplitude = (box.bounds(name, cases.reference)[1] for name in ("frequency", "flap_amplitude"))
        largest = float(np.max(1e3 * cases.power_scale * (4.0 * frequency * amplitude) ** 3))
        if not largest < float(np.finfo(self.dtype).max):
            raise ValueError(
                f"upper bound of frequency = {float(np.max(frequency)):.6g} is not allowed with dtype = "
                f"'{self.dtype.name}', whose numbers end before the power; allowed: a lower one"
            )

    def _beat(self, actions: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, Info]:
        strokes, clipped = self.coordinates.decode(actions.astype(self.dtype, copy=False), self._own(self._insect))
        score = self.objective.score(self._insect, strokes)
        self._feel(score.weight_support, score.specific_power, mask)
        if self.render_mode is not None:
            for name, value in strokes.items():
                np.copyto(self._stroke[name], value, where=mask)
        reward = score.reward
        if self.reward_space is not None:
            reward = np.maximum(np.stack([score.power_term, -score.lift_deficit], axis=-1), self.problem.reward_floor)
        return reward, mask.copy(), np.zeros(self.num_envs, dtype=bool), self._info(score, strokes, clipped)

    def differentiable_reward(self, actions: Any) -> Any:
        """What every row would be paid if it beat so now, with its gradient; nothing is stepped, no floor applied.

        Args:
            actions: tensor of shape (num_envs, n), float32 or float64, finite; clipped to [-1, 1], beyond which there
                is no gradient (on a face itself there is one or none, as its bound is rounded).

        Returns:
            The sum of power and lift term of every row, whatever `reward` says; a tensor of shape (num_envs,).

        Raises:
            TypeError: for actions that are no tensor of such numbers.
            ValueError: for actions of another shape, or with NaN or inf.
            gymnasium.error.ResetNeeded: before the first reset, and where a row has ended.
        """
        self._require_running()
        kind = as_numpy_type(actions).name if is_tensor(actions) else type(actions).__name__
        if kind not in ("float32", "float64"):
            raise TypeError(f"actions of type {kind} are not allowed; allowed: a tensor of float32 or float64")
        checked_actions("actions", as_numpy(actions), self.action_space.shape)
        strokes, _ = self.coordinates.decode(actions, self._own(self._insect))
        return -self.objective.cost(self._insect, strokes)[-1]

    def start_one(self, generator: np.random.Generator) -> tuple[np.ndarray, Info]:
        """`start` for a batch of one without options, whose insect a generator draws."""
        self.np_random = generator
        self._insect = generator.integers(len(self.flyers), size=1)
        self._felt[0] = FIRST_FELT
        self._ended[0], self._begun = False, True
        number = self._insect.item()
        info = {} if "insect" in self.unwanted else {"insect": self.flyers.names[number]}
        return self._first_seen[number].copy(), info

    def advance_one(self, beat: HoverOfOne, action: np.ndarray) -> tuple[np.ndarray, Any, bool, bool, Info]:
        """`advance` for a batch of one, in plain numbers: what a scalar environment's step gives.

        Raises:
            gymnasium.error.ResetNeeded: before a reset, and after the end of an episode.
        """
        self._require_running()
        number = self._insect.item()
        results = beat(action, number)
        weight_support, power, deficit, power_term, lift_term, bound_gap, gap, clipped = results[6:]
        self._ended[0], self._beaten[0] = True, number
        for value, column in zip(results, self._stroke.values(), strict=False):
            column[0] = value
        ratio = max(power, SMALLEST_POWER) / self._felt_power.item(number)
        low, high = -OBSERVATION_LIMIT, OBSERVATION_LIMIT
        felt = max(min(weight_support - 1, high), low), max(min(math.log(ratio), high), low), 0.0
        self._felt[0] = felt
        observation = self._first_seen[number].copy()
        observation[-3:] = felt
        floor = self.problem.reward_floor
        reward: Any = max(power_term + lift_term, floor)
        if self.reward_space is not None:
            reward = np.array([max(power_term, floor), max(-deficit, floor)])
        terms = weight_support, power, deficit, deficit, power_term, lift_term
        own_gap = gap if self.objective.has_gap[number] else None
        values = self.flyers.names[number], *terms, *results[:6], clipped > 0, bound_gap, own_gap
        info: Info = dict(zip(self.info_keys, values, strict=True))
        if self.unwanted:
            info = {key: value for key, value in info.items() if key not in self.unwanted}
        return observation, reward, True, False, info

    def _info(self, score: Score, strokes: dict[str, np.ndarray], clipped: np.ndarray) -> Info:
        return {
            "insect": self.flyers.names[self._insect],
            "weight_support": score.weight_support,
            "specific_power": score.specific_power,
            "lift_deficit": score.lift_deficit,
            "cost": score.lift_deficit.copy(),
            "reward/power": score.power_term,
            "reward/lift": score.lift_term,
            **{f"stroke/{name}": value for name, value in strokes.items()},
            "clipped": clipped,
            "bound_gap": score.bound_gap,
            "_bound_gap": score.has_bound,
            "optimality_gap": score.optimality_gap,
            "_optimality_gap": score.has_gap,
        }

    def _picture(self, row: int) -> np.ndarray:
        from flapenv.drawing import wingbeat_image

        return wingbeat_image(*self._last_beat(row), self.problem.model)

    def _last_beat(self, row: int) -> tuple[Insect, Stroke]:
        """Insect and stroke of a row's last wingbeat; the insect's own stroke before an episode's first."""
        if not self._has_beaten(row):
            insect = self.flyers[int(self._insect[row])]
            return insect, insect.stroke
        values = {name: float(value[row]) for name, value in self._stroke.items()}
        return self.flyers[int(self._beaten[row])], Stroke(**values)
