"""Recipes by name: `PRESETS`, one file a learner; recipes for rl-zoo3 lie beside them."""

from collections.abc import Mapping
from typing import Any

from agents.presets import crossq, gradient, ppo, recurrent_ppo, sac, td3, tqc
from agents.presets.crossq import CrossQSettings
from agents.presets.gradient import GradientSettings
from agents.presets.ppo import PPOSettings
from agents.presets.preset import Preset, Settings, setting_of
from agents.presets.recurrent_ppo import RecurrentPPOSettings
from agents.presets.sac import SACSettings
from agents.presets.td3 import TD3Settings
from agents.presets.tqc import TQCSettings
from flapenv.aero.checks import allowed, require_name, shown

__all__ = [
    "ALGORITHMS",
    "DEFAULT_PRESET",
    "PRESETS",
    "CrossQSettings",
    "GradientSettings",
    "PPOSettings",
    "Preset",
    "RecurrentPPOSettings",
    "SACSettings",
    "Settings",
    "TD3Settings",
    "TQCSettings",
    "as_preset",
    "setting_of",
]

LEARNERS = (ppo, recurrent_ppo, sac, td3, tqc, crossq, gradient)
PRESETS: dict[str, Preset] = {name: preset for learner in LEARNERS for name, preset in learner.PRESETS.items()}
"""Every recipe by name, the default one first."""
DEFAULT_PRESET = next(iter(PRESETS))
KINDS = (PPOSettings, RecurrentPPOSettings, SACSettings, TD3Settings, TQCSettings, CrossQSettings, GradientSettings)
ALGORITHMS: dict[str, Any] = {kind.algorithm: kind for kind in KINDS}
"""The settings' record of every learner by its name."""
DESCRIBED = ("task", "algorithm", "settings")


def as_preset(preset: Any) -> Preset:
    """A preset by its name, itself, or the dict of one as config.json keeps it.

    Raises:
        ValueError: for an unknown name or a value that is not allowed.
        TypeError: for an unknown key or another kind of thing.
    """
    if isinstance(preset, Preset):
        return preset
    if isinstance(preset, str):
        return PRESETS[require_name("preset", preset, PRESETS)]
    if not isinstance(preset, Mapping):
        raise TypeError(f"preset = {shown(preset)} is not allowed; allowed: a name, a Preset or the dict of one")
    for name in preset:
        if name not in DESCRIBED:
            raise TypeError(f"a preset has no key {shown(name)}; {allowed(name, DESCRIBED)}")
    for name in DESCRIBED:
        if name not in preset:
            raise TypeError(f"a preset needs the key {shown(name)}; its keys are {', '.join(DESCRIBED)}")
    task, settings = preset["task"], preset["settings"]
    for name, value in (("task", task), ("settings", settings)):
        if not isinstance(value, Mapping):
            raise TypeError(f"{name} = {shown(value)} is not allowed; allowed: an object with the {name}'s keys")
    kind = ALGORITHMS[require_name("algorithm", preset["algorithm"], ALGORITHMS)]
    arguments = {name: value for name, value in task.items() if name != "name"}
    return Preset(task=task.get("name", ""), arguments=arguments, settings=kind(**settings))
