"""flapenv/Waveform-v0: one step is one wingbeat; draw its waveforms freely."""

from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode

from flapenv.aero.checks import require_flag, require_name
from flapenv.aero.spline_motion import SplineMotion
from flapenv.case import hover_case, stack_cases
from flapenv.envs.arguments import InfoChoice, refuse_unknown
from flapenv.envs.batch import Info
from flapenv.envs.describe import ACTION_HEADER, Row, described, markdown_table, stroke_rows
from flapenv.envs.hover_batch import DEFAULT_PROBLEM, ProblemChoice
from flapenv.envs.insect_choice import InsectChoice, listed_insects, without_infeasible
from flapenv.envs.one_beat import OneBeatEnv
from flapenv.envs.single import SingleEnv
from flapenv.insects import Insect
from flapenv.problem import HoverProblem, as_problem
from flapenv.waveform.coordinates import SPEED_FLOOR, Waveform, WaveformCoordinates
from flapenv.waveform.largest_lift import largest_weight_support
from flapenv.waveform.objective import WaveformObjective, WaveformScore
from flapenv.waveform.performance import peak_rates

DEFAULT_KNOTS = 8


class WaveformVectorEnv(OneBeatEnv):
    """Batched `WaveformEnv`, which describes actions, observations and rewards: one step is one wingbeat in every row.

    Rows are independent but for the one generator that draws their insects, in row order, whatever the others do.
    Batches of different sizes agree to rounding.
    """

    kept = (*OneBeatEnv.kept, "_actions")
    info_keys = (
        "insect",
        "weight_support",
        "specific_power",
        "lift_deficit",
        "reward/power",
        "reward/lift",
        "stroke/frequency",
        "stroke/flap_amplitude",
        "stroke/speed_coefficients",
        "stroke/pitch_coefficients",
        "peak/flap_acceleration",
        "peak/pitch_rate",
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
        knots: int = DEFAULT_KNOTS,
        include_infeasible: bool = False,
        infos: InfoChoice = "all",
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        dtype: Any = "float32",
        render_mode: str | None = None,
        **unknown: Any,
    ) -> None:
        """Look up the references of all insects and set up the spaces; nothing is searched for.

        Args:
            num_envs: rows.
            insect: "all", a name, an `Insect`, the dict of one, or a list of these; drawn uniformly at each reset.
            problem: a name of `PROBLEMS`, a `HoverProblem` or the dict of one; of its box only the bounds of f and φmax
                and the upper bound of the pitch amplitude count.
            knots: n, coefficients of the speed and of the pitch a half-stroke.
            include_infeasible: whether "all" keeps insects that no waveform lifts.
            infos: "all", "none", or the keys wanted.
            autoreset_mode: an `AutoresetMode` or its name.
            dtype: "float32" or "float64", of the computation; observations and actions are float32 always.
            render_mode: "rgb_array" or None.
            **unknown: refused, with the names that exist.

        Raises:
            TypeError: for an unknown argument or one of another kind.
            ValueError: for an unknown name, a value outside its range, or a problem that waveforms do not serve.
        """
        refuse_unknown(unknown, type(self))
        require_flag("include_infeasible", include_infeasible)
        self.problem = as_problem(problem)
        self.coordinates = WaveformCoordinates(self.problem, knots)
        self.dtype = np.dtype(require_name("dtype", getattr(dtype, "__name__", str(dtype)), ("float32", "float64")))
        self.insects = self._chosen_insects(insect, include_infeasible=include_infeasible)
        self.objective = WaveformObjective(self.insects, self.problem, self.coordinates, self.dtype)

        super().__init__(
            num_envs,
            cases=self.objective.cases,
            names=np.array([one.name for one in self.insects], dtype=object),
            r1_hat=np.array([one.wing.r1_hat for one in self.insects]),
            problem=self.problem,
            dtype=self.dtype,
            actions=len(self.coordinates),
            autoreset_mode=autoreset_mode,
            render_mode=render_mode,
            infos=infos,
        )
        self._actions = np.zeros((num_envs, len(self.coordinates)), dtype=np.float32)

    def _chosen_insects(self, choice: InsectChoice, *, include_infeasible: bool) -> tuple[Insect, ...]:
        """The insects to draw from, with a warning about those that no waveform lifts."""
        insects = listed_insects(choice)
        for one in insects:
            self.problem.require_suitable(one.name, one.reference)
        cases = stack_cases([hover_case(one, self.problem.model) for one in insects])
        largest = largest_weight_support(cases, self.problem, self.coordinates)
        margins = {one.name: float(most) for one, most in zip(insects, largest, strict=True) if most < 1}
        dropped = isinstance(choice, str) and choice == "all" and not include_infeasible
        return without_infeasible(insects, margins, "waveform", dropped=dropped, stacklevel=4)

    def _beat(self, actions: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, Info]:
        waveform, clipped = self.coordinates.decode(actions.astype(self.dtype, copy=False), self._own(self._insect))
        score = self.objective.score(self._insect, waveform)
        self._feel(score.weight_support, score.specific_power, mask)
        self._actions[mask] = actions[mask]
        return score.reward, mask.copy(), np.zeros(self.num_envs, dtype=bool), self._info(score, waveform, clipped)

    def _info(self, score: WaveformScore, waveform: Waveform, clipped: np.ndarray) -> Info:
        acceleration, pitch_rate = peak_rates(waveform, score.half_cycle)
        return {
            "insect": self._names[self._insect],
            "weight_support": score.weight_support,
            "specific_power": score.specific_power,
            "lift_deficit": score.lift_deficit,
            "reward/power": score.power_term,
            "reward/lift": score.lift_term,
            "stroke/frequency": waveform.frequency,
            "stroke/flap_amplitude": waveform.flap_amplitude,
            "stroke/speed_coefficients": waveform.speed_coefficients,
            "stroke/pitch_coefficients": waveform.pitch_coefficients,
            "peak/flap_acceleration": acceleration,
            "peak/pitch_rate": pitch_rate,
            "clipped": clipped,
            "bound_gap": score.bound_gap,
            "optimality_gap": score.optimality_gap,
            "_optimality_gap": score.known,
        }

    def _picture(self, row: int) -> np.ndarray:
        from flapenv.drawing import wingbeat_image
        from flapenv.waveform.pictures import waveform_image

        insect, motion = self._last_beat(row)
        if motion is None:
            return wingbeat_image(insect, insect.stroke, self.problem.model)
        return waveform_image(insect, motion, self.problem.model)

    def _last_beat(self, row: int) -> tuple[Insect, SplineMotion | None]:
        """Insect and motion of a row's last wingbeat; None before an episode's first."""
        if not self._has_beaten(row):
            return self.insects[self._insect[row]], None
        number = self._beaten[row]
        waveform, _ = self.coordinates.decode(self._actions[row].astype(self.dtype), self._own(number))
        return self.insects[number], waveform.motion()


