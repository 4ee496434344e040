"""Gymnasium ids of the family."""

import gymnasium as gym

_ENTRY_POINTS = {
    "flapenv/Hover-v0": ("flapenv.envs.hover:HoverEnv", "flapenv.envs.hover:HoverVectorEnv"),
    "flapenv/Waveform-v0": ("flapenv.envs.waveform:WaveformEnv", "flapenv.envs.waveform:WaveformVectorEnv"),
}
ENV_IDS: tuple[str, ...] = tuple(_ENTRY_POINTS)


def register_envs() -> None:
    """Register every environment that is not registered yet; importing flapenv calls it, calling it again is free.

    Entry points are strings, so that specs survive JSON; workers that start afresh reach them by
    `gym.make("flapenv:flapenv/Hover-v0")`.
    """
    for name, (entry_point, vector_entry_point) in _ENTRY_POINTS.items():
        if name not in gym.registry:
            gym.register(name, entry_point=entry_point, vector_entry_point=vector_entry_point)
