"""The recipes for rl-zoo3: one for every id, each of which its learner takes.

rl-zoo3 itself is run by `make client-zoo`; it is not among the project's dependencies.
"""

from pathlib import Path
from typing import Any

import pytest
import yaml
from sb3_contrib import TQC, CrossQ
from stable_baselines3 import PPO, SAC, TD3
from stable_baselines3.common.env_util import make_vec_env

from flapenv.envs import ENV_IDS

FOLDER = Path(__file__).parents[2] / "agents" / "presets"
LEARNERS = {"ppo": PPO, "sac": SAC, "td3": TD3, "tqc": TQC, "crossq": CrossQ}
ZOOS_OWN = ("n_timesteps", "n_envs", "policy", "noise_type", "noise_std")
"""Keys that the zoo reads itself; it hands the rest to the learner."""


def recipes(name: str) -> dict[str, dict[str, Any]]:
    return yaml.safe_load((FOLDER / f"{name}.yml").read_text(encoding="utf-8"))


def test_every_recipe_file_is_tested_here() -> None:
    assert {path.stem for path in FOLDER.glob("*.yml")} == set(LEARNERS)


@pytest.mark.parametrize("name", LEARNERS)
@pytest.mark.parametrize("env_id", ENV_IDS)
def test_every_id_has_a_recipe_that_its_learner_takes(env_id: str, name: str) -> None:
    recipe = recipes(name)[env_id]
    assert isinstance(recipe["n_timesteps"], int)
    arguments = {key: value for key, value in recipe.items() if key not in ZOOS_OWN}
    schedule, _, rate = arguments["learning_rate"].partition("_")
    assert schedule == "lin"
    arguments["learning_rate"] = float(rate)
    env = make_vec_env(env_id, recipe.get("n_envs", 1))
    model = LEARNERS[name](recipe["policy"], env, device="cpu", **arguments)
    assert model.get_env().num_envs == recipe.get("n_envs", 1)
