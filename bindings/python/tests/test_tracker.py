"""Tracking through the binding."""

import math
import pickle
from typing import Any

import numpy as np
import pytest

import asttrack
from asttrack import AstError, Box, ErrorCode, Result, Status, Tracker
from short_scene import BOXES, FRAMES


def centre_error(a: Box, b: Box) -> float:
    """Distance of the centres of two boxes, pixels."""
    return math.hypot(a.x + a.w / 2 - b.x - b.w / 2, a.y + a.h / 2 - b.y - b.h / 2)


def started(preset: str = "tiny", **config: Any) -> Tracker:
    tracker = Tracker(preset, **config)
    tracker.init(FRAMES[0], BOXES[0])
    return tracker


@pytest.mark.parametrize("preset", ["robust", "paper", "compact", "tiny"])
def test_the_target_is_followed(preset: str) -> None:
    tracker = started(preset)
    results = [tracker.update(frame) for frame in FRAMES[1:]]
    errors = [centre_error(result.box, box) for result, box in zip(results, BOXES[1:], strict=True)]
    assert np.mean(errors) < 4
    assert [result.frame for result in results] == list(range(1, len(FRAMES)))
    assert all(result.status is not Status.LOST for result in results)


def test_a_result_holds_together() -> None:
    tracker = started()
    result = tracker.update(FRAMES[1])
    assert isinstance(result, Result)
    assert isinstance(result.box, Box)
    assert result.box.w == pytest.approx(BOXES[0].w * result.scale, rel=1e-6)
    assert 0 <= result.score <= 1
    assert 1 <= result.effective_particles <= 100
    particles = tracker.particles
    assert result.box.x + result.box.w / 2 == pytest.approx(particles.x[result.best], abs=1e-3)
    assert particles.distance is not None
    assert result.distance == particles.distance[result.best].min()
    with pytest.raises(AttributeError):
        result.score = 1.0  # type: ignore[misc]


def test_the_seed_decides() -> None:
    def boxes(seed: int) -> list[Box]:
        tracker = started(seed=seed)
        return [tracker.update(frame).box for frame in FRAMES[1:8]]

    assert boxes(5) == boxes(5)
    assert boxes(5) != boxes(6)


def test_init_again_starts_again() -> None:
    tracker = started()
    first = [tracker.update(frame) for frame in FRAMES[1:6]]
    tracker.init(FRAMES[0], BOXES[0])
    assert [tracker.update(frame) for frame in FRAMES[1:6]] == first


@pytest.mark.parametrize("box", [(20, 40, 32, 30), [20.0, 40.0, 32.0, 30.0], np.array([20, 40, 32, 30]), Box(20, 40, 32, 30)])
def test_a_box_is_any_four_numbers(box: Any) -> None:
    tracker = Tracker("tiny")
    tracker.init(FRAMES[0], box)
    assert tracker.particles.centre == (36.0, 55.0)
    assert tracker.particles.size == (32.0, 30.0)


@pytest.mark.parametrize(
    ("box", "error"),
    [
        ((1, 2, 3), ValueError),
        ((1, 2, 3, 4, 5), ValueError),
        (5, TypeError),
        (None, TypeError),
        ((1, 2, 3, None), TypeError),
        ("wide", TypeError),
        ("1234", TypeError),
        (b"1234", TypeError),
        ((1, 2, 10**400, 4), ValueError),
    ],
)
def test_a_box_of_another_kind_is_refused(box: Any, error: type[Exception]) -> None:
    with pytest.raises(error, match=r"a box must be four numbers \(x, y, w, h\), not"):
        Tracker("tiny").init(FRAMES[0], box)


@pytest.mark.parametrize(
    "box",
    [
        (0, 0, 0, 5),
        (0, 0, 5, 0.5),
        (0, 0, -5, 5),
        (160, 0, 5, 5),
        (-5, 0, 5, 5),
        (math.nan, 0, 5, 5),
        (0, 0, math.inf, 5),
        (0, 0, 1e300, 5),
    ],
)
def test_an_illegal_box_is_the_librarys_error(box: tuple[float, float, float, float]) -> None:
    tracker = started()
    before = tracker.save()
    with pytest.raises(AstError, match="the box is") as caught:
        tracker.init(FRAMES[0], box)
    assert (caught.value.code, caught.value.field) == (ErrorCode.BOX, None)
    assert tracker.save() == before


def test_everything_but_init_wants_a_start() -> None:
    tracker = Tracker("tiny")
    for call in (
        lambda: tracker.update(FRAMES[0]),
        lambda: tracker.update_cv(FRAMES[0]),
        lambda: tracker.particles,
        lambda: tracker.bag,
        lambda: tracker.history,
        tracker.save,
    ):
        with pytest.raises(AstError, match="not been started") as caught:
            call()
        assert caught.value.code is ErrorCode.NOT_STARTED


def test_a_frame_may_change_its_size() -> None:
    tracker = started()
    tracker.update(FRAMES[1])
    small = tracker.update(FRAMES[2][:60, :80])
    assert 0 <= small.box.x + small.box.w / 2 <= 80 + 1e-3
    assert 0 <= small.box.y + small.box.h / 2 <= 60 + 1e-3
    assert tracker.update(FRAMES[3]).frame == 3


# ---- The paper's initialisation ----


