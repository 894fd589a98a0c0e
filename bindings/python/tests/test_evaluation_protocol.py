"""The protocol: first boxes, plan, runs; and the proof of it by figures that others measured."""

import os
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
import pytest

import small_sequence
from asttrack import Box
from asttrack.evaluation.evaluate import evaluate
from asttrack.evaluation.protocol import ONE_PASS, SPATIAL, Run, Start, Task, plan, run
from asttrack.evaluation.results import Evaluation
from asttrack.evaluation.sequence import Sequence, read_sequence
from asttrack.evaluation.summary import one_pass_rows
from asttrack.evaluation.trackers import parse_trackers
from header import REPOSITORY

# ---- First boxes ----


def test_the_annotated_box_is_rounded_to_whole_pixels() -> None:
    assert ONE_PASS.apply((148.5, 79.5, 24.4, 40.6)) == Box(148, 80, 24, 41)


def test_spatial_starts_are_eight_shifts_and_four_scales() -> None:
    boxes = [start.apply((100, 50, 40, 20)) for start in SPATIAL]
    assert boxes[:8] == [
        Box(100 + dx, 50 + dy, 40, 20) for dx, dy in ((-4, 0), (4, 0), (0, -2), (0, 2), (-4, -2), (4, -2), (-4, 2), (4, 2))
    ]
    assert boxes[8:] == [Box(104, 52, 32, 16), Box(102, 51, 36, 18), Box(98, 49, 44, 22), Box(96, 48, 48, 24)]
    assert len({start.name for start in SPATIAL} | {ONE_PASS.name}) == 13


def test_a_scaled_box_keeps_at_least_a_pixel() -> None:
    assert Start("tiny", scale=0.1).apply((10, 10, 3, 3))[2:] == (1, 1)


# ---- Plan and runs ----


