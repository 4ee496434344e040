"""The averages that allocate nothing, against those in formulas that tensors and every force law share."""

import concurrent.futures
import multiprocessing
import threading
import tracemalloc
from typing import Any

import numpy as np
import pytest

from flapenv.aero.force_laws import PlateLaw
from flapenv.aero.plate_averages import plate_averages
from flapenv.aero.threads import in_threads
from flapenv.aero.wingbeat import TimeRule, speed_averages, time_rule

RULE = TimeRule(24, 1.6)


def strokes(rng: np.random.Generator, count: int, dtype: type = np.float64) -> list[np.ndarray]:
    """Cφ, θmax, Cθ and δ over all that is valid."""
    columns = rng.uniform(0, 1, count), rng.uniform(0, 1.5, count), rng.uniform(0, 30, count), rng.uniform(-6, 6, count)
    columns[0][:2], columns[2][:2] = (0, 1)[:count], 0
    return [column.astype(dtype) for column in columns]


@pytest.mark.parametrize("count", [1, 7, 5000])
def test_they_equal_the_formulas_that_every_law_shares(rng: np.random.Generator, count: int) -> None:
    values = strokes(rng, count)
    plain = speed_averages(*values, rule=RULE, law=PlateLaw(constant=1.0))
    fast = speed_averages(*values, rule=RULE)
    np.testing.assert_allclose(fast[0], plain[0], rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(fast[1], plain[1] / 2, rtol=1e-12)


def test_blocks_and_the_order_of_calls_change_nothing(rng: np.random.Generator) -> None:
    values = strokes(rng, 9000, np.float32)
    whole = speed_averages(*values, rule=RULE)
    for start, stop in ((0, 9000), (8000, 9000), (10, 11), (0, 5000)):
        part = speed_averages(*(value[start:stop] for value in values), rule=RULE)
        for a, b in zip(part, whole, strict=True):
            np.testing.assert_allclose(a, b[start:stop], rtol=2e-6, atol=1e-7)
    double = speed_averages(*(value.astype(float) for value in values), rule=RULE)
    assert double[0].dtype == np.float64
    assert whole[0].dtype == np.float32
    np.testing.assert_allclose(whole[1], double[1], rtol=1e-5)


def test_results_are_the_callers_own(rng: np.random.Generator) -> None:
    values = strokes(rng, 100)
    first = speed_averages(*values, rule=RULE)[0]
    kept = first.copy()
    speed_averages(*strokes(rng, 100), rule=RULE)
    np.testing.assert_array_equal(first, kept)


def test_threads_do_not_share_what_they_work_on(rng: np.random.Generator) -> None:
    batches = [strokes(rng, 3000) for _ in range(8)]
    alone = [speed_averages(*batch, rule=RULE) for batch in batches]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda batch: speed_averages(*batch, rule=RULE), batches))
    np.testing.assert_array_equal(together, alone)


def test_a_forked_process_has_threads_of_its_own() -> None:
    def work(answer: Any = None) -> None:
        both = threading.Barrier(2, timeout=10)  # neither part ends without the other: two threads, or none

        def wait(part: slice) -> None:
            both.wait()

        in_threads(wait, [slice(0, 1), slice(1, 2)], 2)
        if answer is not None:
            answer.put(2)

    work()  # the pool of this process has its threads
    context = multiprocessing.get_context("fork")
    answer = context.Queue()
    child = context.Process(target=work, args=(answer,))
    child.start()
    child.join(20)
    child.kill()  # where it hangs, the test does not
    assert child.exitcode == 0
    assert answer.get(timeout=1) == 2


def test_memory_does_not_grow_with_the_batch_beyond_its_results(rng: np.random.Generator) -> None:
    fractions, weights = (column.astype(np.float32) for column in time_rule(0.99, 10.0, tolerance=1e-5).points)
    peaks = []
    for count in (20_000, 200_000):
        values = strokes(rng, count, np.float32)
        tracemalloc.start()
        plate_averages(*values, fractions=fractions, weights=weights)
        peaks.append(tracemalloc.get_traced_memory()[1] - 2 * 4 * count)
        tracemalloc.stop()
    assert peaks[1] < peaks[0] + 100_000
