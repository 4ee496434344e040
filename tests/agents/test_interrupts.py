"""Ctrl-C while something is being kept."""

import signal

import pytest

from agents.interrupts import noted_interrupts


def test_the_first_interrupt_asks_the_second_hurries_and_the_next_ones_wait() -> None:
    before = signal.getsignal(signal.SIGINT)
    kept = False
    with noted_interrupts() as interrupts:
        assert not interrupts.asked
        signal.raise_signal(signal.SIGINT)
        assert interrupts.asked
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        kept = True
    assert kept
    assert signal.getsignal(signal.SIGINT) is before


def test_nothing_hurries_what_is_being_written() -> None:
    with noted_interrupts() as interrupts:
        interrupts.hurrying = False
        for _ in range(3):
            signal.raise_signal(signal.SIGINT)
        assert interrupts.asked
