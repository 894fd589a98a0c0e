"""Runs that are kept: taken again when nothing that decides them has changed, and only then."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import small_sequence
from asttrack.evaluation.evaluate import evaluate
from asttrack.evaluation.kept_runs import KeptRuns
from asttrack.evaluation.protocol import SPATIAL, Run, Task, run
from asttrack.evaluation.sequence import Sequence
from asttrack.evaluation.trackers import parse_trackers
from asttrack.failures import DataError


@pytest.fixture(scope="module")
def sequence(tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    return small_sequence.write(tmp_path_factory.mktemp("kept") / "scene")


@pytest.fixture(scope="module")
def task(sequence: Sequence) -> Task:
    return Task(sequence, parse_trackers("asttrack:tiny:bag_interval=3", "tiny")[0], 1, look_inside=True)


@pytest.fixture(scope="module")
def done(task: Task) -> Run:
    return run(task)


def test_a_kept_run_comes_back_whole(task: Task, done: Run, tmp_path: Path) -> None:
    kept = KeptRuns(tmp_path)
    assert kept.find(task) is None
    kept.keep(task, done)
    found = kept.find(task)
    assert found is not None
    assert (found.sequence, found.tracker, found.seed, found.start) == (done.sequence, done.tracker, done.seed, done.start)
    assert np.array_equal(found.boxes, done.boxes)
    assert np.array_equal(found.ok, done.ok)
    assert np.array_equal(found.score, done.score, equal_nan=True)
    assert found.seconds == done.seconds
    assert len(found.bag) == len(done.bag) > 1
    for one, other in zip(found.bag, done.bag, strict=True):
        assert one.frame == other.frame
        for a, b in ((one.crop, other.crop), (one.mean, other.mean), (one.basis, other.basis)):
            assert a is not None
            assert b is not None
            assert np.array_equal(a, b)


def test_whatever_decides_a_run_makes_another(task: Task, done: Run, tmp_path: Path) -> None:
    kept = KeptRuns(tmp_path)
    kept.keep(task, done)
    moved = replace(task.sequence, truth=task.sequence.truth + 1)
    fewer = replace(task.sequence, frames=task.sequence.frames[:-1], truth=task.sequence.truth[:-1])
    others = [
        replace(task, seed=2),
        replace(task, start=SPATIAL[0]),
        replace(task, look_inside=False),
        replace(task, sequence=moved),
        replace(task, sequence=fewer),
        replace(task, tracker=parse_trackers("asttrack:tiny:bag_interval=4", "tiny")[0]),
        replace(task, tracker=parse_trackers("medianflow", "tiny")[0]),
    ]
    assert [kept.find(other) for other in others] == [None] * len(others)
    # A label is only a name.
    assert kept.find(replace(task, tracker=replace(task.tracker, label="another"))) is not None


def test_a_changed_picture_makes_another(tmp_path: Path) -> None:
    sequence = small_sequence.write(tmp_path / "scene")
    task = Task(sequence, parse_trackers("medianflow", "tiny")[0], 1)
    kept = KeptRuns(tmp_path / "runs")
    kept.keep(task, run(task))
    assert kept.find(task) is not None
    sequence.frames[3].write_bytes(sequence.frames[4].read_bytes())
    assert kept.find(task) is None


def test_a_damaged_file_is_no_run(task: Task, done: Run, tmp_path: Path) -> None:
    kept = KeptRuns(tmp_path)
    kept.keep(task, done)
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()
    for damaged in (b"", whole[: len(whole) // 2], b"text"):
        path.write_bytes(damaged)
        assert kept.find(task) is None


def test_an_evaluation_that_was_ended_goes_on(sequence: Sequence, tmp_path: Path) -> None:
    def ended_after_two(items: object, total: int) -> object:
        assert total == 4
        for count, item in enumerate(items, 1):  # type: ignore[arg-type, var-annotated]
            yield item
            if count == 2:
                raise KeyboardInterrupt

    def evaluated(progress: object) -> tuple[list[Run], bool]:
        evaluation, interrupted = evaluate(
            [sequence],
            parse_trackers("asttrack", "tiny"),
            seeds=4,
            jobs=1,
            spatial=False,
            progress=progress,  # type: ignore[arg-type]
            kept=KeptRuns(tmp_path),
        )
        return [measured.run for measured in evaluation.runs], interrupted

    before, interrupted = evaluated(ended_after_two)
    assert interrupted
    kept = {path: path.stat().st_mtime_ns for path in tmp_path.iterdir()}
    assert len(before) == len(kept) == 2
    after, interrupted = evaluated(small_sequence.unseen)
    assert not interrupted
    assert [one.seed for one in after] == [1, 2, 3, 4]
    # Processor time differs from run to run: the first two were not run again.
    assert [one.seconds for one in after[:2]] == [one.seconds for one in before]
    assert {path: path.stat().st_mtime_ns for path in kept} == kept


def test_a_place_that_takes_no_file_is_found_at_once(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(DataError, match="Not a directory"):
        KeptRuns(tmp_path / "file" / "runs")
