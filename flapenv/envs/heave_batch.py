"""flapenv/Heave-v0 for many rows at once."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode

from flapenv.aero.checks import require_count, require_name, require_real
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.aero.stroke import Stroke
from flapenv.envs.arguments import InfoChoice, refuse_unknown
from flapenv.envs.batch import BatchEnv, Info
from flapenv.envs.flyable import require_flyable
from flapenv.envs.insect_choice import InsectChoice, listed_insects, prepared_insects
from flapenv.envs.state import Limits
from flapenv.envs.wing_features import OBSERVATION_LIMIT
from flapenv.heave.dynamics import HeaveBeat, HeaveDynamics
from flapenv.heave.gusts import EpisodeStreams, GustModel, Place, as_gusts
from flapenv.heave.linear import linear_beat, worth_of_motion
from flapenv.insects import Insect
from flapenv.model import HoverModel

HEIGHT_LIMIT = 5.0
"""An episode ends at this height above or below the start's middle [wing lengths]."""
VELOCITY_LIMIT = 0.5
"""And at this speed, far beyond what holds height, where the average over a steady beat means little [U]."""
VELOCITY_UNIT, SUPPORT_UNIT = 0.05, 0.2
"""What w/U and Λ - 1 are observed in."""
HEIGHT_COST = 0.5
"""Charged a beat for (z/R)² = 1."""
WORST_BEAT = 25.0
"""No beat is charged more. At the edge of the band height costs 12.5; the most wasteful stroke 8.7 in still air, 11
while sinking at 0.3 U."""
WORST_END = 100.0
"""No motion at the end is charged or credited more, and a row that is lost is charged as much."""
START_HEIGHT, START_VELOCITY = 1.0, 0.02
"""Half-ranges of z/R and w/U at the start."""
TYPICAL_GRAVITY = 0.02
"""g/(fU) that is observed as 0."""


