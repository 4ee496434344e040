"""Settings of the learners."""

import pytest

from agents.presets import PPOSettings


def test_the_learning_rate_falls_from_its_start_towards_zero() -> None:
    preset = PPOSettings()
    rates = [preset.learning_rate_at(left) for left in (1.0, 0.7, 0.3, 0.0)]
    assert rates[0] == preset.learning_rate
    assert rates == sorted(rates, reverse=True)
    assert 0 < rates[-1] < 1e-4 * preset.learning_rate
    assert preset.learning_rate_at(-0.01) == rates[-1]  # the last rollout may pass the budget


def test_the_learning_rate_falls_evenly_on_a_log_scale_where_the_power_is_small() -> None:
    preset = PPOSettings(learning_rate=1e-2, learning_rate_ratio=1e-4, learning_rate_power=1e-9, wingbeats=10**9)
    rates = [preset.learning_rate_at(left) for left in (1.0, 0.75, 0.5, 0.25)]
    assert rates == pytest.approx([1e-2, 1e-3, 1e-4, 1e-5], rel=1e-3)


def test_a_budget_of_one_update_learns_at_the_full_rate() -> None:
    preset = PPOSettings(wingbeats=512, rows=512)
    assert preset.learning_rate_at(0.0) == preset.learning_rate


def test_the_noise_floor_falls_until_its_fraction_of_the_budget_and_stays() -> None:
    preset = PPOSettings(noise_floor=-4.0, last_noise_floor=-6.0, floor_until=0.5)
    assert [preset.noise_floor_at(left) for left in (1.0, 0.75, 0.5, 0.0)] == [-4, -5, -6, -6]


@pytest.mark.parametrize(
    ("field", "value", "kind"),
    [
        ("wingbeats", 0, ValueError),
        ("rows", 1.5, TypeError),
        ("learning_rate", 0.0, ValueError),
        ("target_kl", float("nan"), ValueError),
        ("noise_floor", 1.0, ValueError),
        ("floor_until", 0.0, ValueError),
        ("learning_rate_ratio", 1.5, ValueError),
        ("activation", "elu", ValueError),
        ("layers", 0, ValueError),
        ("clip", 0.2, TypeError),
    ],
)
def test_bad_settings_are_named(field: str, value: object, kind: type[Exception]) -> None:
    with pytest.raises(kind, match=field):
        PPOSettings(**{field: value})
