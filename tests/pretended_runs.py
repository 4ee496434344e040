"""Training runs that are only pretended, shared by the tests of the benchmark."""

import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from agents.benchmark.runner import BenchmarkConfig
from agents.benchmark.training_run import Run
from agents.presets import Preset
from agents.presets.ppo import PPOSettings

FAKE = """
import json, os, pathlib, sys, time
out, name, seed, wingbeats, described, what = sys.argv[1:7]
out = pathlib.Path(out)
with open(out.parent / "diary", "a") as diary:
    diary.write(f"{'go on' if (out / 'config.json').exists() else 'begin'} {out.stem}\\n")
if what == "nothing":
    sys.exit("the disk is full")
(out / "config.json").write_text(described)
if what == "fail":
    print("first line", file=sys.stderr)
    sys.exit("the wing fell off")
if what == "die":
    os.kill(os.getpid(), 9)
if what == "interrupt":
    os.kill(os.getppid(), 2)
    time.sleep(60)
time.sleep(0.1)
print("trained", os.environ["OMP_NUM_THREADS"])
lines = "wingbeats,seconds,mean_reward,mean_gap,worst_gap", "10,0.1,-2,0.5,1", "20,0.2,-1,0.004,0.01"
(out / "curve.csv").write_text("\\n".join(lines))
results = {
    "preset": name, "seed": int(seed), "environment": "flapenv/Hover-v0", "wingbeats": int(wingbeats),
    "verdict": {"mean": 0.004 + 0.001 * int(seed), "worst": 0.01, "distance": "gap to the optimum"},
    "seconds": 0.2, "interrupted": what == "stopped",
    "insects": {"hawkmoth": {"gap_percent": 0.4}, "cranefly": {"gap_percent": None}},
}
if what != "silent":
    (out / "results.json").write_text(json.dumps(results))
with open(out.parent / "diary", "a") as diary:
    diary.write(f"end {out.stem}\\n")
"""


def hover_preset(**settings: Any) -> Preset:
    return Preset(
        task="hover",
        settings=PPOSettings(**{"wingbeats": 20, "rows": 2, "minibatch": 2, "learning_rate": 0.1, **settings}),
    )


def faked(**what: str) -> Callable[[Run, Path], Sequence[str]]:
    """Commands that pretend to train; `hover_ppo_seed0="fail"` says how that run ends."""

    def command(run: Run, out: Path) -> list[str]:
        described = run.described()
        ending = what.get(run.name.replace("-", "_"), "well")
        budget = str(described["settings"]["wingbeats"])
        words = [str(out), run.preset, str(run.seed), budget, json.dumps(described), ending]
        return [sys.executable, "-I", "-S", "-c", FAKE, *words]

    return command


def config(*names: str, seeds: int = 2, jobs: int = 2) -> BenchmarkConfig:
    return BenchmarkConfig(presets=names or ("hover-ppo", "hover-sac"), seeds=seeds, jobs=jobs)


def diary(root: Path) -> list[str]:
    return (root / "diary").read_text().splitlines()


def change(path: Path, **values: Any) -> None:
    path.write_text(json.dumps({**json.loads(path.read_text()), **values}))
