"""What a moving picture of a wingbeat shows, as numbers: section, force, trail, and wings from above."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flapenv.aero.axes import LEFT, RIGHT, flapping_directions
from flapenv.aero.checks import require_real
from flapenv.aero.history import WingbeatHistory
from flapenv.aero.motions import Motion
from flapenv.aero.stroke import Stroke
from flapenv.aero.wing import Wing
from flapenv.case import model_wing
from flapenv.insects import Insect
from flapenv.model import HoverModel
from flapenv.simulation import simulate

LEAST_STEPS = 2880
"""Instants a cycle below which the means that are written on a picture would be off."""
STRIPS = 12
STAMPS = 24
"""Sections a cycle that stay behind as the trail."""
OUTLINE_POINTS = 40
WIDEST_CHORD = 3.0
"""A chord that is infinite at the root is drawn this wide [mean chords]."""


@dataclass(frozen=True, kw_only=True)
class DrawnBeat:
    """One wingbeat as a moving picture shows it.

    Points and vectors lie in the plane of the section at r̂₂ R: along ê_φ, forward, then along ẑ₁, up.

    Attributes:
        name: of the insect, and whether the stroke is its own.
        motion: what is beaten.
        wing: the wing, as the coefficients go with it.
        history: forces, torques and power by the blade element.
        rows: which of the history's instants each frame shows, shape (frames,).
        axis: where the pitching axis of the section is on its arc, unrolled, shape (steps, 2) [mean chords].
        leading: its leading edge, shape (steps, 2) [mean chords].
        trailing: its trailing edge, shape (steps, 2) [mean chords].
        force: aerodynamic force of both wings along ê_φ and ẑ₁, over the weight, shape (steps, 2) [-].
        specific_power: of both wings, shape (steps,) [W/kg].
        mean_power: as the model's accounting counts it [W/kg].
    """

    name: str
    motion: Motion
    wing: Wing
    history: WingbeatHistory
    rows: np.ndarray
    axis: np.ndarray
    leading: np.ndarray
    trailing: np.ndarray
    force: np.ndarray
    specific_power: np.ndarray
    mean_power: float

    @property
    def time(self) -> np.ndarray:
        """t/T at the instants, shape (steps,)."""
        return self.history.phase / (2 * math.pi)

    @property
    def weight_support(self) -> float:
        """Mean of the vertical force over the weight [-]."""
        return float(np.mean(self.force[:, 1]))

    def trail(self, row: int) -> tuple[np.ndarray, np.ndarray]:
        """Earlier instants of this half-stroke whose sections are still shown.

        Args:
            row: the instant that is shown now.

        Returns:
            Rows of the history, and how fresh they are, from 0 (half a cycle ago) to 1 (now); shape (n,) each.
        """
        steps = len(self.time)
        stamps = np.arange(STAMPS) * steps // STAMPS
        ages = (row - stamps) % steps
        turned = np.flatnonzero(np.roll(np.sign(self.history.kinematics.flap_rate), -row - 1)[::-1] != self.sense(row))
        since_turn = turned[0] if len(turned) else steps
        keep = (ages > 0) & (ages < min(int(since_turn), steps // 2))
        return stamps[keep], 1 - 2 * ages[keep] / steps

    def sense(self, row: int) -> int:
        """1 in the forward half-stroke, -1 in the backward one."""
        return 1 if self.history.kinematics.flap_rate[row] >= 0 else -1

    def outline(self, row: int, side: int = RIGHT) -> np.ndarray:
        """A wing seen from above, along -ẑ₁: its leading edge out to the tip, its trailing edge back to the root.

        Args:
            row: the instant.
            side: `RIGHT` or `LEFT`.

        Returns:
            Points forward and to the left of the root, in lengths of the wing, shape (2 `OUTLINE_POINTS`, 2).
        """
        at = self.history.kinematics
        r_hat = np.sin(np.linspace(0, math.pi / 2, OUTLINE_POINTS)) ** 2
        with np.errstate(divide="ignore"):
            chord = np.minimum(self.wing.chord(r_hat) / self.wing.mean_chord, WIDEST_CHORD) / self.wing.aspect_ratio
        along, outward = (d[0, :2] for d in flapping_directions(at.flap[row : row + 1], side))
        across = chord * math.sin(at.pitch[row])  # a chord as long as it looks from above
        front, back = self.wing.pitch_axis * across, (self.wing.pitch_axis - 1) * across
        edges = [r_hat[:, None] * outward + shift[:, None] * along for shift in (front, back)]
        return np.concatenate([edges[0], edges[1][::-1]])

    def outlines(self, row: int) -> tuple[np.ndarray, np.ndarray]:
        """`outline` of the right and the left wing."""
        return self.outline(row, RIGHT), self.outline(row, LEFT)


def drawn_beat(
    insect: Insect,
    motion: Motion | None = None,
    *,
    model: HoverModel | None = None,
    terms: Sequence[str] | None = None,
    frames: int,
) -> DrawnBeat:
    """A wingbeat by the blade element, and what is drawn of it.

    Args:
        insect: one insect, scalar fields.
        motion: a `Stroke` or any other motion; the insect's own stroke where None.
        model: options of the aerodynamic model.
        terms: of the force, as in `simulate`; what `evaluate` counts where None. The wing's inertia enters the power
            alone, the picture shows forces of the air.
        frames: at the middles of so many equal parts of the cycle.

    Raises:
        TypeError: for what `simulate` refuses.
        ValueError: likewise, and for a motion that gives NaN or inf.
    """
    model = model or HoverModel()
    motion = insect.stroke if motion is None else motion
    if terms is None:
        paid = model.accounting == "positive"
        terms = ("translational", "added-mass", "inertia") if paid else ("translational",)
    between = math.ceil(LEAST_STEPS / frames) // 2 * 2 + 1  # odd, so that a frame falls on an instant
    history = simulate(
        insect, motion, model=model, terms=terms, strips=STRIPS, steps=frames * between, spacing="graded"
    )
    for name, values in vars(history.kinematics).items():
        require_real(f"the motion's {name}", values)
    wing, at = model_wing(insect, model), history.kinematics
    r_hat = math.sqrt(wing.moment(2))
    axis = np.stack([at.flap * r_hat * wing.aspect_ratio, np.zeros_like(at.flap)], axis=-1)
    chord = np.stack([np.sin(at.pitch), np.cos(at.pitch)], axis=-1)  # from the trailing to the leading edge
    chord *= wing.chord(np.array([r_hat])) / wing.mean_chord
    of_air = [term for name, term in history.terms.items() if name != "inertia"]
    force = np.zeros((len(at.flap), 2))
    for term in of_air:
        force += np.stack([term.tangential_force.sum(axis=0), term.force[:, 2]], axis=-1)
    own = isinstance(motion, Stroke) and motion == insect.stroke
    return DrawnBeat(
        name=f"{insect.name}'s own stroke" if own else insect.name,
        motion=motion,
        wing=wing,
        history=history,
        rows=np.arange(frames) * between + between // 2,
        axis=axis,
        leading=axis + wing.pitch_axis * chord,
        trailing=axis + (wing.pitch_axis - 1) * chord,
        force=force / (insect.mass * model.gravity),
        specific_power=history.power / insect.mass,
        mean_power=history.mean_power(model.accounting) / insect.mass,
    )
