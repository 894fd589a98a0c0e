"""Recovery: the measure on tracks made by hand, the list of events, and the command on scenes that are rendered."""

import csv
import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

import c_command
import small_sequence
from asttrack.evaluation.metrics import Floats
from asttrack.evaluation.protocol import ONE_PASS, Run
from asttrack.evaluation.recovery import (
    HOLD,
    WITHIN,
    Event,
    Recovery,
    confidences,
    examine,
    frames_to_recover,
    half_inside,
    parse_events,
    recover,
    render,
    summaries,
)
from asttrack.evaluation.results import measure
from asttrack.evaluation.sequence import Sequence
from asttrack.evaluation.trackers import parse_trackers
from asttrack.failures import DataError, UsageError

EVENT = Event("occlusion", 5)
TRUTH = np.tile([100.0, 100, 40, 40], (60, 1))
GONE = np.arange(20, 25)  # the frames in which the object is hidden
BACK = 25


def recovery(wrong: list[int], *, truth: Floats = TRUTH, gone: Floats | None = None, lost: list[int] | None = None) -> Recovery:
    """Of a tracker that is off the object in some frames, and says lost in some."""
    boxes = np.nan_to_num(truth, nan=100.0)
    boxes[wrong, 1] += 80
    ok = np.ones(len(truth), bool)
    ok[lost or []] = False
    labels = np.zeros(len(truth), bool)
    labels[GONE if gone is None else gone] = True
    paths = tuple(Path(str(number)) for number in range(len(truth)))
    sequence = Sequence("s", Path("s"), paths, truth, labels=labels)
    run = Run("s", "asttrack", 1, ONE_PASS.name, boxes, ok, np.linspace(1, 0, len(truth)), 1.0)
    return examine(measure(run, sequence), sequence, EVENT, 1)


# ---- The measure ----


def test_frames_count_from_the_return_of_the_object() -> None:
    assert recovery([]).took == 1
    assert recovery(list(range(20, BACK + 3))).took == 4
    assert np.isnan(recovery(list(range(20, 60))).took)


def test_soon_enough_is_within_the_frames_stated() -> None:
    assert recovery(list(range(20, BACK + WITHIN - 1))).took == WITHIN
    assert recovery(list(range(20, BACK + WITHIN - 1))).recovered
    assert not recovery(list(range(20, BACK + WITHIN))).recovered
    assert not recovery(list(range(20, 60))).recovered


def test_an_object_that_passes_a_waiting_box_is_not_found() -> None:
    passing = [frame for frame in range(20, 60) if not 30 <= frame < 30 + HOLD - 1]
    assert np.isnan(recovery(passing).took)
    held = [frame for frame in range(20, 60) if not 30 <= frame < 30 + HOLD]
    assert recovery(held).took == 30 - BACK + 1


def test_a_find_needs_its_frames_before_the_end() -> None:
    on_it = np.zeros(20, bool)
    on_it[-HOLD:] = True
    assert frames_to_recover(on_it, 10) == 20 - HOLD - 10 + 1
    on_it[-HOLD] = False
    assert np.isnan(frames_to_recover(on_it, 10))


def test_half_the_overlap_is_on_the_object() -> None:
    truth = TRUTH.copy()
    truth[BACK:, 2] = 81  # twice the tracked box and a pixel: overlap 40 / 81
    boxes = np.tile(TRUTH[0], (60, 1))
    labels = np.zeros(60, bool)
    labels[GONE] = True
    sequence = Sequence("s", Path("s"), tuple(map(Path, map(str, range(60)))), truth, labels=labels)
    run = Run("s", "asttrack", 1, ONE_PASS.name, boxes, np.ones(60, bool), np.ones(60), 1.0)
    assert np.isnan(examine(measure(run, sequence), sequence, EVENT, 1).took)
    truth[BACK:, 2] = 80
    assert examine(measure(run, sequence), sequence, EVENT, 1).took == 1


def test_an_object_is_back_when_half_of_it_is_in_the_frame() -> None:
    truth = TRUTH.copy()
    truth[BACK : BACK + 4, 0] = 320 - np.array([5, 10, 19, 20])
    truth[GONE] = np.nan
    assert half_inside(truth, 320, 240)[BACK : BACK + 5].tolist() == [False, False, False, True, True]
    assert not half_inside(truth, 320, 240)[GONE].any()
    assert recovery([], truth=truth).took == 1
    assert recovery([BACK + 3], truth=truth).took == 2


def test_who_had_it_before_and_who_said_so() -> None:
    assert recovery([]).held
    assert not recovery(list(range(10, 20))).held
    assert recovery(list(range(11, 20))).held
    assert recovery([], lost=[22]).noticed
    assert not recovery([], lost=[19, 25]).noticed


@pytest.mark.parametrize("gone", [np.array([], int), np.arange(40, 60)])
def test_a_scene_without_a_return_is_none(gone: Floats) -> None:
    with pytest.raises(DataError, match="the object does not vanish and come back"):
        recovery([], gone=gone)


def test_a_summary_counts_every_scene() -> None:
    late, never = recovery(list(range(20, 45))), recovery(list(range(20, 60)), lost=[20])
    failed = Recovery(EVENT, 4, "asttrack", False, False, float("nan"), None, "a reason")
    (line,) = summaries([recovery([]), late, never, failed])
    assert (line.runs, line.held, line.noticed, line.recovered, line.ever) == (4, 3, 1, 1, 2)
    assert line.took == pytest.approx((1 + 21) / 2)
    figures = confidences([recovery([]), late, never, failed])["asttrack"]
    wrong = 5 + 25 + 40
    assert figures["wrong"] == pytest.approx(100 * wrong / (3 * 59))


