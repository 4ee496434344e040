"""The environments. One step is one wingbeat in every one of them."""

from flapenv.envs.hover import HoverEnv
from flapenv.envs.hover_batch import HoverVectorEnv
from flapenv.envs.registration import ENV_IDS, register_envs

__all__ = ["ENV_IDS", "HoverEnv", "HoverVectorEnv", "register_envs"]
