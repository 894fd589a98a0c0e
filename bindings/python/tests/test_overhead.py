"""What Python adds to a step of the library."""

import timeit

import numpy as np
import pytest

from asttrack import Tracker

GROSS = 200.0  # microseconds: far above any machine's noise, far below what copying a frame or rebuilding the structures costs
FRAME = np.random.default_rng(0).integers(0, 256, (240, 320), dtype=np.uint8)


@pytest.fixture
def tracker() -> Tracker:
    """The least work that a tracker can be given, so that what Python adds is most of an update."""
    smallest = Tracker("tiny", particles=1, patch_width=4, patch_height=4, history=1, basis_size=1, bag_size=1, bag_interval=10000)
    smallest.init(FRAME, (100, 100, 8, 8))
    return smallest


def test_update_adds_little_to_a_step(tracker: Tracker) -> None:
    """The same step by `update` and by a bare foreign call, in short runs of which the quickest counts.

    The figure is printed (`pytest -s`); only a gross mistake fails, since speed depends on the machine and its load.
    """
    step, arguments = tracker._step, tracker._step_arguments
    updates = timeit.repeat(lambda: tracker.update(FRAME), number=200, repeat=50)
    steps = timeit.repeat(lambda: step(*arguments), number=200, repeat=50)
    whole, bare = (1e6 * min(times) / 200 for times in (updates, steps))
    print(f"update {whole:.2f} us, of it the bare foreign call {bare:.2f} us: update adds {whole - bare:.2f} us")
    assert whole < GROSS
