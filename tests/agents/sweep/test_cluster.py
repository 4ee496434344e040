"""A cluster of two nodes on loopback: tokens, and a node that is killed mid-way."""

import secrets
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from loopback_nodes import Nodes, children, loopback_nodes
from sweeps_alone import TINY, finished, require_same_as_alone, tiny_plan, until

from agents.run_folder import CONFIG, RESULTS

pytestmark = pytest.mark.slow
Begin = Callable[..., subprocess.Popen[str]]


def test_every_trial_finishes_although_a_node_is_killed_mid_way(begin: Begin, tmp_path: Path) -> None:
    storage = tmp_path / "sweep"
    asked = ["--presets", "hover-ppo", "--seeds", "8", "--wingbeats", "16384", *TINY, "--storage", str(storage)]
    with loopback_nodes(secrets.token_hex(32)) as nodes:
        assert nodes.address.startswith("127.0.0.1:")
        stranger = {**nodes.environment, "RAY_AUTH_TOKEN": secrets.token_hex(32)}
        refused = begin(*asked, "--address", nodes.address, environment=stranger)
        out, err = refused.communicate(timeout=60)
        assert refused.returncode == 2
        assert not out
        assert err.startswith(f"train.py sweep: --address {nodes.address} does not accept the token")
        assert err.count("\n") == 1
        assert not storage.exists()

        sweep = begin(*asked, "--address", nodes.address, environment=nodes.environment)
        until(lambda: finished(storage) >= 2 and is_training(nodes, storage), sweep)
        before = finished(storage)
        nodes.kill_the_other()
        assert before < 8
        out, err = sweep.communicate(timeout=200)
        assert sweep.returncode == 0, err
        assert "8/8" in out
        assert "Traceback" not in err
    for run in tiny_plan(seeds=8, wingbeats=16384).grid():
        require_same_as_alone(run, storage, tmp_path / "alone")


def is_training(nodes: Nodes, storage: Path) -> bool:
    """Whether a worker of the other node holds a run's folder open that has no result yet."""
    workers = {str(one) for one in children(nodes.raylet)}
    begun = [path.parent for path in storage.glob(f"*/{CONFIG}") if not (path.parent / RESULTS).exists()]
    return any((folder / ".lock").exists() and (folder / ".lock").read_text() in workers for folder in begun)
