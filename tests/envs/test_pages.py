"""The pages of the environments say what their docstrings and signatures say."""

import inspect
from pathlib import Path

import gymnasium as gym
import pytest
from gymnasium.envs.registration import load_env_creator

import flapenv
from flapenv.aero.parameters import STROKE_PARAMETERS
from flapenv.envs import ENV_IDS
from flapenv.envs.pages import page

FOLDER = Path(flapenv.__file__).parents[1] / "docs" / "environments"
SECTIONS = [
    "## Description",
    "## Action space",
    "## Observation space",
    "## Rewards",
    "## Starting state",
    "## Episode end",
    "## Arguments",
    "## Version history",
]


@pytest.mark.parametrize("env_id", ENV_IDS)
def test_a_docstring_has_gymnasiums_sections_in_their_order_and_says_what_a_step_is(env_id: str) -> None:
    entry_point = gym.spec(env_id).entry_point
    assert isinstance(entry_point, str)
    text = inspect.getdoc(load_env_creator(entry_point)) or ""
    assert [line for line in text.splitlines() if line.startswith("## ")] == SECTIONS
    assert "one wingbeat" in text.splitlines()[0]
    assert "{" not in text.replace("{'", "").replace('{"', ""), "a table was not put in"
    assert "| Num | Name | Symbol | Unit | -1 | +1 | Scale |" in text
    assert "| Num | Observation |" in text


@pytest.mark.parametrize("env_id", ENV_IDS)
def test_the_page_in_the_documentation_is_the_one_made_now(env_id: str) -> None:
    written = (FOLDER / f"{env_id.split('/')[1].lower()}.md").read_text(encoding="utf-8")
    assert written == page(env_id), "python -m flapenv.envs --out docs/environments"


def test_the_action_table_is_made_from_the_parameter_table() -> None:
    text = page("flapenv/Hover-v0")
    for name, row in STROKE_PARAMETERS.items():
        if name != "frequency":  # its axis is the tip speed
            assert f"| {name} | {row.symbol} |" in text
    assert "| `pool_size` | `4096` |" in text
