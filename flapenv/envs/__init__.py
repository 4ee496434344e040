"""The environments. One step is one wingbeat in every one of them."""

from flapenv.envs.hover import HoverEnv, HoverVectorEnv
from flapenv.envs.hover_adapt import HoverAdaptEnv, HoverAdaptVectorEnv
from flapenv.envs.registration import ENV_IDS, register_envs

__all__ = ["ENV_IDS", "HoverAdaptEnv", "HoverAdaptVectorEnv", "HoverEnv", "HoverVectorEnv", "register_envs"]
