"""RLlib's PPO on an environment of the family, through `gym.make` or through its native vector environment.

Runs in an environment of its own, because RLlib pins Gymnasium: `make clients`, or

    python -m venv .venv-rllib
    .venv-rllib/bin/pip install --requirement clients/requirements-rllib.txt --editable .
    .venv-rllib/bin/python clients/rllib_ppo.py --vectorize-mode vector_entry_point
"""

import argparse
import time
from typing import Any

import gymnasium as gym
import ray
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig
from ray.tune.registry import register_env

NAME = "flapenv-for-rllib"


def make(config: dict[str, Any]) -> Any:
    """The environment, or the vector environment where RLlib asks for rows; workers import flapenv by the id."""
    arguments = dict(config)
    env_id = arguments.pop("env_id")
    num_envs = arguments.pop("num_envs", None)
    if num_envs is None:
        return gym.make(env_id, **arguments)
    return gym.make_vec(env_id, num_envs=num_envs, autoreset_mode="NEXT_STEP", **arguments)  # as RLlib assumes


def main() -> None:
    """Train for some iterations and print the mean return of each."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--env-id", default="flapenv:flapenv/Hover-v0")
    parser.add_argument("--vectorize-mode", choices=("sync", "vector_entry_point"), default="sync")
    parser.add_argument("--iterations", type=int, default=20)
    parser.add_argument("--rows", type=int, default=4_000, help="of an iteration")
    parser.add_argument("--num-envs", type=int, default=64)
    parser.add_argument("--env-runners", type=int, default=1, help="processes that step environments; 0 is none")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()

    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    register_env(NAME, make)
    config = (
        PPOConfig()
        .environment(NAME, env_config={"env_id": args.env_id})
        .env_runners(
            num_env_runners=args.env_runners,
            num_envs_per_env_runner=args.num_envs,
            gym_env_vectorize_mode=args.vectorize_mode,
        )
        .rl_module(model_config=DefaultModelConfig(fcnet_hiddens=[64, 64], free_log_std=True))
        .training(
            train_batch_size_per_learner=args.rows,
            minibatch_size=512,
            num_epochs=8,
            lr=3e-3,
            use_kl_loss=False,
            grad_clip=0.5,
        )
        .evaluation(
            evaluation_num_env_runners=args.env_runners,
            evaluation_duration=256,
            evaluation_duration_unit="episodes",
            evaluation_config={"explore": False},
        )
        .debugging(seed=args.seed)
    )
    algorithm = config.build_algo()
    start = time.perf_counter()
    for iteration in range(1, args.iterations + 1):
        result = algorithm.train()["env_runners"]
        print(
            f"{iteration:>3}  {result['num_env_steps_sampled_lifetime']:>9,.0f} wingbeats"
            f"  {time.perf_counter() - start:6.1f} s  mean return {result['episode_return_mean']:8.3f}"
        )
    evaluated = algorithm.evaluate()["env_runners"]
    print(f"{evaluated['num_episodes']:.0f} noise-free episodes: mean return {evaluated['episode_return_mean']:.4f}")
    algorithm.stop()
    ray.shutdown()


if __name__ == "__main__":
    main()
