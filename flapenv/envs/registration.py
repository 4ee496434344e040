"""Gymnasium ids of the family."""

import gymnasium as gym

_ENTRY_POINTS = {
    "flapenv/Hover-v0": ("hover:HoverEnv", "hover_batch:HoverVectorEnv"),
    "flapenv/HoverAdapt-v0": ("hover_adapt:HoverAdaptEnv", "hover_adapt:HoverAdaptVectorEnv"),
    "flapenv/Waveform-v0": ("waveform:WaveformEnv", "waveform:WaveformVectorEnv"),
    "flapenv/Heave-v0": ("heave:HeaveEnv", "heave:HeaveVectorEnv"),
}
ENV_IDS: tuple[str, ...] = tuple(_ENTRY_POINTS)
"""Ids of the environments, in the order of the documentation."""


def register_envs() -> None:
    """Register every environment that is not registered yet; importing flapenv calls it, calling it again is free.

    Entry points are strings, so that specs survive JSON; workers that start afresh reach them by
    `gym.make("flapenv:flapenv/Hover-v0")`.
    """
    for name, (entry_point, vector_entry_point) in _ENTRY_POINTS.items():
        if name not in gym.registry:
            gym.register(
                name,
                entry_point=f"flapenv.envs.{entry_point}",
                vector_entry_point=f"flapenv.envs.{vector_entry_point}",
            )