# ---- The command ----


def test_events_are_read() -> None:
    assert parse_events("occlusion:50, leave:2,cut:7") == [Event("occlusion", 50), Event("leave", 2), Event("cut", 7)]
    (met,) = parse_events("occlusion:50:look-alike")
    assert (met, met.name) == (Event("occlusion", 50, met=True), "occlusion:50:look-alike")
    for text in ("occlusion", "fog:5", "leave:0", "leave:-1", "cut:x", "cut:5:", "cut:5:twin", ""):
        with pytest.raises(UsageError, match=f"{text}: not an event: occlusion:FRAMES, leave:FRAMES, cut:FRAMES, "):
            parse_events(text)
    with pytest.raises(UsageError, match="an event is given twice"):
        parse_events("cut:5,cut:5")


def command(*words: object) -> subprocess.CompletedProcess[str]:
    whole = [sys.executable, "-m", "asttrack", "recovery", *map(str, words)]
    return subprocess.run(whole, capture_output=True, text=True, check=False, timeout=300)


@pytest.mark.slow
def test_the_command_renders_counts_and_writes(tmp_path: Path) -> None:
    trackers = ("--trackers", "asttrack,medianflow", "--preset", "tiny")
    done = command(
        "--synth", c_command.find(), "--events", "occlusion:5,cut:5", "--scenes", 1, "--jobs", 2, *trackers, "--out", tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    counts = [line.split() for line in done.stdout.splitlines() if re.match(r"(occlusion|cut):5 ", line)]
    assert [words[:3] for words in counts] == [
        [event, tracker, "1"] for event in ("occlusion:5", "cut:5") for tracker in ("asttrack", "medianflow")
    ]
    with (tmp_path / "recovery.csv").open() as stream:
        lines = list(csv.DictReader(stream))
    assert [(line["event"], line["frames"], line["tracker"]) for line in lines] == [
        (event, "5", tracker) for event in ("occlusion", "cut") for tracker in ("asttrack", "medianflow")
    ]
    # A tracker that does not lose an object in five frames of the scene's start is on it before.
    assert lines[0]["held"] == "1"
    assert (tmp_path / "recovery.md").read_text().count("| asttrack |") == 3


def test_only_scenes_that_ask_for_it_have_a_look_alike(tmp_path: Path) -> None:
    asked = tmp_path / "asked"
    script = tmp_path / "recorder"
    script.write_text(f'#!/bin/sh\necho "$*" >>{asked}\nexit 1\n')
    script.chmod(0o755)
    for event in (EVENT, Event("cut", 5, met=True)):
        with pytest.raises(DataError):
            render(script, tmp_path, event, 1)
    assert ["--alone" in line.split() for line in asked.read_text().splitlines()] == [True, False]


@pytest.fixture
def copier(tmp_path: Path) -> Path:
    """In the place of the command: a scene of four frames of absence, whatever is asked for."""
    scene = tmp_path / "scene"
    small_sequence.write(scene)
    (scene / "absence.label").write_text("0\n" * 8 + "1\n" * 4 + "0\n" * 12)
    script = tmp_path / "copier"
    script.write_text(f'#!/bin/sh\ncp -r {scene} "$2"\n')
    script.chmod(0o755)
    return script


def test_every_tracker_goes_through_every_scene(copier: Path) -> None:
    trackers = parse_trackers("asttrack,medianflow", "tiny")
    found, interrupted = recover(copier, [Event("leave", 4), EVENT], 2, trackers, 2, small_sequence.unseen)
    assert not interrupted
    assert [(one.event.name, one.tracker, one.scene) for one in found] == [
        (event, tracker, scene)
        for event in ("leave:4", "occlusion:5")
        for tracker in ("asttrack", "medianflow")
        for scene in (1, 2)
    ]
    assert all(one.held and one.error is None for one in found)


def test_an_interrupt_keeps_what_is_finished(copier: Path) -> None:
    def interrupted_after_one(items: Iterable[Recovery], total: int) -> Iterable[Recovery]:
        assert total == 3
        for item in items:
            yield item
            raise KeyboardInterrupt

    found, interrupted = recover(copier, [EVENT], 3, parse_trackers("asttrack", "tiny"), 1, interrupted_after_one)
    assert interrupted
    assert [one.scene for one in found] == [1]


def test_a_run_that_fails_is_told_and_has_not_recovered(copier: Path) -> None:
    (copier.parent / "scene" / "img" / "00010.pgm").write_bytes(b"P5")
    done = command("--synth", copier, "--events", "cut:4", "--scenes", 1, "--preset", "tiny")
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith("asttrack: cut:4, scene 1, asttrack: ")
    assert line.endswith("00010.pgm: not a picture that OpenCV reads, or damaged")
    assert re.search(r"^cut:4 +asttrack +1 +0 +0 +0 +0 +0 +-$", done.stdout, re.MULTILINE)


def test_what_cannot_render_is_named(tmp_path: Path) -> None:
    done = command("--synth", tmp_path / "absent")
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"asttrack: {tmp_path}/absent: no such file: `make` builds the command asttrack")
    broken = tmp_path / "broken"
    broken.write_text("#!/bin/sh\necho 'broken: a reason' >&2; exit 3\n")
    broken.chmod(0o755)
    done = command("--synth", broken, "--events", "cut:5", "--scenes", 1)
    assert (done.returncode, done.stderr) == (1, "asttrack: broken: a reason\n")
