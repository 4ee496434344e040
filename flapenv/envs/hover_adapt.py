"""flapenv/HoverAdapt-v0: one step is one wingbeat; hover cheaply with a payload, air and wings that nobody tells."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode

from flapenv.adapt.company import Company
from flapenv.adapt.conditions import NOMINAL, Condition
from flapenv.adapt.ladder import BOX
from flapenv.adapt.references import COORDINATES
from flapenv.adapt.task import BEATS, LEAST_MARGIN, NOISE, PROBLEM, AdaptTask, Draws, Flight, choose
from flapenv.adapt.tuning import NAMES, shipped, tuned_for
from flapenv.aero.checks import require_count, require_flag, require_name, require_scalar
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.envs.arguments import InfoChoice, refuse_unknown
from flapenv.envs.batch import BatchEnv, Info
from flapenv.envs.describe import action_table, described, stroke_rows
from flapenv.envs.insect_choice import InsectChoice, listed_insects, prepared_insects
from flapenv.envs.last_beat import LastBeat
from flapenv.envs.single import SingleEnv
from flapenv.envs.state import Limits
from flapenv.envs.wing_features import OBSERVATION_LIMIT, wing_features
from flapenv.objective import QUADRATURE_TOLERANCE
from flapenv.optimum import gap_charge
from flapenv.performance import hover_averages

MEMORY = 4
"""Beats that are observed."""
TRACES = 4
"""Kept of every beat for pictures: weight support, true and felt, the reward, and that of the optimum."""
RETURN_KEYS = ("return", *(f"return/{name}" for name in NAMES))


class HoverAdaptVectorEnv(BatchEnv):
    """Batched `HoverAdaptEnv`, which describes actions, observations and rewards: one step is one wingbeat.

    Rows are independent but for the one generator that draws their insects, conditions and noise, in row order,
    whatever the others do. Batches of different sizes agree to rounding.
    """

    reset_options = ("insect", "condition")
    kept = (*BatchEnv.kept, "_insect", "_flown", "_draws", "_memory", "_return", "_company", "_last")
    info_keys = (
        "insect",
        "beat",
        *(f"condition/{name}" for name in vars(NOMINAL)),
        "weight_support",
        "specific_power",
        "lift_deficit",
        "reward/power",
        "reward/lift",
        *(f"stroke/{name}" for name in STROKE_PARAMETERS),
        "clipped",
        "optimality_gap",
        *RETURN_KEYS,
    )

    def __init__(
        self,
        num_envs: int = 1,
        *,
        insect: InsectChoice = "all",
        references: bool = True,
        tune_references: bool = False,
        beats: int = BEATS,
        infos: InfoChoice = "all",
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        dtype: Any = "float32",
        render_mode: str | None = None,
        **unknown: Any,
    ) -> None:
        """Interpolate the conditions of all insects (once per process), read the references and set up the spaces.

        Args:
            num_envs: rows.
            insect: "all", a name, an `Insect`, the dict of one, or a list of these; drawn uniformly at each reset.
            references: whether the controllers and the fixed stroke fly beside every row, where `infos` want them;
                without them their returns are missing from the infos and a step costs less.
            tune_references: whether insects without shipped references get theirs now, some ten seconds each, once
                per process; else only the optimum with full knowledge stands beside them.
            beats: of an episode; the references are tuned for the default.
            infos: "all", "none", or the keys wanted.
            autoreset_mode: an `AutoresetMode` or its name.
            dtype: "float32" or "float64", of the computation; observations and actions are float32 always.
            render_mode: "rgb_array" or None.
            **unknown: refused, with the names that exist.

        Raises:
            TypeError: for an unknown argument or one of another kind.
            ValueError: for an unknown name, a value outside its range, or an insect that cannot hover in problem A.
        """
        refuse_unknown(unknown, type(self))
        require_flag("references", references)
        require_flag("tune_references", tune_references)
        self.insects = listed_insects(insect)
        self.dtype = np.dtype(require_name("dtype", getattr(dtype, "__name__", str(dtype)), ("float32", "float64")))
        self.task, self.coordinates = AdaptTask(self.insects), COORDINATES
        self._rule = BOX.time_rule(tolerance=QUADRATURE_TOLERANCE)

        nominal = self.task.table.nominal
        r1_hat = np.array([one.wing.r1_hat for one in self.insects])
        self._features, self._felt_power = wing_features(nominal, r1_hat, PROBLEM)
        self._names = np.array([one.name for one in self.insects], dtype=object)

        axes = len(self.coordinates)
        seen = self._features.shape[1] + MEMORY * (2 + axes) + 1
        super().__init__(
            num_envs,
            single_observation_space=spaces.Box(-OBSERVATION_LIMIT, OBSERVATION_LIMIT, (seen,), np.float32),
            single_action_space=spaces.Box(-1.0, 1.0, (axes,), np.float32),
            autoreset_mode=autoreset_mode,
            render_mode=render_mode,
            infos=infos,
        )
        self.beats = require_count("beats", beats)
        wanted = references and any(f"return/{name}" in self.infos for name in NAMES[1:])
        tuned = [tuned_for(one) if tune_references else shipped(one) for one in self.insects]
        self._company = Company(self.task, tuned, num_envs, wanted=wanted)
        self._insect = np.zeros(num_envs, dtype=np.intp)
        self._flown = np.zeros(num_envs, dtype=np.intp)
        """Beats of the present episode."""
        self._draws = Draws(
            before=_rows(NOMINAL, num_envs),
            after=_rows(NOMINAL, num_envs),
            change_beat=self._flown + self.beats,
        )
        self._begin_flights()
        self._memory = np.zeros((num_envs, MEMORY, 2 + axes), dtype=np.float32)  # the last beat first
        self._return = np.zeros(num_envs)
        self._last = LastBeat(num_envs, self.beats, tuple(vars(NOMINAL)), TRACES)

    def _limits(self, arrays: Mapping[str, np.ndarray]) -> dict[str, Limits]:
        insects, beats = (0, len(self.insects) - 1), (0, self.beats - 1 + arrays["ended"])
        return {"insect": insects, "flown": beats, "last.insect": insects, "last.beats": (0, self.beats)}

    def _restored(self) -> None:
        self._begin_flights()
        self._company.begin(np.zeros(self.num_envs, dtype=bool), self._insect)  # in no row: all go on as they are

    def prepare(self, options: dict[str, Any]) -> dict[str, Any]:
        """The option "insect" as row numbers, and "condition" as a checked `Condition` that all of them can carry."""
        options = prepared_insects(options, [one.name for one in self.insects], self.num_envs)
        condition = options.pop("condition", None)
        if condition is not None:
            options["condition"] = self._checked(condition, np.unique(options.get("insect", range(len(self.insects)))))
        return options

    def _begin(self, mask: np.ndarray, options: dict[str, Any]) -> Info:
        insect = self.np_random.integers(len(self.insects), size=self.num_envs)
        insect = options.get("insect", insect)
        draws = self.task.draw(self.np_random, insect)
        if "condition" in options:
            rows = _rows(options["condition"], self.num_envs)
            draws = Draws(before=rows, after=rows, change_beat=np.full(self.num_envs, self.beats))
        self._insect = np.where(mask, insect, self._insect)
        self._draws = choose(mask, draws, self._draws)
        self._flown = np.where(mask, 0, self._flown)
        self._memory[mask] = 0
        self._return[mask] = 0
        self._begin_flights()
        self._company.begin(mask, self._insect)
        return {"insect": self._names[self._insect]}

    def _checked(self, condition: Any, insects: np.ndarray) -> Condition:
        """One condition for a whole episode of any of the insects."""
        known = tuple(vars(NOMINAL))
        if not isinstance(condition, Mapping):
            raise TypeError(
                f"reset option condition = {condition!r} is not allowed; allowed: a dict with keys of "
                f"{', '.join(known)}"
            )
        values = {}
        for name, value in condition.items():
            require_name("reset option condition: key", name, known)
            values[name] = require_scalar(f"reset option condition: {name}", value)
        checked = Condition(**values)
        largest = float(np.min(self.task.flight(insects, _rows(checked, len(insects))).max_weight_support))
        if largest < LEAST_MARGIN:
            raise ValueError(
                f"reset option condition = {condition!r} is not allowed: the largest weight support there is "
                f"{largest:.3f}; allowed: conditions with {LEAST_MARGIN:g} or more"
            )
        return checked

    def _begin_flights(self) -> None:
        """What the conditions of all rows amount to, and the present one of each."""
        self._before, self._after = (
            self.task.flight(self._insect, condition) for condition in (self._draws.before, self._draws.after)
        )
        self._set_now(choose(self._flown < self._draws.change_beat, self._before, self._after))

    def _set_now(self, now: Flight) -> None:
        self._now, self._now_cast = now, now.cast(self.dtype)

    def _beat(self, actions: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, Info]:
        changing = mask & (self._flown == self._draws.change_beat)
        if changing.any():
            self._set_now(choose(changing, self._after, self._now))
        flight, case = self._now_cast, self._now_cast.case
        strokes, clipped = self.coordinates.decode(actions.astype(self.dtype), case.reference)
        weight_support, specific_power = hover_averages(case, self.task.model, **strokes, rule=self._rule)
        reward, power_term, lift_term = self.task.reward_terms(flight, weight_support, specific_power)
        noise = np.exp(NOISE * self.np_random.standard_normal((self.num_envs, 2)))
        felt = weight_support * noise[:, 0]
        felt_power = specific_power * noise[:, 1] / self._felt_power[self._insect]
        beat = np.concatenate([np.stack([felt - 1, np.log(felt_power)], axis=-1), np.clip(actions, -1, 1)], axis=-1)
        memory = np.concatenate([beat[:, None], self._memory[:, :-1]], axis=1)
        self._memory = np.where(mask[:, None, None], memory, self._memory).astype(np.float32)
        self._return += np.where(mask, reward, 0)
        self._company.fly(self._now, noise[:, 0], mask)
        condition = vars(self._condition())
        traces = weight_support, felt, reward, self._now.best_reward
        self._last.keep(mask, self._insect, self._flown, strokes, condition, traces)
        self._flown = self._flown + mask
        info = {
            "insect": self._names[self._insect],
            "beat": self._flown.copy(),
            **{f"condition/{name}": value.copy() for name, value in condition.items()},
            "weight_support": weight_support,
            "specific_power": specific_power,
            "lift_deficit": np.maximum(0, 1 - weight_support),
            "reward/power": power_term,
            "reward/lift": lift_term,
            **{f"stroke/{name}": value for name, value in strokes.items()},
            "clipped": clipped,
            "optimality_gap": self._gap(weight_support, specific_power),
            **self._return_infos(),
        }
        return reward, mask & (self._flown == self.beats), np.zeros(self.num_envs, dtype=bool), info

    def _condition(self) -> Condition:
        """The present condition of every row, fresh arrays."""
        changed = self._flown >= self._draws.change_beat
        now: Condition = choose(changed, self._draws.after, self._draws.before)
        return now

    def _gap(self, weight_support: np.ndarray, specific_power: np.ndarray) -> np.ndarray:
        """P* over the present condition's optimum, minus one, plus the charge for missing lift [-]."""
        charge = gap_charge(self._now.multiplier, self._now.best_power)
        gap: np.ndarray = specific_power / self._now.best_power - 1 + charge * np.maximum(0, 1 - weight_support)
        return gap

    def _return_infos(self) -> Info:
        """Sums of rewards since the episode began, those of the references only where there are any."""
        infos: Info = {"return": self._return.copy()}
        infos |= {f"return/{name}": total.copy() for name, total in self._company.returns.items()}
        for name in NAMES[1:]:
            infos[f"_return/{name}"] = self._company.known[self._insect]
        return infos

    def _observe(self) -> np.ndarray:
        left = (1 - self._flown / self.beats).astype(np.float32)
        memory = self._memory.reshape(self.num_envs, -1)
        seen = np.concatenate([self._features[self._insect], memory, left[:, None]], axis=1)
        return np.clip(seen, -OBSERVATION_LIMIT, OBSERVATION_LIMIT)

    def _picture(self, row: int) -> np.ndarray:
        from flapenv.adapt.drawing import flight_image

        last = self._last
        just_begun = self._flown[row] == 0 and self.autoreset_mode is not AutoresetMode.SAME_STEP
        if just_begun or last.beats[row] == 0:
            insect = self.insects[self._insect[row]]
            condition = Condition(**{name: float(value[row]) for name, value in vars(self._condition()).items()})
            return flight_image(insect, insect.stroke, condition, self.task.model, np.zeros((TRACES, 0)), self.beats)
        insect, stroke = self.insects[last.insect[row]], last.stroke(row)
        condition = Condition(**{name: float(value[row]) for name, value in last.numbers.items()})
        return flight_image(insect, stroke, condition, self.task.model, last.traces(row), self.beats)


