"""Sweeps that do not outlive their test."""

import subprocess
from collections.abc import Callable, Iterator

import pytest
import sweeps_alone


@pytest.fixture
def begin() -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start `train.py sweep`; what still runs at the end of the test is killed."""
    started: list[subprocess.Popen[str]] = []

    def start(*arguments: str, environment: dict[str, str] | None = None) -> subprocess.Popen[str]:
        started.append(sweeps_alone.begin(*arguments, environment=environment))
        return started[-1]

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
            process.communicate()