@pytest.fixture(scope="module")
def sequence(tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    return small_sequence.write(tmp_path_factory.mktemp("protocol") / "scene")


def test_random_trackers_run_with_each_seed_the_others_once(sequence: Sequence) -> None:
    trackers = parse_trackers("asttrack,csrt,asttrack:tiny", "paper")
    tasks = plan([sequence], trackers, seeds=3, spatial=True)
    counts = {
        tracker.label: (
            [t.seed for t in tasks if t.tracker is tracker and t.start is ONE_PASS],
            [t.start for t in tasks if t.tracker is tracker and t.start is not ONE_PASS],
        )
        for tracker in trackers
    }
    assert counts == {
        "asttrack": ([1, 2, 3], list(SPATIAL)),
        "csrt": ([1], list(SPATIAL)),
        "asttrack:tiny": ([1, 2, 3], list(SPATIAL)),
    }
    assert [(t.tracker.label, t.seed, t.start) for t in tasks if t.look_inside] == [("asttrack", 1, ONE_PASS)]


def test_a_run_holds_a_box_a_frame_and_pictures_of_the_bag(sequence: Sequence) -> None:
    (tracker,) = parse_trackers("asttrack:tiny:guard=0,bag_interval=3,bag_size=4", "tiny")  # no frame refused: a model every third
    done = run(Task(sequence, tracker, 1, look_inside=True))
    assert done.error is None
    assert done.boxes.shape == (24, 4)
    assert done.ok.shape == done.score.shape == (24,)
    assert done.boxes[0].tolist() == list(ONE_PASS.apply(sequence.truth[0]))
    assert np.isnan(done.score[0])
    assert ((done.score[1:] >= 0) & (done.score[1:] <= 1)).all()
    assert done.seconds > 0
    assert done.updates == 23
    assert len(done.bag) == 4
    frames = [model.frame for model in done.bag]
    assert frames == sorted(frames)
    assert set(np.diff(frames)) == {3}
    for model in done.bag:
        assert model.crop.dtype == np.uint8
        assert model.mean is not None
        assert model.basis is not None
        assert model.mean.max() == 255
        assert max(abs(int(model.basis.max()) - 128), abs(int(model.basis.min()) - 128)) >= 127


def test_a_picture_that_cannot_be_read_ends_the_run_in_a_line(sequence: Sequence, tmp_path: Path) -> None:
    broken = tmp_path / "00005.pgm"
    broken.write_bytes(b"P5\n")
    frames = (*sequence.frames[:4], broken, *sequence.frames[5:])
    done = run(Task(replace(sequence, frames=frames), parse_trackers("asttrack", "tiny")[0], 1))
    assert done.error == f"{broken}: not a picture that OpenCV reads, or damaged"
    assert done.boxes.shape == (0, 4)


def test_an_interrupt_keeps_what_is_finished(sequence: Sequence) -> None:
    def interrupted_after_two(items: object, total: int) -> object:
        assert total == 5
        for count, item in enumerate(items, 1):  # type: ignore[arg-type, var-annotated]
            yield item
            if count == 2:
                raise KeyboardInterrupt

    trackers = parse_trackers("asttrack", "tiny")
    evaluation, interrupted = evaluate(
        [sequence],
        trackers,
        seeds=5,
        jobs=1,
        spatial=False,
        progress=interrupted_after_two,  # type: ignore[arg-type]
    )
    assert interrupted
    assert [measured.run.seed for measured in evaluation.runs] == [1, 2]
    assert evaluation.notes == ["incomplete: 3 of 5 runs are missing"]


def test_the_number_of_jobs_changes_nothing(sequence: Sequence) -> None:
    def boxes(jobs: int) -> list[Run]:
        evaluation, _ = evaluate(
            [sequence],
            parse_trackers("asttrack,medianflow", "tiny"),
            seeds=2,
            jobs=jobs,
            spatial=False,
            progress=small_sequence.unseen,
        )
        return [measured.run for measured in evaluation.runs]

    for one, two in zip(boxes(1), boxes(3), strict=True):
        assert (one.tracker, one.seed) == (two.tracker, two.seed)
        assert np.array_equal(one.boxes, two.boxes)


def test_a_crash_of_one_tracker_is_a_failure_and_no_more(sequence: Sequence) -> None:
    trackers = parse_trackers("asttrack,medianflow", "tiny")
    # A first box outside the frames: OpenCV's trackers raise, or say no; ours says which box.
    outside = replace(sequence, truth=sequence.truth + np.array([1000, 1000, 0, 0]))
    evaluation, interrupted = evaluate(
        [sequence, outside], trackers, seeds=1, jobs=2, spatial=False, progress=small_sequence.unseen
    )
    assert not interrupted
    assert any("asttrack, one pass, seed 1: frame 1: " in failure for failure in evaluation.failures)
    assert {measured.run.tracker for measured in evaluation.runs} == {"asttrack", "medianflow"}


# ---- Figures that others measured ----

SEQUENCES: Final = Path(os.environ.get("AST_SEQUENCES", REPOSITORY.parent / "shared" / "sequences"))
TOLERANCE: Final = 0.02
# From the README.md of the sequences: opencv-contrib-python 4.13.0.92; centre error in pixels, precision at 20 pixels.
PUBLISHED: Final = {
    "csrt": {"coke_can": (8.8, 0.94), "pedestrian1": (69.8, 0.12)},
    "kcf": {
        "surfer": (59.6, 0.04),
        "coke_can": (25.2, 0.34),
        "tiger1": (29.0, 0.37),
        "tiger2": (77.8, 0.04),
        "coupon_book": (15.4, 0.71),
    },
    "medianflow": {
        "surfer": (2.4, 1.00),
        "coke_can": (26.2, 0.41),
        "girl": (91.9, 0.23),
        "tiger1": (47.0, 0.24),
        "tiger2": (21.1, 0.60),
        "coupon_book": (4.5, 1.00),
        "occluded_face": (9.1, 0.99),
        "occluded_face2": (5.5, 1.00),
    },
}
PUBLISHED_MEAN: Final = (26.0, 0.68, 0.50)  # of medianflow on its eight, with the success


def near(measured: float, published: float, digits: int) -> bool:
    """Within the tolerance of a figure that was rounded to so many digits."""
    return abs(measured - published) <= TOLERANCE * published + 0.5 * 0.1**digits


@pytest.fixture(scope="module")
def published() -> Evaluation:
    names = sorted({name for figures in PUBLISHED.values() for name in figures})
    missing = [name for name in names if not (SEQUENCES / name).is_dir()]
    if missing:
        pytest.skip(f"no sequences {', '.join(missing)} in {SEQUENCES} (AST_SEQUENCES names another place)")
    sequences = {name: read_sequence(SEQUENCES / name) for name in names}
    whole = Evaluation(list(sequences.values()), parse_trackers(",".join(PUBLISHED), "robust"), None)  # type: ignore[arg-type]
    for label, figures in PUBLISHED.items():
        part, _ = evaluate(
            [sequences[name] for name in figures],
            parse_trackers(label, "robust"),
            seeds=1,
            jobs=2,
            spatial=False,
            progress=small_sequence.unseen,
        )
        assert not part.failures
        whole.runs += part.runs
    return whole


@pytest.mark.slow
@pytest.mark.parametrize(("label", "name"), [(label, name) for label, figures in PUBLISHED.items() for name in figures])
def test_opencv_trackers_give_the_published_figures(published: Evaluation, label: str, name: str) -> None:
    measured = published.first(label, name)
    assert measured is not None
    error, precision = PUBLISHED[label][name]
    figures = measured.accuracy
    assert near(figures.centre_error, error, 1), figures
    assert near(figures.precision, precision, 2), figures


@pytest.mark.slow
def test_the_mean_over_sequences_is_the_published_one(published: Evaluation) -> None:
    (row,) = [row for row in one_pass_rows(published) if row.tracker == "medianflow" and row.sequence is None]
    assert row.sequences == 8
    for key, figure, digits in zip(("centre_error", "precision", "success"), PUBLISHED_MEAN, (1, 2, 2), strict=True):
        assert near(row.figures[key].middle, figure, digits), (key, row.figures[key])