def _rows(condition: Condition, count: int) -> Condition:
    """A condition for every row."""
    return Condition(**{name: np.full(count, value) for name, value in vars(condition).items()})


@described(actions=action_table(stroke_rows(BOX, COORDINATES.axis_names)))
class HoverAdaptEnv(SingleEnv):
    """One step is one wingbeat: hover with the least power while payload, air and wings are not what they were.

    ## Description
    Hovering as in `HoverEnv`, at a fixed frequency, that of a resonant thorax: 1.15 times the one of the insect's
    optimum in problem A. What the insect carries, how dense the air is and how much of its wings is missing is hidden,
    and one of them changes on the way; it shows in what the last beats felt like, and in nothing else. An episode is 20
    beats. docs/hover_adapt.md has the task, its optimum and the references.

    ## Action space
    `Box(-1, 1, (5,), float32)`:

    {actions}

    Finite actions outside [-1, 1] are clipped; `info["clipped"]` says so. NaN and inf are refused.

    ## Observation space
    `Box(-5, 5, (32,), float32)`. Numbers of the wing are those without payload, in the model's air, with whole wings.

    | Num | Observation |
    |---|---|
    | 0 | AR - 4, aspect ratio of one wing |
    | 1 | (r̂₁ - 0.51)/0.04, centre of area |
    | 2 | log Λ_ref, weight support at the insect's own frequency, φmax = 60°, constant speed and α = 35° |
    | 3 | Λ felt on the last beat, minus 1 |
    | 4 | log(P* felt on the last beat/P*_felt), P*_felt from the same yardstick stroke |
    | 5-9 | the last beat's action |
    | 10-30 | the same of the three beats before; zeros where there were none |
    | 31 | fraction of the episode left |

    What is felt is what is times a noise whose logarithm is normal, with a standard deviation of 2 %.

    ## Rewards
    Each beat -P*/P*_ref - λ max(0, 1 - Λ), not below -20, of the true Λ and of the true P* per kilogram carried. P*_ref
    is the proven lower bound, and λ at least twice the multiplier of the optimum, both of the present condition, so
    that the best stroke of a condition is the best one that carries the weight. Terms: `info["reward/power"]`,
    `info["reward/lift"]`. Infos sum up the returns since the episode began: `return` the agent's,
    `return/full_knowledge` the optimum's that knows every condition, `return/fixed_stroke`, `return/felt_lift` and
    `return/lift_ladder` those of the references on the same conditions with the same noise.

    ## Starting state
    An insect drawn uniformly, or `options={"insect": name}`. Mass 1 to 1.25 times its own, density 0.8 to 1.05 times
    the model's, 0 to 15 % of the span lost at the tips; drawn until the box lifts at least 1.05 times the weight. After
    5 to 15 beats the payload becomes another or more of the span is lost. `options={"condition": {"payload": 1.1}}`
    sets a condition for the whole of that episode; what it leaves out is nominal.

    ## Episode end
    Terminates after 20 beats, or as many as `beats` says; never truncates.

    ## Arguments
    `insect`, `references`, `tune_references`, `beats`, `infos`, `dtype`, `render_mode` as in `HoverAdaptVectorEnv`.

    ## Version history
    - v0: first version.
    """

    batch_class = HoverAdaptVectorEnv
