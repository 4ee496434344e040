"""What a flyer does not know: how much it carries, how thin the air is and how much of its wings is missing.

Each way of computing a condition exists twice. `flown` builds the cut wing and everything that belongs to it afresh,
the slow and direct path; `ConditionTable` interpolates in the one number that is costly, the span lost, and serves
batches of rows. Tests hold them together.
"""

import functools
import math

import numpy as np
from numpy.polynomial import chebyshev

from flapenv.adapt.cut_wing import CutPlanform, cut_wing
from flapenv.aero import induced
from flapenv.aero.arrays import Real, as_numpy
from flapenv.aero.checks import record, require_real
from flapenv.aero.wing import Wing
from flapenv.case import HoverCase, hover_case, stack_cases, wing_factors
from flapenv.insects import Insect, WingFactors
from flapenv.model import HoverModel

PAYLOAD = (1.0, 1.25)
"""Mass carried over the insect's own [-]."""
DENSITY_RATIO = (0.8, 1.05)
"""Air density over the model's [-]."""
SPAN_LOST = (0.0, 0.15)
"""Share of the span lost at the tip of both wings [-]."""
DEGREE = 64
"""Of the Chebyshev interpolation in the root of the span lost; 1e-9 of k_ind for beta planforms."""
CELLS = 1024
"""Of the grid that it is laid out on, to be looked up by cubics; 1e-8 of k_ind."""


@record
class Condition:
    """A hidden condition; scalars or arrays of shape (n,).

    Attributes:
        payload: mass over the insect's own [-].
        density_ratio: air density over the model's [-].
        span_lost: share of the span that both wings lost at the tip [-].

    Raises:
        TypeError: for what is not real.
        ValueError: for a value outside `PAYLOAD`, `DENSITY_RATIO` or `SPAN_LOST`, NaN or inf.
    """

    payload: Real = 1.0
    density_ratio: Real = 1.0
    span_lost: Real = 0.0

    def __post_init__(self) -> None:
        """Check every field."""
        for name, (low, high) in (
            ("payload", PAYLOAD),
            ("density_ratio", DENSITY_RATIO),
            ("span_lost", SPAN_LOST),
        ):
            object.__setattr__(self, name, require_real(name, getattr(self, name), low, high))


NOMINAL = Condition()
"""Nothing carried, the model's air, whole wings: what observations and designs are measured against."""


def flown(insect: Insect, condition: Condition, model: HoverModel) -> tuple[Insect, HoverModel]:
    """The insect as it really flies, and the air it flies in, everything computed from the cut wing.

    k_ind changes by what the lifting line gives for the cut wing over the whole one, k_tip by the new weight, density
    and length at the insect's own stroke; both start from Table 2 where the insect has it.

    Args:
        insect: one insect, as it is known.
        condition: one condition, scalar fields.
        model: the air it is known in, and the coefficients.

    Returns:
        The insect with its payload and cut wing, and the model with the actual air.
    """
    wing, mass = cut_wing(insect.wing, condition.span_lost), insect.mass * condition.payload
    density = model.air_density * condition.density_ratio
    uneven = induced.k_ind(wing) / induced.k_ind(insect.wing)
    tip = _tip_factor(insect, insect.wing, insect.mass, model.air_density, model)
    tip = _tip_factor(insect, wing, mass, density, model) / tip
    own = wing_factors(insect, model)
    factors = WingFactors(
        k_ind=max(1.0, own.k_ind * uneven),
        k_tip=max(1.0, own.k_tip * tip),
        k_revolving=max(1.0, own.k_revolving * uneven * tip),
    )
    changed = Insect(
        name=insect.name,
        mass=mass,
        wing=wing,
        stroke=insect.stroke,
        k_table=factors,
    )
    return changed, HoverModel(**vars(model) | {"air_density": density})


def _tip_factor(insect: Insect, wing: Wing, mass: float, density: float, model: HoverModel) -> float:
    """k_tip computed at the insect's own stroke [-]."""
    downwash = induced.hover_downwash(wing, mass * model.gravity, density)
    return float(induced.k_tip(downwash, insect.stroke.mean_flap_speed * wing.length))


