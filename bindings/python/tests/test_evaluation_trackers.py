"""The trackers that are compared: how they are named, and what they do alike."""

from pathlib import Path

import cv2
import numpy as np
import pytest

import small_sequence
from asttrack import Box
from asttrack.evaluation.processes import run_each
from asttrack.evaluation.protocol import Run, Task, run
from asttrack.evaluation.trackers import PEERS, AsttrackSpec, OpencvSpec, parse_trackers
from asttrack.failures import DataError, MissingExtraError, UsageError


def test_a_list_names_presets_fields_and_peers() -> None:
    ours, paper, changed, peer = parse_trackers(
        "asttrack, asttrack:paper,asttrack:paper:alpha=2.5,particles=80,basis=raw,csrt", "tiny"
    )
    assert ours == AsttrackSpec("asttrack", "tiny")
    assert paper == AsttrackSpec("asttrack:paper", "paper")
    assert changed == AsttrackSpec(
        "asttrack:paper:alpha=2.5,particles=80,basis=raw", "paper", (("alpha", 2.5), ("particles", 80), ("basis", "raw"))
    )
    assert peer is PEERS["csrt"]
    settings = changed.make(7).tracker.config
    assert (settings["alpha"], settings["particles"], settings["basis"], settings["seed"]) == (2.5, 80, "raw", 7)


def test_fields_may_follow_without_a_preset() -> None:
    (spec,) = parse_trackers("asttrack:particles=0x40,seed=3", "paper")
    assert spec == AsttrackSpec("asttrack:particles=0x40,seed=3", "paper", (("particles", 64), ("seed", 3)))
    assert spec.repeats
    assert spec.make(9).tracker.config["seed"] == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no trackers given"),
        ("asttrack,asttrack", "asttrack: given twice"),
        ("struck", "struck: unknown tracker: there are asttrack"),
        ("csrt:1", "csrt:1: unknown tracker"),
        ("asttrack:best", "there is no preset 'best': there are paper, robust, tiny"),
        ("asttrack:paper:alpha", "alpha: not field=value"),
        ("asttrack:paper:alpha=", "alpha=: not field=value"),
        ("asttrack:paper:alpha=x", "alpha=x: not a number"),
        ("asttrack:paper:particles=2.5", "particles=2.5: not an integer"),
        ("asttrack:paper:alpha=1:2", "more than asttrack"),
    ],
)
def test_a_list_that_makes_no_sense_is_refused(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        parse_trackers(text, "robust")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("asttrack:tiny:particles=0", "asttrack:tiny:particles=0: particles=0: the legal range is"),
        ("asttrack:tiny:particels=9", "did you mean particles"),
        ("asttrack:tiny:basis=cooked", "it takes one of 'centred', 'raw'"),
    ],
)
def test_a_configuration_that_the_library_refuses_is_usage(text: str, message: str) -> None:
    (spec,) = parse_trackers(text, "robust")
    with pytest.raises(UsageError, match=message):
        spec.check()


@pytest.mark.parametrize("label", [label for label in PEERS if label != "mosse"])
def test_every_peer_is_there_and_follows(label: str) -> None:
    spec, scene = PEERS[label], small_sequence.SCENE
    spec.check()
    follower = spec.make(1)
    follower.init(scene.frame(0), Box(*map(float, map(round, scene.box(0)))))
    for index in range(1, 6):
        step = follower.update(follower.prepare(scene.frame(index)))
    assert step.ok
    assert np.isnan(step.score)
    truth = scene.box(5)
    assert abs(step.box.x + step.box.w / 2 - truth.x - truth.w / 2) < 8
    assert abs(step.box.y + step.box.h / 2 - truth.y - truth.h / 2) < 8


def test_an_opencv_without_contrib_says_which_extra_brings_the_tracker(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(cv2, "TrackerCSRT_create")
    monkeypatch.delattr(cv2, "legacy")
    for label in ("csrt", "tld"):
        with pytest.raises(MissingExtraError, match=rf"{label}: this OpenCV .* pip install './bindings/python\[peers\]'"):
            PEERS[label].check()
    PEERS["mil"].check()


@pytest.mark.parametrize("label", ["kcf", "mosse"])
def test_a_lost_opencv_tracker_keeps_its_last_box(label: str) -> None:
    scene = small_sequence.SCENE
    follower = PEERS[label].make(1)
    first = Box(*map(float, map(round, scene.box(0))))
    follower.init(scene.frame(0), first)
    last = follower.update(follower.prepare(scene.frame(0)))
    assert last.ok
    noise = np.random.default_rng(1).integers(0, 256, (scene.height, scene.width), np.uint8)
    lost = follower.update(follower.prepare(noise))
    assert (lost.ok, lost.box) == (False, last.box)


def test_what_opencv_cannot_do_is_one_line() -> None:
    follower = PEERS["csrt"].make(1)
    with pytest.raises(DataError, match=r"^OpenCV: ") as failure:
        follower.init(small_sequence.SCENE.frame(0), Box(1000.0, 1000.0, 20.0, 20.0))
    assert "\n" not in str(failure.value)


def test_our_tracker_gives_score_and_status() -> None:
    scene = small_sequence.SCENE
    follower = AsttrackSpec("asttrack", "tiny").make(1)
    follower.init(scene.frame(0), scene.box(0))
    step = follower.update(follower.prepare(scene.frame(1)))
    assert step.ok
    assert 0 < step.score <= 1
    assert step.box.w / scene.box(0).w == pytest.approx(step.box.h / scene.box(0).h, rel=1e-5)


def test_a_box_outside_the_frame_is_a_data_error() -> None:
    with pytest.raises(DataError, match="outside"):
        AsttrackSpec("asttrack", "tiny").make(1).init(small_sequence.SCENE.frame(0), Box(1000, 1000, 20, 20))


def tracks(tmp_path: Path, spec: AsttrackSpec | OpencvSpec, seeds: list[int]) -> list[Run]:
    sequence = small_sequence.write(tmp_path / "scene", small_sequence.HARD)
    runs = []
    for _, outcome in run_each(run, [Task(sequence, spec, seed) for seed in seeds], 1, ["asttrack.evaluation.protocol"]):
        assert isinstance(outcome, Run), outcome
        assert outcome.error is None
        runs.append(outcome)
    return runs


@pytest.mark.parametrize("label", ["asttrack", "mil", "tld"])
def test_the_seed_decides_a_random_tracker(tmp_path: Path, label: str) -> None:
    (spec,) = parse_trackers(label, "tiny")
    assert not spec.repeats
    one, again, *others = tracks(tmp_path, spec, [1, 1, 2, 3, 4])
    assert np.array_equal(one.boxes, again.boxes)
    assert any(not np.array_equal(one.boxes, other.boxes) for other in others)


@pytest.mark.parametrize("label", [label for label, spec in PEERS.items() if spec.repeats])
def test_the_others_repeat_whatever_the_seed(tmp_path: Path, label: str) -> None:
    one, other = tracks(tmp_path, PEERS[label], [1, 2])
    assert np.array_equal(one.boxes, other.boxes)
