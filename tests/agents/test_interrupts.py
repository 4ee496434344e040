"""Ctrl-C while something is being kept."""

import signal

import pytest

from agents.interrupts import one_interrupt


def test_the_first_interrupt_raises_and_the_next_ones_wait() -> None:
    before = signal.getsignal(signal.SIGINT)
    kept = False
    with one_interrupt():
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        kept = True
    assert kept
    assert signal.getsignal(signal.SIGINT) is before
