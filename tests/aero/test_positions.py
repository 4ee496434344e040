"""The general blade element against positions in space: every velocity, normal and lever by finite differences.

Nothing here uses the frames or formulas of `flapenv.aero`: points of both wings are placed in earth axes from the
angles alone, and forces, torques and power follow from their differences.
"""

import dataclasses
import math

import numpy as np
import pytest

from flapenv import FourierMotion, Wing, load_insect
from flapenv.aero.blade_element import blade_element
from flapenv.aero.force_laws import PlateLaw
from flapenv.aero.inertia import wing_inertia

MOTION = FourierMotion(
    frequency=26.0,
    flap_cosines=[0.3, 0.15],
    flap_sines=[0.9, 0.1],
    pitch_cosines=[0.2, 1.9, 0.0, 0.1],  # beyond 90° at times
    pitch_sines=[0.3],
)
LAW = PlateLaw(constant=1.3, profile_drag=0.1)
DENSITY = 1.2
STRIPS, STEPS = 4, 40
RIGHT, LEFT = 1.0, -1.0
CASES = [  # σ, velocity of the body, x̂₀
    (0.0, (0.0, 0.0, 0.0), 0.25),
    (0.4, (0.7, 0.0, 0.5), 0.25),
    (-0.8, (0.5, 0.9, -0.6), 0.0),
    (math.pi, (-0.4, -0.8, 0.3), 0.6),
]


def point(side: float, flap: np.ndarray, pitch: np.ndarray, radius: float, behind: float, slant: float) -> np.ndarray:
    """A wing's point (n, 3) in earth axes (forward, left, up) over the root, `behind` the pitching axis.

    Built by turning: the wing lies along y with its chord upwards; it pitches about its span (leading edge forward
    where θ > 0), flaps about the upward axis (tip forward where φ > 0), and the whole leans forward by σ.
    """
    forward, upward = -behind * np.sin(pitch), -behind * np.cos(pitch)
    x = forward * np.cos(flap) + radius * np.sin(flap)
    outward = radius * np.cos(flap) - forward * np.sin(flap)
    return np.stack(
        [
            math.cos(slant) * x + math.sin(slant) * upward,
            -side * outward,
            -math.sin(slant) * x + math.cos(slant) * upward,
        ],
        axis=-1,
    )


