"""The environments. One step is one wingbeat in every one of them."""

from flapenv.envs.heave import HeaveEnv
from flapenv.envs.heave_batch import HeaveVectorEnv
from flapenv.envs.hover import HoverEnv
from flapenv.envs.hover_adapt import HoverAdaptEnv, HoverAdaptVectorEnv
from flapenv.envs.hover_batch import HoverVectorEnv
from flapenv.envs.registration import ENV_IDS, register_envs
from flapenv.envs.state import EnvState
from flapenv.envs.waveform import WaveformEnv, WaveformVectorEnv

__all__ = [
    "ENV_IDS",
    "EnvState",
    "HeaveEnv",
    "HeaveVectorEnv",
    "HoverAdaptEnv",
    "HoverAdaptVectorEnv",
    "HoverEnv",
    "HoverVectorEnv",
    "WaveformEnv",
    "WaveformVectorEnv",
    "register_envs",
]