def test_a_sequence_starts_with_a_full_history() -> None:
    tracker = Tracker("tiny", history=3)
    tracker.init_sequence(FRAMES[:5], BOXES[:5])
    assert len(tracker.history) == 3
    assert len(tracker.bag) == 1
    last = BOXES[4]
    assert tracker.particles.centre == pytest.approx((last.x + last.w / 2, last.y + last.h / 2))
    results = [tracker.update(frame) for frame in FRAMES[5:]]
    assert np.mean([centre_error(result.box, box) for result, box in zip(results, BOXES[5:], strict=True)]) < 4


def test_a_sequence_takes_any_layout_in_each_frame() -> None:
    frames = [FRAMES[0], np.dstack([FRAMES[1]] * 3), np.asfortranarray(FRAMES[2])]
    mixed, plain = Tracker("tiny"), Tracker("tiny")
    mixed.init_sequence(frames, BOXES[:3])
    plain.init_sequence(FRAMES[:3], BOXES[:3])
    assert mixed.save() == plain.save()


def test_one_frame_is_a_sequence() -> None:
    tracker = Tracker("tiny")
    tracker.init_sequence(FRAMES[:1], BOXES[:1])
    assert tracker.save() == started().save()


@pytest.mark.parametrize(("frames", "boxes"), [(0, 0), (2, 3), (3, 2)])
def test_a_sequence_needs_a_box_for_each_frame(frames: int, boxes: int) -> None:
    with pytest.raises(ValueError, match=f"not {frames} frames and {boxes} boxes"):
        Tracker("tiny").init_sequence(FRAMES[:frames], BOXES[:boxes])


def test_a_bad_box_in_a_sequence_leaves_the_tracker() -> None:
    tracker = started()
    before = tracker.save()
    with pytest.raises(AstError) as caught:
        tracker.init_sequence(FRAMES[:2], [BOXES[0], Box(500, 0, 5, 5)])
    assert caught.value.code is ErrorCode.BOX
    assert tracker.save() == before


# ---- OpenCV's face ----


def test_update_cv_gives_whole_pixels() -> None:
    tracker, twin = started(), started()
    ok, box = tracker.update_cv(FRAMES[1])
    assert ok is True
    assert box == tuple(round(side) for side in twin.update(FRAMES[1]).box)
    assert all(type(side) is int for side in box)


def test_update_cv_says_when_the_object_is_lost() -> None:
    tracker = started("robust", lost_after=2)
    for frame in FRAMES[1:5]:
        assert tracker.update_cv(frame)[0]
    noise = np.random.default_rng(0).integers(0, 256, FRAMES[0].shape, dtype=np.uint8)
    seen = [tracker.update_cv(noise)[0] for _ in range(6)]
    assert seen[-1] is False


def test_the_code_of_an_opencv_user_runs() -> None:
    cv2 = pytest.importorskip("cv2", reason="OpenCV is not installed: extra eval")

    def follow(tracker: Any, update: str) -> list[Any]:
        tracker.init(np.dstack([FRAMES[0]] * 3), tuple(round(side) for side in BOXES[0]))
        return [getattr(tracker, update)(np.dstack([frame] * 3)) for frame in FRAMES[1:10]]

    for found in (follow(cv2.TrackerMIL_create(), "update"), follow(Tracker(), "update_cv")):
        assert [(type(ok), [type(side) for side in box]) for ok, box in found] == [(bool, [int] * 4)] * 9


# ---- Life ----


def test_a_context_closes() -> None:
    with started() as tracker:
        tracker.update(FRAMES[1])
        inside = (tracker.closed, repr(tracker))
    assert inside == (False, "<asttrack.Tracker: 92 particles, patches of 16 x 16, bag of 5>")
    assert (tracker.closed, repr(tracker)) == (True, inside[1].replace(">", ", closed>"))


def test_a_closed_tracker_says_so() -> None:
    tracker = started()
    state = tracker.save()
    tracker.close()
    tracker.close()
    for call in (
        lambda: tracker.init(FRAMES[0], BOXES[0]),
        lambda: tracker.init_sequence(FRAMES[:1], BOXES[:1]),
        lambda: tracker.update(FRAMES[1]),
        lambda: tracker.update_cv(FRAMES[1]),
        lambda: tracker.particles,
        lambda: tracker.bag,
        lambda: tracker.history,
        tracker.save,
        lambda: tracker.restore(state),
        lambda: pickle.dumps(tracker),
    ):
        with pytest.raises(ValueError, match="this tracker is closed"):
            call()
    assert tracker.config["particles"] == 92  # what needs no memory still answers


def test_memory_is_stated_and_depends_on_the_configuration_alone() -> None:
    tracker = Tracker("tiny")
    before = tracker.memory_size
    tracker.init(FRAMES[0], BOXES[0])
    tracker.update(np.zeros((500, 700, 3), np.uint8))
    assert tracker.memory_size == before < 200_000
    assert Tracker("tiny", bag_size=10).memory_size > before


def test_errors_survive_pickling() -> None:
    with pytest.raises(AstError) as caught:
        Tracker(particles=0)
    copied = pickle.loads(pickle.dumps(caught.value))
    assert (copied.code, copied.field, str(copied)) == (caught.value.code, "particles", str(caught.value))
    unknown = AstError(-99, "new in a later version")
    assert (unknown.code, str(unknown)) == (-99, "new in a later version")


def test_the_five_lines_of_the_documentation() -> None:
    tracker = asttrack.Tracker()
    tracker.init(FRAMES[0], BOXES[0])
    for frame in FRAMES[1:3]:
        result = tracker.update(frame)
    assert result.status.name == "TRACKING"