class ConditionTable:
    """The hover cases of insects under any condition, by interpolation in the span lost."""

    def __init__(self, insects: tuple[Insect, ...], model: HoverModel) -> None:
        """Interpolate the remaining area, its moments and k_ind of every insect.

        Args:
            insects: with scalar fields.
            model: of the nominal condition.
        """
        self.nominal = stack_cases([hover_case(insect, model) for insect in insects])
        self._grid = np.stack([_cut_grid(insect.wing) for insect in insects])
        self._inflow = np.array(
            [
                induced.hover_downwash(insect.wing, insect.mass * model.gravity, model.air_density)
                / (insect.stroke.mean_flap_speed * insect.wing.length)
                for insect in insects
            ]
        )

    def cut(self, index: np.ndarray, span_lost: Real) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Remaining area I₀, and I₂, I₃ and k_ind over the whole wing's, shape (n,) each [-].

        Args:
            index: which insect each row is, shape (n,).
            span_lost: shape (n,).
        """
        place = CELLS * np.sqrt(np.broadcast_to(as_numpy(span_lost), index.shape) / SPAN_LOST[1])
        first = np.clip(place.astype(np.intp) - 1, 0, CELLS - 3)
        x = (place - first)[:, None]
        cubics = (
            -(x - 1) * (x - 2) * (x - 3) / 6,
            x * (x - 2) * (x - 3) / 2,
            -x * (x - 1) * (x - 3) / 2,
            x * (x - 1) * (x - 2) / 6,
        )
        found = sum(cubic * self._grid[index, first + step] for step, cubic in enumerate(cubics))
        area, second, third, uneven = np.asarray(found).T
        return area, second, third, uneven

    def cases(self, index: np.ndarray, condition: Condition) -> HoverCase:
        """What Λ and P* per kilogram carried depend on, fields of shape (n,); `hover_case` of `flown` insects.

        Args:
            index: which insect each row is, shape (n,).
            condition: fields of shape (n,) or scalars.
        """
        own = self.nominal.rows(index)
        payload, density, lost = (np.broadcast_to(as_numpy(value), index.shape) for value in vars(condition).values())
        area, second, third, uneven = self.cut(index, lost)
        kept, load = 1 - lost, density / payload
        aspect_ratio = own.aspect_ratio * kept**2 / area
        growth = 1 / (np.sqrt(load) * kept**2)  # of w₀/R and of w₀/U, both ∝ √(m/ρ)/R²
        inflow = self._inflow[index]
        tip = induced.k_tip(inflow * growth, 1.0) / induced.k_tip(inflow, 1.0)
        anything = Wing(length=aspect_ratio, mean_chord=1.0, r1_hat=0.5)  # the ellipse knows the aspect ratio alone
        return HoverCase(
            lift_scale=own.lift_scale * load * second,
            power_scale=own.power_scale * load * third,
            aspect_ratio=aspect_ratio,
            edge_correction=anything.edge_correction("ellipse"),
            wing_factor=np.maximum(1.0, own.wing_factor * uneven * tip),
            downwash_rate=own.downwash_rate * growth,
            reference_frequency=own.reference_frequency,
            reference_amplitude=own.reference_amplitude,
            force_constants=own.force_constants,
            inertia=own.inertia,
        )


@functools.lru_cache(maxsize=256)
def _cut_grid(wing: Wing) -> np.ndarray:
    """I₀, and I₂, I₃ and k_ind over the whole wing's, on a grid even in the root of the span lost, (CELLS + 1, 4).

    In the span lost they rise from zero as its powers between 1 and 2, which no polynomial follows; in the root of it
    they are smooth enough for few costly points.
    """
    place = np.cos((np.arange(DEGREE + 1) + 0.5) * math.pi / (DEGREE + 1))
    lost = SPAN_LOST[1] * ((place + 1) / 2) ** 2
    shape, whole = CutPlanform(planform=wing.shape, lost=lost), wing.shape
    columns = (
        shape.remaining(0),
        shape.remaining(2) / whole.moment(2),
        shape.remaining(3) / whole.moment(3),
        induced.k_ind(cut_wing(wing, lost)) / induced.k_ind(wing),
    )
    coefficients = chebyshev.chebfit(place, np.stack(columns, axis=-1), DEGREE)
    return np.asarray(chebyshev.chebval(np.linspace(-1, 1, CELLS + 1), coefficients)).T
