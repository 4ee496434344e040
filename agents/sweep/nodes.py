"""Whether the nodes of a cluster are fit for a sweep: the same code and packages, and the same storage."""

import hashlib
import secrets
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from agents.run_folder import versions
from flapenv.aero.checks import one_line

ROOT = Path(__file__).parents[2]
PATIENCE = 60.0
"""Seconds that every node has to answer."""


def installed() -> dict[str, str]:
    """What results depend on: versions, and a digest of this code."""
    digest = hashlib.sha256()
    for path in sorted([*ROOT.glob("flapenv/**/*.py"), *ROOT.glob("agents/**/*.py")]):
        digest.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return {**versions(), "source": digest.hexdigest()[:12]}


def look(storage: str, probe: str) -> dict[str, Any]:
    """What a node answers: what it has installed, and why it cannot write into the storage, if so."""
    try:
        (Path(storage) / probe).write_text(probe, encoding="utf-8")
    except OSError as mistake:
        return {"installed": installed(), "cannot": str(mistake)}
    return {"installed": installed(), "cannot": None}


def require_fit_nodes(ray: ModuleType, storage: Path) -> None:
    """Refuse a cluster with a node that could not do what this one would.

    Args:
        ray: connected.
        storage: of the sweep.

    Raises:
        RuntimeError: for a node that lacks the code, or has other versions of it or of a package; names both.
        OSError: for a node that cannot write into the storage, or whose storage is another.
    """
    from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

    asked = {}
    task = ray.remote(look)
    for node in ray.nodes():
        if node["Alive"]:
            here = NodeAffinitySchedulingStrategy(node_id=node["NodeID"], soft=False)
            probe = f".probe-{secrets.token_hex(8)}"
            options = task.options(num_cpus=0, max_retries=0, scheduling_strategy=here)
            name = f"node {node['NodeManagerAddress']} ({node['NodeID'][:8]})"
            asked[name] = (probe, options.remote(str(storage), probe))
    wanted = installed()
    try:
        for name, (probe, reference) in asked.items():
            try:
                answer = ray.get(reference, timeout=PATIENCE)
            except Exception as mistake:  # whatever happens there
                why = str(mistake).strip().splitlines()
                raise RuntimeError(
                    f"{name} cannot run the sweep: {one_line(why[-1] if why else type(mistake).__name__, 300)}; "
                    f"allowed: the same repository, installed at {ROOT} on every node"
                ) from None
            require_fit(name, answer, wanted, storage / probe)
    finally:
        for probe, _ in asked.values():
            (storage / probe).unlink(missing_ok=True)


def require_fit(name: str, answer: Mapping[str, Any], wanted: Mapping[str, str], probe: Path) -> None:
    """Refuse one node's answer.

    Args:
        name: of the node.
        answer: of `look`.
        wanted: what is installed here.
        probe: the file that the node was to write.
    """
    found = answer["installed"]
    others = [f"{key} {found.get(key)}, here {value}" for key, value in wanted.items() if found.get(key) != value]
    if others:
        raise RuntimeError(f"{name} has {'; '.join(others)}; allowed: the same on every node")
    if answer["cannot"] is not None:
        raise OSError(
            f"{name} cannot write into --storage {probe.parent} ({answer['cannot']}); allowed: a shared folder"
        )
    if not probe.exists():
        raise FileNotFoundError(
            f"what {name} writes into --storage {probe.parent} is not seen here; allowed: a folder that all nodes share"
        )
