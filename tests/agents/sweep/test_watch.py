"""A cluster that is lost is noticed, whether it says so, raises or answers no more."""

import pickle
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from agents.sweep import watch
from agents.sweep.queue import Interrupts
from agents.sweep.watch import Watch, dead_node

OWN = {"NodeID": "aabbccddee", "Alive": True}


@pytest.fixture(autouse=True)
def without_patience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watch, "GLANCE", 0.001)


def until(true: Callable[[], Any]) -> None:
    while not true():
        time.sleep(0.001)


def test_only_the_own_node_decides() -> None:
    other = {"NodeID": "ff", "Alive": True}
    assert dead_node([other, OWN], "aabbccddee") is None
    for nodes in ([], [other], [other, {**OWN, "Alive": False}]):
        assert dead_node(nodes, "aabbccddee") == "the node of this process (aabbccdd) is dead"


def test_a_dead_node_ends_the_sweep_at_tunes_next_step() -> None:
    answers: list[str | None] = [None, None, "dead"]
    looked = Watch(lambda: answers.pop(0))
    until(lambda: looked.wrong)
    with pytest.raises(ConnectionError, match="dead"):
        Interrupts([], looked).on_step_begin(0, [])
    with pytest.raises(KeyboardInterrupt):
        Interrupts([2], looked).on_step_begin(0, [])


@pytest.mark.parametrize("raises", [True, False])
def test_silence_is_a_loss(raises: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    called, for_ever = threading.Event(), threading.Event()

    def look() -> None:
        called.set()
        if raises:
            raise RuntimeError("no answer")
        for_ever.wait()

    looked = Watch(look)
    assert called.wait(10)
    assert looked.wrong is None
    Interrupts([], looked).on_step_begin(0, [])
    monkeypatch.setattr(watch, "SILENCE", 0.0)
    assert "has not answered for 0 s" in str(looked.wrong)
    looked.end()
    for_ever.set()


def test_tune_can_write_it_to_disk() -> None:
    looked = Watch(lambda: None)
    pickle.dumps(Interrupts([], looked))
    looked.end()