def _action_rows(knots: int) -> list[Row]:
    """The action table of problem A."""
    problem = HoverProblem()
    coordinates = WaveformCoordinates(problem, knots)
    names, limit = coordinates.beat.axis_names, np.degrees(coordinates.pitch_limit)
    beat = [(str(number), *row) for number, row in enumerate(stroke_rows(problem.box, names))]
    first, middle, last = len(names), len(names) + knots, len(coordinates)
    return [
        *beat,
        (f"{first} - {middle - 1}", "coefficients of the speed", "w_j", "-", f"{SPEED_FLOOR:g}", "1", "linear"),
        (f"{middle} - {last - 1}", "coefficients of the pitch", "θ_j", "rad", f"-{limit:g}°", f"{limit:g}°", "linear"),
    ]


@described(actions=markdown_table(ACTION_HEADER, _action_rows(DEFAULT_KNOTS)))
class WaveformEnv(SingleEnv):
    """One step is one wingbeat: draw both of its waveforms freely, hover with the least aerodynamic power.

    ## Description
    The flapping rate φ̇ and the pitching angle θ of a pair of wings are periodic cubic B-splines, each half-stroke
    the mirror of the other, with n knots a half-stroke (`flapenv.aero.splines`). Every constraint holds by
    construction: positive speed coefficients make one reversal at each end of the stroke, φ is scaled to its
    amplitude exactly, and |θ| stays within the limit of its coefficients. So the proven bound of `flapenv.optimum`
    holds for every action; in the default problem a triangle and a square wave attain it, which n knots can only
    approach. Each episode is one wingbeat of one insect (docs/waveform.md).

    ## Action space
    `Box(-1, 1, (m,), float32)`, m = 2n and one for each of f and φmax that is free. In the default problem:

    {actions}

    Coefficients run from the beginning of the forward half-stroke to its end. Only ratios of speed coefficients count.
    Finite actions outside [-1, 1] are clipped, as is a frequency q/φmax outside its bounds; `info["clipped"]` says so
    of both. NaN and inf are refused.

    ## Observation space
    `Box(-5, 5, (6,), float32)`, 7 in problem "fixed-frequency". Nothing in it needs the optimum or names the insect.

    | Num | Observation |
    |---|---|
    | 0 | AR - 4, aspect ratio of one wing |
    | 1 | (r̂₁ - 0.51)/0.04, centre of area |
    | 2 | log Λ_ref, weight support at the reference frequency, φmax = 60°, constant speed and α = 35° |
    | - | (φmax - 67.5°)/22.5°, the upper bound of φmax, only where the box takes it from the insect |
    | 3 | last Λ - 1; 0 at the start |
    | 4 | last log(P*/P*_felt), P*_felt from the same yardstick stroke; 0 at the start |
    | 5 | fraction of the episode left |

    ## Rewards
    -P*/P*_ref - λ max(0, 1 - Λ), not below -20. P*_ref is the proven lower bound. λ exceeds the multiplier of the best
    waveform of n knots where that is known without a search, so that the reward's optimum is the constrained optimum
    itself: n = 4, 8, 16, 32, with a free frequency and no profile drag for every wing whose best frequency lies inside
    its bounds, else for most of the eight insects (docs/waveform.md). Elsewhere λ is 10, a guess. Terms:
    `info["reward/power"]`, `info["reward/lift"]`. `info["optimality_gap"]` measures from that best waveform, None where
    it is not known, `info["bound_gap"]` from the bound. `info["peak/flap_acceleration"]` is the largest φ̈/ω² and
    `info["peak/pitch_rate"]` the largest θ̇/ω of the cycle, in radians with the amplitude included: a sinusoid has
    φmax and θmax.

    ## Starting state
    An insect drawn uniformly, or `options={"insect": name}`.

    ## Episode end
    Terminates after one wingbeat; never truncates. A discount factor has nothing to act on.

    ## Arguments
    `insect`, `problem`, `knots`, `include_infeasible`, `dtype`, `render_mode` as in `WaveformVectorEnv`.

    ## Version history
    - v0: first version.
    """

    batch_class = WaveformVectorEnv
