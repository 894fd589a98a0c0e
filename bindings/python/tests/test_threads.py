"""Trackers in threads: the GIL is released during a step, and no sharing corrupts anything."""

import threading
import time
from collections.abc import Callable
from functools import partial
from itertools import product

from asttrack import Tracker
from short_scene import BOXES, FRAMES

ATTEMPTS = 3


def slow_tracker() -> Tracker:
    """A tracker whose step takes some ten milliseconds."""
    tracker = Tracker("paper", particles=1500, patch_width=48, patch_height=48)
    tracker.init_sequence(FRAMES[:3], BOXES[:3])
    return tracker


def run_together(*work: Callable[[], None]) -> None:
    threads = [threading.Thread(target=each) for each in work]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def test_python_goes_on_during_a_step() -> None:
    """On any number of cores, and however busy they are: within one step another thread gets more than the turn that its end gives.

    A step that kept Python to itself would let nobody run from its call to its return, so one that did not is proof enough.
    """
    tracker = slow_tracker()
    finished = threading.Event()
    turns = 0
    most = 0

    def update() -> None:
        nonlocal most
        for _, frame in product(range(ATTEMPTS), FRAMES[3:]):
            before = turns
            tracker.update(frame)
            most = max(most, turns - before)
            if most > 10:
                break
        finished.set()

    worker = threading.Thread(target=update)
    worker.start()
    while not finished.is_set():
        time.sleep(1e-5)
        turns += 1
    worker.join()
    assert most > 10


def test_no_lock_around_a_step_is_shared_by_two_trackers() -> None:
    """Each, with whatever `update` holds during its step, waits before and after it for the other: for ever, behind a shared lock.

    Whether the two calls themselves overlap is not seen here: that a call lets Python go on is shown above, and that the library
    has no lock of its own follows from its having no writable data (`make size`).
    """
    trackers = slow_tracker(), slow_tracker()
    both = threading.Barrier(len(trackers), timeout=300)

    def follow(tracker: Tracker) -> None:
        step = tracker._step

        def meet_and_step(*arguments: object) -> int:
            both.wait()
            code: int = step(*arguments)
            both.wait()
            return code

        tracker._step = meet_and_step  # type: ignore[assignment]
        for frame in FRAMES[3:6]:
            tracker.update(frame)

    run_together(*(partial(follow, tracker) for tracker in trackers))
    assert not both.broken


def test_threads_do_not_change_what_trackers_find() -> None:
    def follow(seed: int, into: dict[int, bytes]) -> None:
        tracker = Tracker("tiny", seed=seed)
        tracker.init(FRAMES[0], BOXES[0])
        for frame in FRAMES[1:]:
            tracker.update(frame)
        into[seed] = tracker.save()

    alone: dict[int, bytes] = {}
    together: dict[int, bytes] = {}
    for seed in range(6):
        follow(seed, alone)
    run_together(*(partial(follow, seed, together) for seed in range(6)))
    assert together == alone


def test_one_tracker_in_many_threads_stays_whole() -> None:
    tracker = Tracker("tiny")
    tracker.init(FRAMES[0], BOXES[0])
    failures: list[BaseException] = []

    def use() -> None:
        try:
            for frame in FRAMES[1:]:
                tracker.update(frame)
                assert len(tracker.bag) <= 5
                assert len(tracker.save()) == size
        except BaseException as failure:
            failures.append(failure)

    size = len(tracker.save())
    run_together(*[use] * 4)
    assert failures == []
    assert tracker.update(FRAMES[0]).frame == 4 * (len(FRAMES) - 1) + 1


def test_closing_during_a_step_waits_for_it() -> None:
    tracker = slow_tracker()
    tracker.update(FRAMES[3])
    running = threading.Event()
    ends: list[str] = []

    def update() -> None:
        try:
            while True:
                tracker.update(FRAMES[4])
                running.set()
        except ValueError as error:
            ends.append(str(error))

    worker = threading.Thread(target=update)
    worker.start()
    running.wait()
    tracker.close()
    worker.join()
    assert ends == ["this tracker is closed"]
