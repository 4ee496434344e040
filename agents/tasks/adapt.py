"""HoverAdapt-v0 as a task: hover cheaply in conditions that nobody tells, beside the references on the same draws."""

import functools
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from agents.intervals import mean_with_interval
from agents.predictor import Predictor
from agents.tasks.adapt_flights import Flown
from agents.tasks.held_out import HELD_OUT_SEED, NoiseFree
from agents.tasks.task import Verdict
from flapenv.adapt.tuning import NAMES
from flapenv.aero.checks import record
from flapenv.envs.hover_adapt import HoverAdaptVectorEnv
from flapenv.envs.insect_choice import listed_insects
from flapenv.insects import Insect, described
from flapenv.tables import text_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DRAWS, GLANCES = 1024, 64
"""Episodes of every insect that a policy is judged by, and glanced at by."""
POLICY = "policy"
RIVALS = ("lift_ladder", "felt_lift", "fixed_stroke")
"""References that a policy is compared with, from the best down; they know no more than it does."""


@record
class HoverAdaptTask:
    """HoverAdapt-v0 for one policy.

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
        return "flapenv/HoverAdapt-v0"

    @property
    def distance(self) -> str:
        """Of the return to that of full knowledge."""
        return "return lost to full knowledge, over it"

    def vector_env(self, rows: int) -> HoverAdaptVectorEnv:
        """The environment to train in; no references fly beside it."""
        return HoverAdaptVectorEnv(
            rows, insect=list(self._flyers), references=False, autoreset_mode="SAME_STEP", infos="none"
        )

    def glance(self, policy: Predictor) -> tuple[float, float]:
        """The verdict on few draws, without the references."""
        env = self._glanced
        act = NoiseFree(policy)
        act.start()
        observations, _ = env.reset(seed=HELD_OUT_SEED, options=self._each_insect(GLANCES))
        for _ in range(env.beats):
            observations, _, _, _, info = env.step(act(observations))
        lost = _share_lost(self._by_insect(info["return"]), self._by_insect(info["return/full_knowledge"]))
        return float(np.mean(lost)), float(np.max(lost))

    def fly(self, policy: Predictor, draws: int) -> Flown:
        """Held-out episodes, as many of every insect, in their order.

        Args:
            policy: noise-free.
            draws: of every insect.
        """
        env = HoverAdaptVectorEnv(
            draws * len(self._flyers), insect=list(self._flyers), dtype="float64", autoreset_mode="DISABLED"
        )
        act = NoiseFree(policy)
        act.start()
        observations, _ = env.reset(seed=HELD_OUT_SEED, options=self._each_insect(draws))
        infos = []
        for _ in range(env.beats):
            observations, _, _, _, info = env.step(act(observations))
            infos.append(info)
        names = {POLICY: "return"} | {name: f"return/{name}" for name in NAMES}
        conditions = np.stack([[info[f"condition/{name}"] for name in ("payload", "span_lost")] for info in infos])
        return Flown(
            rewards={name: _differences(infos, key) for name, key in names.items()},
            weight_support=np.stack([info["weight_support"] for info in infos]),
            changed=np.any(conditions != conditions[0], axis=1),
        )

    def judge(self, policy: Predictor) -> Verdict:
        """Returns on held-out draws beside those of the references, with paired 95 % intervals."""
        returns = {name: self._by_insect(values) for name, values in self.fly(policy, DRAWS).returns.items()}
        lost = _share_lost(returns[POLICY], returns["full_knowledge"])
        entries = {}
        for number, insect in enumerate(self._flyers):
            own = {name: values[number] for name, values in returns.items()}
            entries[insect.name] = _entry(own, float(lost[number]))
        together = _entry({name: values.ravel() for name, values in returns.items()}, float(np.mean(lost)))
        return Verdict(
            mean=float(np.mean(lost)),
            worst=float(np.max(lost)),
            text=_table(entries | {"all": together} if len(entries) > 1 else entries),
            results={"draws_of_each": DRAWS, "insects": entries, "all": together},
        )

    def draw(self, policy: Predictor) -> "Figure":
        """One episode and the mean rewards over many, beside the references."""
        from agents.tasks.adapt_picture import draw_flights

        return draw_flights(self.fly(policy, DRAWS), [insect.name for insect in self._flyers])

    def to_dict(self) -> dict[str, Any]:
        """The insects."""
        return {"insects": [described(insect) for insect in self._flyers]}

    @property
    def _flyers(self) -> tuple[Insect, ...]:
        flyers: tuple[Insect, ...] = self.insects
        return flyers

    @functools.cached_property
    def _glanced(self) -> HoverAdaptVectorEnv:
        return HoverAdaptVectorEnv(
            GLANCES * len(self._flyers),
            insect=list(self._flyers),
            references=False,
            autoreset_mode="DISABLED",
            infos=["return", "return/full_knowledge"],
        )

    def _each_insect(self, draws: int) -> dict[str, Any]:
        """The reset options with which every insect flies as often, in their order."""
        return {"insect": [insect.name for insect in self._flyers for _ in range(draws)]}

    def _by_insect(self, values: np.ndarray) -> np.ndarray:
        """Values of rows as shape (insects, draws)."""
        return values.reshape(len(self._flyers), -1)


def _differences(infos: list[dict[str, Any]], key: str) -> np.ndarray:
    """Rewards of every beat from the sums so far, shape (beats, rows) [-]."""
    sums = np.stack([np.where(info[f"_{key}"], info[key], np.nan) for info in infos])
    return np.diff(sums, axis=0, prepend=0.0)


def _share_lost(returns: np.ndarray, best: np.ndarray) -> np.ndarray:
    """What every insect loses to full knowledge, over what that gets; shape (insects, draws) in, (insects,) out."""
    most = np.mean(best, axis=1)
    share: np.ndarray = (most - np.mean(returns, axis=1)) / np.abs(most)
    return share


def _entry(returns: Mapping[str, np.ndarray], lost: float) -> dict[str, Any]:
    """One insect's part of results.json; None for references that it does not have."""
    means = {name: float(np.mean(values)) for name, values in returns.items()}
    entry: dict[str, Any] = {f"return/{name}": mean if np.isfinite(mean) else None for name, mean in means.items()}
    for name in RIVALS:
        more, interval = mean_with_interval(returns[POLICY] - returns[name])
        known = np.isfinite(more)
        entry[f"over/{name}"] = {"mean": more, "interval_95": interval} if known else None
    return entry | {"lost": lost}


def _table(entries: Mapping[str, dict[str, Any]]) -> str:
    """Returns, and by how much the policy's is above each reference's on the same draws."""
    shown = ("full_knowledge", *RIVALS)
    rows = [
        (
            "return",
            *(name.replace("_", " ") for name in shown),
            POLICY,
            "lost %",
            *(f"over {name.replace('_', ' ')}" for name in RIVALS),
        )
    ]
    for insect, entry in entries.items():
        returns = (entry[f"return/{name}"] for name in (*shown, POLICY))
        overs = (entry[f"over/{name}"] for name in RIVALS)
        rows.append(
            (
                insect,
                *("-" if value is None else f"{value:.2f}" for value in returns),
                f"{100 * entry['lost']:.2f}",
                *("-" if one is None else f"{one['mean']:+.3f} ± {one['interval_95']:.3f}" for one in overs),
            )
        )
    return text_table(rows)
