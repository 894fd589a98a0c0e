"""Saving, restoring, pickling, copying."""

import copy
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from asttrack import AstError, ErrorCode, Result, Tracker
from short_scene import BOXES, FRAMES

MIDDLE = 14


def halfway(**config: Any) -> Tracker:
    tracker = Tracker("tiny", bag_interval=3, **config)
    tracker.init(FRAMES[0], BOXES[0])
    for frame in FRAMES[1:MIDDLE]:
        tracker.update(frame)
    return tracker


def finish(tracker: Tracker) -> tuple[list[Result], bytes]:
    """The rest of the sequence, and the state after it."""
    return [tracker.update(frame) for frame in FRAMES[MIDDLE:]], tracker.save()


def test_a_restored_tracker_continues_bit_for_bit() -> None:
    tracker = halfway()
    state = tracker.save()
    expected = finish(tracker)
    tracker.restore(state)
    assert finish(tracker) == expected
    other = Tracker("tiny", bag_interval=3)
    other.restore(bytearray(state))
    assert finish(other) == expected
    other.restore(memoryview(state))
    assert other.save() == state


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_a_pickled_tracker_continues_bit_for_bit(protocol: int) -> None:
    tracker = halfway(alpha=0.1, sigma=0.013, seed=2**63 + 1, colour="rgb")
    copied = pickle.loads(pickle.dumps(tracker, protocol))
    assert copied.config == tracker.config
    assert copied.colour == "rgb"
    assert finish(copied) == finish(tracker)


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy])
def test_copies_are_independent(duplicate: Any) -> None:
    tracker = halfway()
    copied = duplicate(tracker)
    before = tracker.save()
    expected = finish(copied)
    assert tracker.save() == before
    assert finish(tracker) == expected


def test_another_process_continues_bit_for_bit(tmp_path: Path) -> None:
    tracker = halfway()
    state = tmp_path / "tracker.pickle"
    state.write_bytes(pickle.dumps((tracker, FRAMES[MIDDLE:])))
    code = (
        "import pickle, sys\n"
        "tracker, frames = pickle.load(open(sys.argv[1], 'rb'))\n"
        "sys.stdout.buffer.write(pickle.dumps([tracker.update(frame) for frame in frames]))\n"
    )
    run = subprocess.run([sys.executable, "-c", code, state], check=True, capture_output=True)
    assert pickle.loads(run.stdout) == finish(tracker)[0]


def test_a_tracker_is_pickled_before_its_start() -> None:
    copied = pickle.loads(pickle.dumps(Tracker("paper", particles=50)))
    assert copied.config == Tracker("paper", particles=50).config
    with pytest.raises(AstError):
        copied.save()


def test_a_subclass_is_pickled_as_itself() -> None:
    assert type(pickle.loads(pickle.dumps(Named("tiny")))) is Named


class Named(Tracker):
    """A subclass, at module level for pickle."""


def test_damaged_states_are_refused_and_change_nothing() -> None:
    tracker = halfway()
    state = tracker.save()
    tracker.update(FRAMES[MIDDLE])
    before = tracker.save()
    altered = bytearray(state)
    altered[len(altered) // 2] ^= 1
    for damaged in (b"", b"text", state[:-1], state[: len(state) // 2], bytes(altered), bytes(len(state))):
        with pytest.raises(AstError) as caught:
            tracker.restore(damaged)
        assert caught.value.code is ErrorCode.CORRUPT
    assert tracker.save() == before


def test_a_state_of_another_configuration_is_refused() -> None:
    state = halfway().save()
    for other in (Tracker("tiny"), Tracker("tiny", bag_interval=3, particles=99), Tracker("tiny", bag_interval=3, seed=2)):
        with pytest.raises(AstError) as caught:
            other.restore(state)
        assert caught.value.code is ErrorCode.MISMATCH
    plain: dict[str, Any] = {"background": 0, "background_refresh": 0}  # which every scoring goes with
    Tracker("tiny", bag_interval=3, scoring="literal", **plain).restore(halfway(**plain).save())


@pytest.mark.parametrize("state", [None, 5, "text", [1, 2]])
def test_a_state_is_bytes(state: Any) -> None:
    with pytest.raises(TypeError, match=f"a saved state is bytes, not {type(state).__name__}"):
        Tracker("tiny").restore(state)
