"""The single-file learner: what it does at the end of an episode, and that it learns."""

import gymnasium as gym
import numpy as np
import pytest
import torch
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from clients.single_file_ppo import AUTORESET_MODES, Agent, Args, Collector, advantages_and_returns, train
from flapenv.envs import ENV_IDS

LENGTH = 3
SMALL = {"num_envs": 16, "rollout": 8, "steps": 256, "eval_episodes": 8, "minibatch": 64}


class Counting(gym.Env):
    """Observes how many steps its episode has had, pays 1 for each and ends after `LENGTH` of them."""

    observation_space = gym.spaces.Box(0, LENGTH, (1,), np.float32)
    action_space = gym.spaces.Box(-1, 1, (1,), np.float32)

    def __init__(self, *, truncates: bool) -> None:
        self.truncates = truncates

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple[np.ndarray, dict]:
        super().reset(seed=seed)
        self.count = 0
        return np.zeros(1, dtype=np.float32), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict]:
        self.count += 1
        ended = self.count == LENGTH
        return np.full(1, self.count, np.float32), 1.0, ended and not self.truncates, ended and self.truncates, {}


def counting(mode: str, *, truncates: bool) -> Collector:
    makers = [lambda: Counting(truncates=truncates)] * 2
    return Collector(SyncVectorEnv(makers, autoreset_mode=AutoresetMode[mode]), seed=0)


@pytest.mark.parametrize("mode", AUTORESET_MODES)
def test_each_step_leads_from_an_observation_of_its_own_episode_to_the_next(mode: str) -> None:
    agent = Agent(1, 1, Args())
    rollout = counting(mode, truncates=False).collect(agent, 9)
    learned = rollout.learned
    assert torch.equal(rollout.next_seen[learned], rollout.seen[learned] + 1)
    assert torch.equal(rollout.done[learned], rollout.next_seen[learned][:, 0] == LENGTH)
    resets = 2 * (9 // (LENGTH + 1)) if mode == "NEXT_STEP" else 0
    assert int((~learned).sum()) == resets
    assert (rollout.rewards[learned] == 1).all()


def test_a_reset_at_the_end_of_a_rollout_is_left_out_of_the_next() -> None:
    agent, collector = Agent(1, 1, Args()), counting("NEXT_STEP", truncates=False)
    assert collector.collect(agent, LENGTH).learned.all()
    assert collector.collect(agent, 2).learned.tolist() == [[False, False], [True, True]]


@pytest.mark.parametrize("mode", AUTORESET_MODES)
@pytest.mark.parametrize("truncates", [False, True])
def test_returns_add_up_to_the_end_and_go_on_only_where_an_episode_was_cut(mode: str, truncates: bool) -> None:
    args = Args(gamma=0.9, gae_lambda=1.0)
    agent = Agent(1, 1, args)
    for parameter in agent.critic.parameters():
        torch.nn.init.zeros_(parameter)
    torch.nn.init.constant_(agent.critic[-1].bias, 5.0)
    rollout = counting(mode, truncates=truncates).collect(agent, 2 * LENGTH + 1)
    _, returns = advantages_and_returns(agent, rollout, args)
    first = returns[:LENGTH, 0].tolist()
    beyond = 5.0 if truncates else 0.0
    last = 1 + 0.9 * beyond
    assert first == pytest.approx([1 + 0.9 + 0.81 * last, 1 + 0.9 * last, last])


@pytest.mark.parametrize("env_id", ENV_IDS)
@pytest.mark.parametrize("mode", AUTORESET_MODES)
def test_it_runs_on_every_id_in_both_modes(env_id: str, mode: str) -> None:
    agent, before, after = train(Args(env_id=f"flapenv:{env_id}", autoreset_mode=mode, **SMALL), quiet=True)
    assert np.isfinite([before, after]).all()
    assert all(parameter.isfinite().all() for parameter in agent.parameters())


def test_it_learns_to_hover_in_a_short_run(capsys: pytest.CaptureFixture[str]) -> None:
    _, before, after = train(Args(steps=60_000))
    assert before < -2
    assert after > -1.3  # the optimum is about -1.05
    assert "mean reward with noise" in capsys.readouterr().out


@pytest.mark.parametrize("fields", [{"autoreset_mode": "DISABLED"}, {"steps": 100}])
def test_bad_arguments_are_named(fields: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=next(iter(fields))):
        Args(**fields)
