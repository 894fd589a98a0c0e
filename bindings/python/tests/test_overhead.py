"""What Python adds to a step of the library."""

import sys
import timeit
import tracemalloc

import numpy as np
import pytest

from asttrack import Tracker

MOST_CALLS = 20
FRAME = np.random.default_rng(0).integers(0, 256, (240, 320), dtype=np.uint8)


@pytest.fixture
def tracker() -> Tracker:
    """The least work that a tracker can be given, so that what Python adds is most of an update."""
    smallest = Tracker("tiny", particles=1, patch_width=4, patch_height=4, history=1, basis_size=1, bag_size=1, bag_interval=10000)
    smallest.init(FRAME, (100, 100, 8, 8))
    return smallest


def test_update_adds_little_to_a_step(tracker: Tracker) -> None:
    """By what Python does, which is the same on every machine: few calls, and never memory of a frame's size.

    How long that takes beside the step is printed (`pytest -s`).
    """
    calls: list[str] = []
    tracker.update(FRAME)
    sys.setprofile(lambda _, event, what: calls.append(f"{event} {what}") if event in ("call", "c_call") else None)
    tracker.update(FRAME)
    sys.setprofile(None)
    assert len(calls) <= MOST_CALLS, calls

    tracemalloc.start()
    for _ in range(20):
        tracker.update(FRAME)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < FRAME.nbytes / 4

    step, arguments = tracker._step, tracker._step_arguments
    updates = timeit.repeat(lambda: tracker.update(FRAME), number=200, repeat=10)
    steps = timeit.repeat(lambda: step(*arguments), number=200, repeat=10)
    whole, bare = (1e6 * min(times) / 200 for times in (updates, steps))
    print(f"update {whole:.2f} us, of it the bare foreign call {bare:.2f} us: update adds {whole - bare:.2f} us")