class Strip:
    """One strip of one wing followed through space."""

    def __init__(self, side: float, radius: float, chord: float, axis: float, slant: float, body: np.ndarray) -> None:
        self.side, self.radius, self.chord, self.axis, self.slant, self.body = side, radius, chord, axis, slant, body

    def at(self, time: np.ndarray, behind: float, *, flap: float = 0.0, pitch: float = 0.0) -> np.ndarray:
        phase = 2 * math.pi * MOTION.frequency * time
        angles = MOTION.flap_angle(phase) + flap, MOTION.pitch_angle(phase) + pitch
        return point(self.side, *angles, self.radius, behind, self.slant)

    def velocity(self, time: np.ndarray, behind: float) -> np.ndarray:
        h = 1e-7
        return (self.at(time + h, behind) - self.at(time - h, behind)) / (2 * h) + self.body

    def by_angle(self, time: np.ndarray, behind: float, **angle: float) -> np.ndarray:
        h = 1e-5
        ahead, back = (dict.fromkeys(angle, sign * h) for sign in (1, -1))
        return (self.at(time, behind, **ahead) - self.at(time, behind, **back)) / (2 * h)

    def directions(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Chord (towards the leading edge), span (outwards) and normal, unit vectors (n, 3)."""
        chord = self.at(time, 0.0) - self.at(time, 1.0)
        longer = Strip(self.side, self.radius + 1.0, self.chord, self.axis, self.slant, self.body)
        span = longer.at(time, 0.0) - self.at(time, 0.0)
        normal = self.side * np.cross(span, chord)
        return chord, span, normal

    def force(self, term: str, time: np.ndarray, width: float) -> tuple[np.ndarray, float]:
        """Force (n, 3) and how far behind the axis it acts."""
        chord, span, normal = self.directions(time)
        v = self.velocity(time, 0.0)
        v = v - np.sum(v * span, axis=1, keepdims=True) * span
        speed = np.linalg.norm(v, axis=1, keepdims=True)
        across = np.sum(v * normal, axis=1, keepdims=True)
        if term == "translational":
            alpha = np.arctan2(np.abs(across), np.sum(v * chord, axis=1, keepdims=True))
            lift = normal - across / speed**2 * v
            lift = -np.sign(across) * lift / np.linalg.norm(lift, axis=1, keepdims=True)
            drag_coefficient = 0.1 + 2 * 1.3 * np.sin(alpha) ** 2
            lift_coefficient = np.abs(1.3 * np.sin(2 * alpha))
            area = self.chord * width
            return 0.5 * DENSITY * area * (speed**2 * lift_coefficient * lift - drag_coefficient * speed * v), 0.0
        if term == "rotational":
            pitch_rate = MOTION.pitch_rate(2 * math.pi * MOTION.frequency * time)[:, None]
            turn = math.pi * (0.75 - self.axis)
            return -DENSITY * turn * self.chord**2 * width * speed * pitch_rate * normal, 0.0
        behind = (0.5 - self.axis) * self.chord if term == "both added masses" else 0.0

        def normal_velocity(moment: np.ndarray) -> np.ndarray:
            return np.sum(self.velocity(moment, behind) * self.directions(moment)[2], axis=1, keepdims=True)

        h = 1e-5
        rate = (normal_velocity(time + h) - normal_velocity(time - h)) / (2 * h)
        return -math.pi / 4 * DENSITY * self.chord**2 * width * rate * normal, behind


@pytest.mark.parametrize("case", CASES, ids=["still", "tilted and climbing", "slipping", "upside down"])
@pytest.mark.parametrize(
    ("term", "names"),
    [
        ("translational", ["translational"]),
        ("rotational", ["rotational"]),
        ("added mass", ["added-mass"]),
        ("both added masses", ["added-mass", "added-mass-pitch"]),
    ],
)
@pytest.mark.filterwarnings("ignore:steps = 40 do not resolve:UserWarning")
def test_forces_torques_and_power_of_both_wings_are_those_of_points_in_space(
    case: tuple[float, tuple[float, float, float], float], term: str, names: list[str]
) -> None:
    slant, velocity, axis = case
    wing = dataclasses.replace(load_insect("hawkmoth").wing, pitch_axis=axis)
    history = blade_element(
        wing,
        MOTION,
        LAW,
        air_density=DENSITY,
        terms=names,
        stroke_plane_angle=slant,
        body_velocity=velocity,
        strips=STRIPS,
        steps=STEPS,
    )
    time = (np.arange(STEPS) + 0.5) / STEPS / MOTION.frequency
    phase = 2 * math.pi * MOTION.frequency * time
    r_hat = (np.arange(STRIPS) + 0.5) / STRIPS
    width = wing.length / STRIPS
    total, torques = np.zeros((STEPS, 3)), np.zeros((2, 2, STEPS))
    for row, side in enumerate((RIGHT, LEFT)):
        for radius, chord in zip(r_hat * wing.length, wing.chord(r_hat), strict=True):
            strip = Strip(side, radius, chord, axis, slant, np.array(velocity))
            force, behind = strip.force(term, time, width)
            total += force
            torques[0, row] -= np.sum(force * strip.by_angle(time, behind, flap=1.0), axis=1)
            torques[1, row] -= np.sum(force * strip.by_angle(time, behind, pitch=1.0), axis=1)
    power = torques[0] * MOTION.flap_rate(phase) + torques[1] * MOTION.pitch_rate(phase)
    for found, expected in (
        (history.earth_force, total),
        (history.flap_torque, torques[0]),
        (history.pitch_torque, torques[1]),
        (history.wing_power, power),
    ):
        scale = max(float(np.max(np.abs(expected))), 1e-9)
        np.testing.assert_allclose(found, expected, atol=1e-5 * scale)


def test_the_angle_of_attack_is_that_between_chord_and_motion() -> None:
    slant, velocity = 0.3, (0.4, 0.3, -0.5)
    wing = load_insect("hawkmoth").wing
    history = blade_element(
        wing,
        MOTION,
        LAW,
        air_density=DENSITY,
        stroke_plane_angle=slant,
        body_velocity=velocity,
        steps=STEPS,
        terms=["translational"],
    )
    time = (np.arange(STEPS) + 0.5) / STEPS / MOTION.frequency
    strip = Strip(RIGHT, math.sqrt(wing.moment(2)) * wing.length, 0.01, 0.25, slant, np.array(velocity))
    chord, span, _ = strip.directions(time)
    v = strip.velocity(time, 0.0)
    v = v - np.sum(v * span, axis=1, keepdims=True) * span
    cosine = np.sum(v * chord, axis=1) / np.linalg.norm(v, axis=1)
    np.testing.assert_allclose(history.angle_of_attack, np.arccos(np.clip(cosine, -1, 1)), atol=1e-5)


def test_moments_and_force_of_the_wings_mass_are_those_of_a_plate_of_points() -> None:
    plate = Wing.from_table([0, 0.02, 0.05], [0.012, 0.02, 0.004], mass=4e-5, pitch_axis=0.3)
    inertia = wing_inertia(plate)
    n = 400
    r = (np.arange(n) + 0.5) / n * plate.length
    chord = plate.chord(r / plate.length)[:, None]
    xi = (np.arange(n) + 0.5) / n * chord - 0.3 * chord
    dm = plate.mass / plate.area * chord / n * plate.length / n * np.ones((n, n))
    for found, integrand in (
        (inertia.first_radius, r[:, None]),
        (inertia.first_chord, xi),
        (inertia.radius, r[:, None] ** 2),
        (inertia.product, r[:, None] * xi),
        (inertia.chord, xi**2),
    ):
        assert found == pytest.approx(float(np.sum(integrand * dm)), rel=1e-4)


def test_positive_power_is_paid_by_each_wing_apart() -> None:
    wing = load_insect("hawkmoth").wing
    history = blade_element(
        wing, MOTION, LAW, air_density=DENSITY, body_velocity=(0.0, 2.0, 0.0), terms=["translational", "inertia"]
    )
    each = np.maximum(history.wing_power, 0).sum(axis=0).mean()
    pair = np.maximum(history.wing_power.sum(axis=0), 0).mean()
    assert history.mean_power("positive") == pytest.approx(each)
    assert each > pair * 1.0001
