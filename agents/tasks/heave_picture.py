"""A policy on LQG's front of Heave-v0, and one of its episodes. matplotlib is imported inside."""

from typing import TYPE_CHECKING

import numpy as np

from agents.heave_flights import EPISODES, Policy, fly
from agents.lqg import RATIOS, draw_front_on, fly_front
from agents.lqg_controller import lqg
from agents.predictor import begin
from flapenv.drawing import BLUE, GREY, RED, require_matplotlib
from flapenv.envs.heave_batch import HeaveVectorEnv
from flapenv.insects import Insect

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN = 4
"""Episodes flown for the picture of one; the first is drawn."""


def draw_beside_front(insect: Insect, policy: Policy, seed: int) -> "Figure":
    """The policy's power and height beside both controllers', and its first episode beside the best LQG's.

    Args:
        insect: that flies.
        policy: observations to actions, noise-free.
        seed: of the gusts.

    Raises:
        ImportError: without matplotlib.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    front, own = (
        fly_front(insect, ratios=RATIOS, episodes=EPISODES, seed=seed),
        fly(policy, episodes=EPISODES, seed=seed, insect=insect),
    )
    best = int(np.argmax([np.mean(flights.returns) for flights in front.lqg]))
    figure = Figure(figsize=(11.0, 4.8), dpi=100, layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1.15, 1))
    left = figure.add_subplot(grid[:, 0])
    draw_front_on(left, front)
    returned = f"policy, return {np.mean(own.returns):.2f}"
    left.plot(own.rms_height, 100 * own.mean_power_excess, "*", color=RED, ms=13, label=returned)
    left.legend(frameon=False, fontsize=8)
    height, gust, amplitude = (figure.add_subplot(grid[row, 1]) for row in range(3))
    for act, colour, label in ((lqg(insect, front.ratios[best]), BLUE, "best LQG"), (policy, RED, "policy")):
        path = _first_episode(insect, act, seed)
        beats = np.arange(1, len(path) + 1)
        height.plot(beats, path[:, 0], color=colour, lw=1, label=label)
        amplitude.plot(beats, np.degrees(path[:, 2]), color=colour, lw=1)
        if act is policy:
            gust.plot(beats, path[:, 1], color=GREY, lw=1)
    height.legend(frameon=False, fontsize=8, ncols=2)
    for axes, label in ((height, "height z/R"), (gust, "gust / U, unseen"), (amplitude, "φmax [°]")):
        axes.set(ylabel=label, xlim=(0, 200))
        axes.grid(alpha=0.25)
    amplitude.set_xlabel("beat of one episode")
    return figure


def _first_episode(insect: Insect, act: Policy, seed: int) -> np.ndarray:
    """z/R, w_g/U and φmax of every beat of the first of the episodes, shape (beats, 3)."""
    keys = ["height_ratio", "gust_ratio", "stroke/flap_amplitude"]
    env = HeaveVectorEnv(SHOWN, insect=insect, infos=keys)
    observations, _ = env.reset(seed=seed)
    begin(act)
    path = []
    for _ in range(env.beats):
        observations, _, terminated, truncated, info = env.step(act(observations))
        path.append([info[key][0] for key in keys])
        if terminated[0] or truncated[0]:
            break
    return np.array(path)
