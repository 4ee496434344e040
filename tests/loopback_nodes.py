"""A cluster of Ray on the loopback alone, for tests: run as a script, it stands until its standard input is closed."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from flapenv.aero.checks import record

ENVIRONMENT = {
    "RAY_AUTH_MODE": "token",
    "RAY_USAGE_STATS_ENABLED": "0",
    "RAY_ENABLE_WINDOWS_OR_OSX_CLUSTER": "0",  # as there, on Linux too: listen on 127.0.0.1 and nowhere else
    "RAY_worker_niceness": "0",
    "RAY_health_check_period_ms": "500",  # a node is missed after seconds
    "RAY_health_check_timeout_ms": "2000",
}
NODES = """
import json, sys, tempfile
from ray.cluster_utils import Cluster

with tempfile.TemporaryDirectory(prefix="nodes-", dir="/tmp", ignore_cleanup_errors=True) as short:
    small = {"num_cpus": 1, "object_store_memory": 100 * 2**20}
    cluster = Cluster(initialize_head=True, head_node_args={**small, "include_dashboard": False, "temp_dir": short})
    node = cluster.add_node(**small)
    [raylet] = node.all_processes["raylet"]
    print(json.dumps({"address": cluster.address, "raylet": raylet.process.pid}), flush=True)
    sys.stdin.read()
    cluster.shutdown()
"""


@record
class Nodes:
    """Two nodes with one CPU each.

    Attributes:
        address: of the head.
        raylet: process id of the other node's raylet, whose children are that node's workers.
        environment: of a process that may connect.
    """

    address: str
    raylet: int
    environment: dict[str, str]

    def kill_the_other(self) -> None:
        """Kill the other node with all of its workers, as a power cut would."""
        doomed = [self.raylet, *children(self.raylet)]
        for one in doomed:
            with contextlib.suppress(ProcessLookupError):
                os.kill(one, signal.SIGKILL)


def children(process: int) -> list[int]:
    """Ids of the processes that a process has started."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            parent = path.read_text().rpartition(")")[2].split()[1]
            if int(parent) == process:
                found.append(int(path.parent.name))
    return found


@contextlib.contextmanager
def loopback_nodes(token: str) -> Iterator[Nodes]:
    """Two nodes, gone at the end whatever has happened."""
    environment = {**os.environ, **ENVIRONMENT, "RAY_AUTH_TOKEN": token}
    command = [sys.executable, "-c", NODES]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, env=environment, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, text=True, start_new_session=True
    ) as keeper:
        assert keeper.stdin is not None
        assert keeper.stdout is not None
        try:
            told = next(line for line in keeper.stdout if line.startswith("{"))
            yield Nodes(**json.loads(told), environment=environment)
        finally:
            keeper.stdin.close()
            try:
                keeper.wait(timeout=20)
            except subprocess.TimeoutExpired:
                os.killpg(keeper.pid, signal.SIGKILL)
            time.sleep(0.1)
