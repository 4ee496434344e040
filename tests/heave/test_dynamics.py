"""From one wingbeat to the next."""

import numpy as np
import pytest

from flapenv import INSECTS, evaluate, load_insect
from flapenv.aero.stroke import Stroke
from flapenv.case import hover_case, lift_constant
from flapenv.heave.dynamics import HeaveBeat, HeaveDynamics, _phi

ALL = HeaveDynamics([load_insect(name) for name in INSECTS])


def rows(count: int, spread: float | None, seed: int = 0) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Insects by turns, with strokes anywhere in the box or near the hovering one."""
    rng = np.random.default_rng(seed)
    index = np.arange(count) % len(INSECTS)
    actions = rng.uniform(-1, 1, (count, 5))
    if spread is not None:
        actions, amplitude = ALL.trim_actions()[index].copy(), spread * actions[:, 0]
        actions[:, 0] += amplitude
    return index, ALL.decode(actions, index)[0]


def sub_beats(
    index: np.ndarray, strokes: dict, height: np.ndarray, velocity: np.ndarray, gust: np.ndarray, parts: int
) -> HeaveBeat:
    """A beat in many small steps, the force taken anew at each."""
    support = power = 0.0
    for _ in range(parts):
        step = ALL.beat(index, strokes, height, velocity, gust, beats=1 / parts)
        height, velocity = step.height, step.velocity
        support, power = support + step.weight_support / parts, power + step.specific_power / parts
    return HeaveBeat(height=height, velocity=velocity, weight_support=support, specific_power=power)


def test_at_rest_the_forces_are_those_of_hovering() -> None:
    index, strokes = rows(64, None)
    found = ALL.forces(index, strokes, np.zeros(64))
    for row in range(64):
        stroke = Stroke(**{name: float(values[row]) for name, values in strokes.items()})
        hover = evaluate(load_insect(list(INSECTS)[index[row]]), stroke)
        assert found.weight_support[row] == pytest.approx(hover.weight_support, rel=1e-5)
        assert found.specific_power[row] == pytest.approx(hover.specific_power, rel=1e-5)


@pytest.mark.parametrize(
    ("spread", "speed", "velocity", "power"),
    [(0.1, 0.02, 1e-4, 3e-4), (0.6, 0.05, 4e-4, 3e-3), (None, 0.1, 1e-3, 2e-2)],
    ids=["holding height", "hard", "anything"],
)
def test_one_step_a_beat_is_fifty_sub_beats(spread: float | None, speed: float, velocity: float, power: float) -> None:
    rng = np.random.default_rng(1)
    index, strokes = rows(800, spread)
    start, gust = rng.uniform(-speed, speed, 800), rng.normal(0, 0.02, 800)
    one = ALL.beat(index, strokes, np.zeros(800), start, gust)
    fine = sub_beats(index, strokes, np.zeros(800), start, gust, 50)
    assert np.max(np.abs(one.velocity - fine.velocity)) < velocity
    assert np.max(np.abs(one.height - fine.height)) < 2 * velocity
    relative = np.abs(one.specific_power - fine.specific_power) / ALL.trim.specific_power[index]
    assert np.max(relative) < power
    explicit = start + ALL.trim.gravity[index] * (ALL.forces(index, strokes, start - gust).weight_support - 1)
    assert np.max(np.abs(explicit - fine.velocity)) > 20 * np.max(np.abs(one.velocity - fine.velocity))


def test_the_quadratures_of_an_episode_err_less_than_a_hundred_thousandth() -> None:
    rng = np.random.default_rng(2)
    corners = np.sign(rng.uniform(-1, 1, (512, 5)))
    corners[::2, 4] = rng.uniform(-1, 1, 256)
    index = np.arange(512) % len(INSECTS)
    strokes, _ = ALL.decode(corners, index)
    fine = HeaveDynamics(ALL.insects)
    fine.time = fine.time.refined(5)
    for airspeed in (-0.1, 0.0, 0.05):
        rough, exact = (one.forces(index, strokes, np.full(512, airspeed)) for one in (ALL, fine))
        for name, values in vars(exact).items():
            np.testing.assert_allclose(getattr(rough, name), values, rtol=2e-5 if "slope" in name else 1e-5)


def test_the_change_of_velocity_is_the_mean_force_less_the_weight() -> None:
    index, strokes = rows(32, None)
    beat = ALL.beat(index, strokes, np.zeros(32), np.full(32, 0.03), np.zeros(32))
    np.testing.assert_allclose(beat.velocity - 0.03, ALL.trim.gravity[index] * (beat.weight_support - 1), atol=1e-15)


def test_only_the_speed_through_the_air_counts_and_rising_air_is_a_sinking_body() -> None:
    index, strokes = rows(32, 0.2)
    rest, none = np.zeros(32), np.zeros(32)
    lifted = ALL.beat(index, strokes, rest, none, np.full(32, 0.02))
    sinking = ALL.beat(index, strokes, rest, np.full(32, -0.02), none)
    np.testing.assert_allclose(lifted.weight_support, sinking.weight_support)
    np.testing.assert_allclose(lifted.specific_power, sinking.specific_power)
    np.testing.assert_allclose(lifted.velocity, sinking.velocity + 0.02)
    np.testing.assert_allclose(lifted.height, sinking.height + 0.02 * ALL.trim.reach[index])
    still = ALL.beat(index, strokes, rest, none, none)
    assert np.all(lifted.weight_support > still.weight_support)
    assert np.all(lifted.specific_power > still.specific_power)


def test_hovering_in_still_air_stays_where_it_is_and_in_a_steady_gust_goes_along() -> None:
    index = np.arange(len(INSECTS))
    strokes, _ = ALL.decode(ALL.trim_actions(), index)
    for gust in (0.0, 0.03):
        height, velocity = np.zeros(8), np.zeros(8)
        for _ in range(400):
            beat = ALL.beat(index, strokes, height, velocity, np.full(8, gust))
            height, velocity = beat.height, beat.velocity
        assert velocity == pytest.approx(np.full(8, gust), abs=2e-5)
        assert np.all(np.abs(height) < 2e-2) if gust == 0 else np.all(height > 10)


@pytest.mark.parametrize("exponent", [-50.0, -1.0, -0.0101, -0.0099, -1e-8, 0.0, 1e-3, 0.3])
def test_the_functions_of_the_exponential_step(exponent: float) -> None:
    first, second = (values[0] for values in _phi(np.array([exponent])))
    fine = (np.arange(20_000) + 0.5) / 20_000
    assert first == pytest.approx(np.mean(np.exp(exponent * fine)), rel=1e-6)
    assert second == pytest.approx(np.mean((1 - fine) * np.exp(exponent * fine)), rel=1e-6)


def test_single_precision_changes_a_beat_by_a_millionth() -> None:
    index, strokes = rows(64, None)
    single = HeaveDynamics(ALL.insects, "float32")
    start = np.full(64, 0.02)
    one, other = (d.beat(index, strokes, np.zeros(64), start, np.zeros(64)) for d in (ALL, single))
    np.testing.assert_allclose(other.velocity, one.velocity, atol=1e-6)
    np.testing.assert_allclose(other.specific_power, one.specific_power, rtol=1e-5)


def within_a_beat(name: str, stroke: Stroke, gust: float, instants: int = 3000) -> tuple[float, ...]:
    """Z [m], w [m/s] at the end of a beat from rest, Λ and P*, with the force of every instant moving the body."""
    insect, model = load_insect(name), ALL.model
    length = insect.wing.length
    r_hat, areas = insect.wing.shape.strips(12)
    constant = lift_constant(hover_case(insect, model), model, stroke.mean_flap_speed, stroke.flap_amplitude)
    factor = 2 * model.air_density * constant * areas * insect.wing.area / insect.mass
    phase = 2 * np.pi * (np.arange(instants) + 0.5) / instants
    along, sine, cosine = stroke.flap_rate(phase), np.sin(stroke.pitch_angle(phase)), np.cos(stroke.pitch_angle(phase))
    step = 1 / (stroke.frequency * instants)
    height = speed = support = power = 0.0
    for k in range(instants):
        flapping = along[k] * r_hat * length
        middle = speed
        for _ in range(2):  # midpoint rule
            air = middle - gust
            normal = -factor * np.hypot(flapping, air) * (-flapping * cosine[k] + air * sine[k])
            lift, paid = float(np.sum(normal * sine[k])), float(np.sum(normal * cosine[k] * flapping))
            middle = speed + 0.5 * step * (lift - model.gravity)
        height += step * middle
        speed += step * (lift - model.gravity)
        support, power = support + lift / model.gravity / instants, power + paid / instants
    return height, speed, support, power


@pytest.mark.parametrize("name", ["cranefly", "hawkmoth"])  # those that a beat moves the most
def test_what_goes_on_within_a_beat_hardly_counts(name: str) -> None:
    index = np.array([list(INSECTS).index(name)])
    for action in ([0.4, 1, 1, 1, 0], [0.5, 1, 1, 1, 0]):
        strokes, _ = ALL.decode(np.array([action]), index)
        stroke = Stroke(**{field: float(values[0]) for field, values in strokes.items()})
        beat = ALL.beat(index, strokes, np.zeros(1), np.zeros(1), np.full(1, 0.02))
        tip_speed, length = float(ALL.trim.tip_speed[index[0]]), load_insect(name).wing.length
        height, velocity, support, power = within_a_beat(name, stroke, 0.02 * tip_speed)
        assert beat.velocity[0] == pytest.approx(velocity / tip_speed, abs=4e-5)
        assert beat.height[0] == pytest.approx(height / length, abs=4e-4)
        assert beat.weight_support[0] == pytest.approx(support, abs=4e-4)
        assert beat.specific_power[0] == pytest.approx(power, rel=3e-4)
