"""Heave-v0 as a task: hold height in gusts, beside LQG through the same ones."""

import functools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from agents.heave_flights import EPISODES, Flights, Policy, compare_with_front, fly
from agents.intervals import mean_with_interval
from agents.lqg import RATIOS
from agents.lqg_controller import OneEach, lqg
from agents.predictor import Predictor
from agents.tasks.held_out import HELD_OUT_SEED, NoiseFree
from agents.tasks.task import Verdict
from flapenv.aero.checks import record
from flapenv.envs.heave_batch import HeaveVectorEnv
from flapenv.envs.insect_choice import listed_insects
from flapenv.insects import Insect, described
from flapenv.tables import text_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BEATS = 200
"""Of an episode, the environment's own."""
GLANCES = 8
"""Episodes of every insect at a glance."""
GLANCED_RATIO = 0.2
"""Weight of the input of the LQG that a glance compares with: about that of the greatest return for the eight."""


@record
class HeaveTask:
    """Heave-v0 for one policy.

    Attributes:
        insects: "all", a name, an `Insect`, the dict of one, or a list of these; drawn uniformly at each reset.
    """

    insects: Any = "all"

    def __post_init__(self) -> None:
        """Resolve the insects."""
        object.__setattr__(self, "insects", listed_insects(self.insects))

    @property
    def environment(self) -> str:
        """The id."""
        return "flapenv/Heave-v0"

    @property
    def distance(self) -> str:
        """Of the mean return to that of the best LQG, over the beats of an episode."""
        return "cost of a beat above the best LQG's, in hovering powers"

    def vector_env(self, rows: int) -> HeaveVectorEnv:
        """The environment to train in."""
        return HeaveVectorEnv(rows, insect=list(self._flyers), autoreset_mode="SAME_STEP", infos="none")

    def glance(self, policy: Predictor) -> tuple[float, float]:
        """The verdict on few gusts, beside one LQG that is flown once."""
        behind = np.mean(self._glanced_lqg - self._glanced_returns(NoiseFree(policy)), axis=1) / BEATS
        return float(np.mean(behind)), float(np.max(behind))

    def judge(self, policy: Predictor) -> Verdict:
        """Returns, and power at equal height, beside LQG's front through the same gusts."""
        act = NoiseFree(policy)
        entries = {}
        for insect in self._flyers:
            own = fly(act, episodes=EPISODES, seed=HELD_OUT_SEED, insect=insect, dtype="float64")
            entries[insect.name] = _entry(own, lqg_flights(insect), BEATS)
        behind = [entry["cost_above_lqg"] for entry in entries.values()]
        return Verdict(
            mean=float(np.mean(behind)),
            worst=float(np.max(behind)),
            text=_table(entries),
            results={"episodes_of_each": EPISODES, "insects": entries},
        )

    def draw(self, policy: Predictor) -> "Figure":
        """The policy on LQG's front and one of its episodes, for the first insect."""
        from agents.tasks.heave_picture import draw_beside_front

        return draw_beside_front(self._flyers[0], NoiseFree(policy), HELD_OUT_SEED)

    def to_dict(self) -> dict[str, Any]:
        """The insects."""
        return {"insects": [described(insect) for insect in self._flyers]}

    @property
    def _flyers(self) -> tuple[Insect, ...]:
        flyers: tuple[Insect, ...] = self.insects
        return flyers

    def _glanced_returns(self, act: Policy) -> np.ndarray:
        """Shape (insects, episodes)."""
        names = [insect.name for insect in self._flyers for _ in range(GLANCES)]
        options = {"insect": names}
        flown = fly(act, episodes=len(names), seed=HELD_OUT_SEED, options=options, insect=list(self._flyers))
        return flown.returns.reshape(len(self._flyers), GLANCES)

    @functools.cached_property
    def _glanced_lqg(self) -> np.ndarray:
        """Of an LQG for each insect, shape (insects, episodes)."""
        return self._glanced_returns(OneEach([lqg(insect, GLANCED_RATIO) for insect in self._flyers], GLANCES))


@functools.lru_cache(maxsize=16)
def lqg_flights(insect: Insect) -> tuple[Flights, ...]:
    """LQG's front of one insect on the held-out gusts; some two seconds, then kept."""
    return tuple(
        fly(lqg(insect, ratio), episodes=EPISODES, seed=HELD_OUT_SEED, insect=insect, dtype="float64")
        for ratio in RATIOS
    )


def _entry(own: Flights, front: Sequence[Flights], beats: int) -> dict[str, Any]:
    """One insect's part of results.json."""
    best = max(front, key=lambda flights: float(np.mean(flights.returns)))
    behind, interval = mean_with_interval((best.returns - own.returns) / beats)
    level = compare_with_front(own, front)
    return {
        "return": float(np.mean(own.returns)),
        "return/lqg": float(np.mean(best.returns)),
        "cost_above_lqg": behind,
        "cost_above_lqg_interval_95": interval,
        "rms_height": level.rms_height,
        "rms_height/lqg": best.rms_height,
        "power_excess": level.power_excess,
        "power_over_front_at_equal_height": level.difference,
        "power_over_front_interval_95": list(level.interval),
        "inside_front": level.inside,
        "lost": level.lost,
    }


def _table(entries: dict[str, dict[str, Any]]) -> str:
    """Returns beside the best LQG's, and power beside the front's at equal height."""
    header = (
        "insect",
        "return",
        "best LQG",
        "LQG's lead a beat",
        "rms z/R",
        "LQG's",
        "power over front [%]",
        "95 %",
        "lost",
    )
    rows = [header]
    for insect, entry in entries.items():
        low, high = entry["power_over_front_interval_95"]
        rows.append(
            (
                insect,
                f"{entry['return']:.3f}",
                f"{entry['return/lqg']:.3f}",
                f"{entry['cost_above_lqg']:.5f} ± {entry['cost_above_lqg_interval_95']:.5f}",
                f"{entry['rms_height']:.4f}",
                f"{entry['rms_height/lqg']:.4f}",
                f"{100 * entry['power_over_front_at_equal_height']:+.4f}{'' if entry['inside_front'] else ' beyond'}",
                f"[{100 * low:+.4f}, {100 * high:+.4f}]",
                f"{entry['lost']}",
            )
        )
    return text_table(rows)
