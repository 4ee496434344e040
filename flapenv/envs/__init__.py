"""The environments. One step is one wingbeat in every one of them."""

from flapenv.envs.hover import HoverEnv, HoverVectorEnv
from flapenv.envs.registration import ENV_IDS, register_envs
from flapenv.envs.waveform import WaveformEnv, WaveformVectorEnv

__all__ = ["ENV_IDS", "HoverEnv", "HoverVectorEnv", "WaveformEnv", "WaveformVectorEnv", "register_envs"]
