"""Gymnasium ids."""

import subprocess
import sys

import gymnasium as gym

import flapenv
from flapenv.envs import ENV_IDS


def test_every_id_is_registered_on_import_and_again_is_free() -> None:
    before = dict(gym.registry)
    flapenv.register_envs()
    assert all(name in gym.registry for name in ENV_IDS)
    assert {name: spec for name, spec in gym.registry.items() if "flapenv" in name} == {
        name: spec for name, spec in before.items() if "flapenv" in name
    }


def test_a_fresh_process_finds_the_environment_by_its_module() -> None:
    code = "import gymnasium; print(gymnasium.make('flapenv:flapenv/Hover-v0', insect='hawkmoth').reset(seed=1)[1])"
    found = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True)
    assert "hawkmoth" in found.stdout


def test_specs_hold_entry_points_as_strings_and_no_step_limit() -> None:
    for name in ENV_IDS:
        spec = gym.spec(name)
        assert isinstance(spec.entry_point, str)
        assert isinstance(spec.vector_entry_point, str)
        assert spec.max_episode_steps is None
