"""What a benchmark ran on: seconds mean nothing without it."""

import os
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from agents.run_folder import versions, write_json
from flapenv.read_json import read_object

MACHINE = "machine.json"
CPU_TABLE = Path("/proc/cpuinfo")
"""Where Linux tells the processor's name."""


def this_machine(jobs: int) -> dict[str, Any]:
    """Processor and versions, and how it is shared.

    Args:
        jobs: runs beside each other, each on one thread.
    """
    return {
        "cpu": _cpu_name(),
        "architecture": platform.machine(),
        "system": platform.system(),
        "cores": os.cpu_count(),
        "runs_at_a_time": jobs,
        "threads_per_run": 1,
        "versions": versions(),
    }


def note_machine(folder: Path, jobs: int) -> None:
    """Add this machine to those that a benchmark ran on, unless it is there already."""
    machines, here = read_machines(folder), this_machine(jobs)
    if here not in machines:
        write_machines(folder, [*machines, here])


def write_machines(folder: Path, machines: Sequence[dict[str, Any]]) -> None:
    """Keep the machines that a benchmark ran on."""
    write_json(folder / MACHINE, {"machines": list(machines)})


def read_machines(folder: Path) -> list[dict[str, Any]]:
    """The machines that a benchmark ran on; none where none were noted.

    Raises:
        ValueError: if the file is not as `write_machines` writes it.
        OSError: if it cannot be read.
    """
    path = folder / MACHINE
    if not path.is_file():
        return []
    machines = read_object(path).get("machines")
    if not isinstance(machines, list) or not all(map(_is_machine, machines)):
        raise ValueError(f"{path} does not tell machines as a benchmark does; allowed: the file as it was written")
    return machines


def _is_machine(one: Any) -> bool:
    """Whether `machine_text` can tell it."""
    return (
        isinstance(one, dict)
        and {"cpu", "architecture", "system", "cores"} <= set(one)
        and isinstance(one.get("runs_at_a_time"), int)
        and isinstance(one.get("versions"), dict)
    )


def machine_text(machines: Sequence[dict[str, Any]]) -> str:
    """Machines in a line each."""
    lines = []
    for one in machines:
        versions_text = ", ".join(f"{name} {version}" for name, version in one["versions"].items())
        at_once = one["runs_at_a_time"]
        lines.append(
            f"{one['cores']} cores of {one['cpu']} ({one['architecture']}, {one['system']}), "
            f"{at_once} run{'s' if at_once > 1 else ''} at a time, one thread each; {versions_text}"
        )
    return "\n".join(lines)


def _cpu_name() -> str:
    """The processor's name as far as the system tells it."""
    if CPU_TABLE.is_file():
        for line in CPU_TABLE.read_text(encoding="utf-8", errors="replace").splitlines():
            key, _, name = line.partition(":")
            if key.strip() in ("model name", "Hardware", "Model") and name.strip():
                return name.strip()
    return platform.processor() or platform.machine()
