"""Actions and a simple controller with which the tests fly Heave-v0."""

from typing import Any

import numpy as np

from flapenv.envs.heave_batch import (
    HeaveVectorEnv,
)

STILL = {"strength": 0.0}
HOVER = np.array([0.4, 1, 1, 1, 0], dtype=np.float32)
LEAST, MOST = np.array([-1, 1, 1, 1, -1], dtype=np.float32), np.array([1, -1, -1, -1, 0], dtype=np.float32)


def centred(observations: np.ndarray) -> np.ndarray:
    """Actions of a simple controller that holds height."""
    actions = np.tile(HOVER, (len(observations), 1))
    actions[:, 0] -= 0.5 * observations[:, 0] + 1.0 * observations[:, 1]
    return actions


def run(env: HeaveVectorEnv, policy: Any, beats: int, seed: int = 0) -> dict[str, np.ndarray]:
    """Rewards, terminations, truncations and infos of all beats, stacked."""
    observations, _ = env.reset(seed=seed)
    seen: dict[str, list] = {"reward": [], "terminated": [], "truncated": [], "gust_ratio": [], "height_ratio": []}
    for _ in range(beats):
        observations, rewards, terminated, truncated, info = env.step(policy(observations))
        for name, value in (("reward", rewards), ("terminated", terminated), ("truncated", truncated)):
            seen[name].append(value)
        for name in ("gust_ratio", "height_ratio"):
            seen[name].append(info[name])
    return {name: np.array(values) for name, values in seen.items()}