class HeaveVectorEnv(BatchEnv):
    """Batched `HeaveEnv`, which describes actions, observations and rewards: one step is one wingbeat in every row.

    Insects, starts and gusts of a row's episode follow from the seed, the row and the number of the episode alone,
    whatever is done in it and in other rows; two policies of the same seed meet the same gusts.
    """

    reset_options = ("insect", "height", "velocity")
    kept = (
        *BatchEnv.kept,
        *("_insect", "_height", "_velocity", "_gust", "_support", "_beat_number", "_action"),
        *("_streams", "_series_begun", "_stroke", "_beaten", "_paths"),
    )
    with_nan = ("paths",)
    info_keys = (
        "insect",
        "beat",
        "weight_support",
        "specific_power",
        "power_excess",
        *(f"{name}{unit}" for unit in ("", "_ratio") for name in ("height", "velocity", "gust")),
        "reward/power",
        "reward/height",
        "reward/lost",
        "reward/end",
        *(f"stroke/{name}" for name in STROKE_PARAMETERS),
        "clipped",
    )

    def __init__(
        self,
        num_envs: int = 1,
        *,
        insect: InsectChoice = "all",
        beats: int = 200,
        gusts: GustModel | Mapping[str, float] | None = None,
        infos: InfoChoice = "all",
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        dtype: Any = "float32",
        render_mode: str | None = None,
        **unknown: Any,
    ) -> None:
        """Trim the insects and set up the spaces.

        Args:
            num_envs: rows.
            insect: "all", a name, an `Insect`, the dict of one, or a list of these; drawn uniformly at each reset.
            beats: after how many an episode is truncated.
            gusts: a `GustModel` or the dict of its fields; the default one where None.
            infos: "all", "none", or the keys wanted.
            autoreset_mode: an `AutoresetMode` or its name.
            dtype: "float32" or "float64", of the averages over a beat; observations and actions are float32 always.
            render_mode: "rgb_array" or None.
            **unknown: refused, with the names that exist.

        Raises:
            TypeError: for an unknown argument or one of another kind.
            ValueError: for an unknown name or a value outside its range.
        """
        refuse_unknown(unknown, type(self))
        self.beats = require_count("beats", beats)
        self.gusts = as_gusts(gusts)
        self.dtype = np.dtype(require_name("dtype", getattr(dtype, "__name__", str(dtype)), ("float32", "float64")))
        self.insects = listed_insects(insect)
        require_flyable(self.insects, HoverModel())
        self.dynamics = HeaveDynamics(self.insects, self.dtype)
        self.coordinates = self.dynamics.coordinates

        trim, wings = self.dynamics.trim, [one.wing for one in self.insects]
        features = [
            [float(wing.aspect_ratio) - 4 for wing in wings],
            [(float(wing.r1_hat) - 0.51) / 0.04 for wing in wings],
            np.log(trim.gravity / TYPICAL_GRAVITY),
        ]
        self._features = np.stack(features, axis=-1).astype(np.float32)
        self._names = np.array([one.name for one in self.insects], dtype=object)
        self._worth = _worth_of_motion(self.insects)
        self._trim_actions = self.dynamics.trim_actions().astype(np.float32)
        size = len(self.coordinates)
        super().__init__(
            num_envs,
            single_observation_space=spaces.Box(-OBSERVATION_LIMIT, OBSERVATION_LIMIT, (6 + size,), np.float32),
            single_action_space=spaces.Box(-1.0, 1.0, (size,), np.float32),
            autoreset_mode=autoreset_mode,
            render_mode=render_mode,
            infos=infos,
        )
        self._insect = np.zeros(num_envs, dtype=np.intp)
        self._height, self._velocity, self._gust, self._support = np.zeros((4, num_envs))
        self._beat_number = np.zeros(num_envs, dtype=np.intp)
        self._action = np.zeros((num_envs, size), dtype=np.float32)
        self._streams = EpisodeStreams(num_envs)
        self._source: np.random.Generator | None = None  # the generator that the streams' keys came from
        self._stroke = {name: np.zeros(num_envs, dtype=self.dtype) for name in STROKE_PARAMETERS}
        self._beaten = np.zeros(num_envs, dtype=np.intp)  # the insect of each row's last wingbeat
        self._paths = np.full((num_envs if render_mode else 0, self.beats + 1), np.nan)  # z/R of the last episode

    @property
    def _series_begun(self) -> bool:
        """Whether the streams' keys came from the present generator."""
        return self._source is not None and self._source is self._np_random

    @_series_begun.setter
    def _series_begun(self, begun: bool) -> None:
        self._source = self._np_random if begun else None

    def _limits(self, arrays: Mapping[str, np.ndarray]) -> dict[str, Limits]:
        insects, beats = (0, len(self.insects) - 1), (0, self.beats - 1 + arrays["ended"])
        return {"insect": insects, "beaten": insects, "beat_number": beats}

    def prepare(self, options: dict[str, Any]) -> dict[str, Any]:
        """The option "insect" as row numbers, height and velocity for every row."""
        options = prepared_insects(options, [one.name for one in self.insects], self.num_envs)
        for name, limit in (("height", HEIGHT_LIMIT), ("velocity", VELOCITY_LIMIT)):
            options[name] = self._wanted(name, options.get(name), limit)
        return options

    def _begin(self, mask: np.ndarray, options: dict[str, Any]) -> Info:
        insect, height, velocity = (options.get(name) for name in ("insect", "height", "velocity"))
        key = None
        if not self._series_begun:  # seeded since
            key = int(self.np_random.integers(2**63))
            self._series_begun = True
        streams = self._streams
        streams.begin(mask, key)
        drawn = (streams.uniform(Place.INSECT) * len(self.insects)).astype(np.intp)
        self._insect[mask] = (drawn if insect is None else insect)[mask]
        start = START_HEIGHT * (2 * streams.uniform(Place.HEIGHT) - 1)
        self._height[mask] = (start if height is None else height)[mask]
        start = START_VELOCITY * (2 * streams.uniform(Place.VELOCITY) - 1)
        self._velocity[mask] = (start if velocity is None else velocity)[mask]
        self._gust[mask] = self.gusts.first(streams.normal(Place.FIRST_GUST))[mask]
        self._support[mask], self._beat_number[mask] = 1.0, 0
        self._action[mask] = self._trim_actions[self._insect[mask]]
        return {"insect": self._names[self._insect], "beat": self._beat_number.copy(), **self._motion(self._gust)}

    def _wanted(self, name: str, value: Any, limit: float) -> np.ndarray | None:
        """A reset option of the motion for all rows, checked."""
        if value is None:
            return None
        checked = np.asarray(require_real(f"reset option {name}", value, -limit, limit))
        if checked.shape not in ((), (self.num_envs,)):
            raise ValueError(f"reset option {name} has shape {checked.shape}; allowed: one number, or one for each row")
        return np.broadcast_to(checked, (self.num_envs,))

    def _beat(self, actions: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, Info]:
        strokes, clipped = self.dynamics.decode(actions, self._insect)
        gust, before = self._gust, self._height.copy()
        beat = self.dynamics.beat(self._insect, strokes, self._height, self._velocity, gust)
        lost = (np.abs(beat.height) > HEIGHT_LIMIT) | (np.abs(beat.velocity) > VELOCITY_LIMIT)
        self._keep(beat, strokes, actions, mask)
        left = self.beats - self._beat_number
        truncated = (left == 0) & ~lost
        terms = self._terms(beat, np.where(lost, left, -1), truncated)
        rewards = np.maximum(terms["reward/power"] + terms["reward/height"], -WORST_BEAT)
        rewards += terms["reward/lost"] + terms["reward/end"]
        self._gust = self._gust_of_the_next_beat()
        self._record(before, mask)
        return rewards, lost, truncated, self._info(beat, gust, terms, strokes, clipped)

    def _keep(self, beat: HeaveBeat, strokes: dict[str, np.ndarray], actions: np.ndarray, mask: np.ndarray) -> None:
        """Take what a beat came to into the state of the rows of `mask`; a row that is lost stays at the edge."""
        np.copyto(self._height, np.clip(beat.height, -HEIGHT_LIMIT, HEIGHT_LIMIT), where=mask)
        np.copyto(self._velocity, np.clip(beat.velocity, -VELOCITY_LIMIT, VELOCITY_LIMIT), where=mask)
        np.copyto(self._support, beat.weight_support, where=mask)
        np.copyto(self._action, np.clip(actions, -1, 1), where=mask[:, None])
        self._beat_number += mask
        if self.render_mode is not None:
            for name, value in strokes.items():
                np.copyto(self._stroke[name], value, where=mask)
            np.copyto(self._beaten, self._insect, where=mask)

    def _terms(self, beat: HeaveBeat, lost_beats: np.ndarray, truncated: np.ndarray) -> dict[str, np.ndarray]:
        """The terms of the reward, each of shape (rows,); lost_beats is negative where the row is not lost."""
        hover_power = self.dynamics.trim.specific_power[self._insect]
        worth = np.clip(
            self._worth[0, self._insect] * self._height + self._worth[1, self._insect] * self._velocity,
            -WORST_END,
            WORST_END,
        )
        return {
            "reward/power": 1 - beat.specific_power / hover_power,
            "reward/height": -HEIGHT_COST * self._height**2,
            "reward/lost": np.where(lost_beats >= 0, 0.0 - WORST_BEAT * lost_beats - WORST_END, 0.0),
            "reward/end": np.where(truncated, worth, 0.0),
        }

    def _gust_of_the_next_beat(self) -> np.ndarray:
        place = Place.LATER_GUSTS + Place.PER_GUST * (self._beat_number - 1)
        return self.gusts.following(self._gust, self._streams.normal(place))

    def _motion(self, gust: np.ndarray) -> dict[str, np.ndarray]:
        """Height, velocity and gust in SI units, and over R and U."""
        trim = self.dynamics.trim
        length, tip_speed = trim.length[self._insect], trim.tip_speed[self._insect]
        return {
            "height": self._height * length,
            "velocity": self._velocity * tip_speed,
            "gust": gust * tip_speed,
            "height_ratio": self._height.copy(),
            "velocity_ratio": self._velocity.copy(),
            "gust_ratio": gust.copy(),
        }

    def _info(
        self,
        beat: HeaveBeat,
        gust: np.ndarray,
        terms: dict[str, np.ndarray],
        strokes: dict[str, np.ndarray],
        clipped: np.ndarray,
    ) -> Info:
        return {
            "insect": self._names[self._insect],
            "beat": self._beat_number.copy(),
            "weight_support": beat.weight_support,
            "specific_power": beat.specific_power,
            "power_excess": -terms["reward/power"],
            **self._motion(gust),
            **terms,
            **{f"stroke/{name}": value for name, value in strokes.items()},
            "clipped": clipped,
        }

    def _observe(self) -> np.ndarray:
        seen = np.empty((self.num_envs, self._action.shape[1] + 6), dtype=np.float32)
        seen[:, 0] = self._height
        seen[:, 1] = self._velocity / VELOCITY_UNIT
        seen[:, 2] = (self._support - 1) / SUPPORT_UNIT
        seen[:, 3:-3] = self._action
        seen[:, -3:] = self._features[self._insect]
        return np.clip(seen, -OBSERVATION_LIMIT, OBSERVATION_LIMIT, out=seen)

    def _record(self, before: np.ndarray, mask: np.ndarray) -> None:
        """Keep the heights of the episode where there is somebody to draw them for."""
        if self.render_mode is None:
            return
        first = mask & (self._beat_number == 1)
        self._paths[first] = np.nan
        self._paths[first, 0] = before[first]
        rows = np.flatnonzero(mask)
        self._paths[rows, self._beat_number[rows]] = self._height[rows]

    def _picture(self, row: int) -> np.ndarray:
        from flapenv.heave.drawing import heave_image

        just_begun = self._beat_number[row] == 0 and self.autoreset_mode is not AutoresetMode.SAME_STEP
        if just_begun or np.isnan(self._paths[row, 0]):
            insect = self._insect[row]
            stroke = self.dynamics.trim.of(insect).stroke
            path = self._height[row : row + 1]
        else:
            insect = self._beaten[row]
            stroke = Stroke(**{name: float(value[row]) for name, value in self._stroke.items()})
            path = self._paths[row][~np.isnan(self._paths[row])]
        return heave_image(self.insects[insect], stroke, path, beats=self.beats, limit=HEIGHT_LIMIT)


def _worth_of_motion(insects: tuple[Insect, ...]) -> np.ndarray:
    """What z/R and w/U at an episode's end are worth for every insect, shape (2, insects) [beats of hovering]."""
    dynamics = HeaveDynamics(insects)
    axis = list(dynamics.coordinates.axis_names).index("flap_amplitude")
    return np.array([worth_of_motion(linear_beat(dynamics, i), axis) for i in range(len(insects))]).T
