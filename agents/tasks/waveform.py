"""Waveform-v0 as a task: draw both waveforms freely, beside the best splines of as many knots."""

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from agents.predictor import Predictor, begin
from agents.tasks.held_out import HELD_OUT_SEED, NoiseFree
from agents.tasks.task import Verdict
from flapenv.aero.checks import record, require_count
from flapenv.aero.spline_motion import SplineMotion
from flapenv.envs.insect_choice import listed_insects
from flapenv.envs.waveform import DEFAULT_KNOTS, WaveformVectorEnv
from flapenv.insects import Insect, described
from flapenv.problem import HoverProblem, as_problem
from flapenv.tables import text_table
from flapenv.waveform.shipped import KnownOptimum

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@record
class WaveformTask:
    """Waveform-v0 for one policy.

    Attributes:
        insects: "all", a name, an `Insect`, the dict of one, or a list of these; drawn uniformly at each reset.
        problem: a name of `PROBLEMS`, a `HoverProblem` or the dict of one.
        knots: n, coefficients of the speed and of the pitch a half-stroke.

    Raises:
        TypeError: for insects, a problem or knots of another kind.
        ValueError: for unknown ones, or an insect whose best splines of as many knots are not shipped.
    """

    insects: Any = "all"
    problem: Any = "free-frequency"
    knots: int = DEFAULT_KNOTS

    def __post_init__(self) -> None:
        """Resolve insects and problem, and ask for the optimum of each."""
        object.__setattr__(self, "insects", listed_insects(self.insects))
        object.__setattr__(self, "problem", as_problem(self.problem))
        require_count("knots", self.knots)
        unknown = [one.name for one, best in zip(self._flyers, self._optima, strict=True) if best is None]
        if unknown:
            raise ValueError(
                f"insects: no best splines of {self.knots} knots are known of {', '.join(unknown)} in this problem; "
                "allowed: insects, problems and knots of flapenv/data/spline_optima.csv"
            )

    @property
    def environment(self) -> str:
        """The id."""
        return "flapenv/Waveform-v0"

    @property
    def distance(self) -> str:
        """Of the power to that of the best splines of as many knots, missing weight charged."""
        return "gap to the best splines"

    def vector_env(self, rows: int) -> WaveformVectorEnv:
        """The environment to train in."""
        return self._env(rows, autoreset_mode="SAME_STEP", infos="none")

    def glance(self, policy: Predictor) -> tuple[float, float]:
        """Gaps of the noise-free wingbeats."""
        gaps = self._beat(policy)["optimality_gap"]
        return float(np.mean(gaps)), float(np.max(gaps))

    def judge(self, policy: Predictor) -> Verdict:
        """Weight support, power and gap of the noise-free wingbeat of each insect."""
        beat = self._beat(policy)
        gaps = beat["optimality_gap"]
        header = ("insect", "weight support", "learned W/kg", "best splines", "bound", "gap %", "f Hz", "best f")
        rows, entries = [header], {}
        for number, (insect, best) in enumerate(zip(self._flyers, self._optima, strict=True)):
            assert best is not None
            bound = float(self._judged.objective.bound[number])
            entries[insect.name] = {
                "weight_support": float(beat["weight_support"][number]),
                "specific_power": float(beat["specific_power"][number]),
                "optimum_specific_power": best.specific_power,
                "lower_bound": bound,
                "gap_percent": 100 * float(gaps[number]),
                "frequency": float(beat["stroke/frequency"][number]),
                "flap_amplitude": float(beat["stroke/flap_amplitude"][number]),
                "speed_coefficients": beat["stroke/speed_coefficients"][number].tolist(),
                "pitch_coefficients": beat["stroke/pitch_coefficients"][number].tolist(),
            }
            rows.append(
                (
                    insect.name,
                    f"{beat['weight_support'][number]:.4f}",
                    f"{beat['specific_power'][number]:.2f}",
                    f"{best.specific_power:.2f}",
                    f"{bound:.2f}",
                    f"{100 * gaps[number]:.2f}",
                    f"{beat['stroke/frequency'][number]:.2f}",
                    f"{float(best.waveform.frequency):.2f}",
                )
            )
        mean, worst = float(np.mean(gaps)), float(np.max(gaps))
        closing = f"gap to the best splines of {self.knots} knots: mean {100 * mean:.3f} %, worst {100 * worst:.3f} %"
        return Verdict(mean=mean, worst=worst, text=f"{text_table(rows)}\n{closing}", results={"insects": entries})

    def draw(self, policy: Predictor) -> "Figure":
        """Flapping rate and pitch of every insect, learned over best."""
        from agents.tasks.waveform_picture import draw_learned_waveforms

        beat = self._beat(policy)
        names = ("frequency", "flap_amplitude", "speed_coefficients", "pitch_coefficients")
        pairs = []
        for number, best in enumerate(self._optima):
            assert best is not None
            learned = SplineMotion(**{name: beat[f"stroke/{name}"][number] for name in names})
            pairs.append((learned, best.waveform.motion()))
        labels = [
            f"{insect.name}: gap {100 * gap:.2f} %"
            for insect, gap in zip(self._flyers, beat["optimality_gap"], strict=True)
        ]
        return draw_learned_waveforms(labels, pairs)

    def to_dict(self) -> dict[str, Any]:
        """Insects, problem and knots."""
        problem: HoverProblem = self.problem
        return {
            "insects": [described(insect) for insect in self._flyers],
            "problem": problem.to_dict(),
            "knots": self.knots,
        }

    @property
    def _flyers(self) -> tuple[Insect, ...]:
        flyers: tuple[Insect, ...] = self.insects
        return flyers

    @property
    def _optima(self) -> tuple[KnownOptimum | None, ...]:
        return self._judged.objective.known

    @functools.cached_property
    def _judged(self) -> WaveformVectorEnv:
        """A row for every insect, in double precision."""
        return self._env(len(self._flyers), autoreset_mode="DISABLED", dtype="float64")

    def _env(self, rows: int, **arguments: Any) -> WaveformVectorEnv:
        return WaveformVectorEnv(rows, insect=list(self._flyers), problem=self.problem, knots=self.knots, **arguments)

    def _beat(self, policy: Predictor) -> dict[str, Any]:
        """Infos of the noise-free wingbeat of every insect."""
        names = [insect.name for insect in self._flyers]
        observations, _ = self._judged.reset(seed=HELD_OUT_SEED, options={"insect": names})
        begin(policy)
        info: dict[str, Any] = self._judged.step(NoiseFree(policy)(observations))[-1]
        return info
