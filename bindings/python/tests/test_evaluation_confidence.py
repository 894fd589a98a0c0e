"""Confidence as a classifier: against direct definitions, on runs made by hand, and from files to tables."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from asttrack.evaluation.conditions import conditions
from asttrack.evaluation.confidence import BINS, confidence, judge, pool, reliability, roc_auc
from asttrack.evaluation.metrics import Floats
from asttrack.evaluation.protocol import ONE_PASS, Run
from asttrack.evaluation.results import Evaluation, Measured, measure
from asttrack.evaluation.sequence import Sequence, read_sequence
from asttrack.evaluation.summary import confidence_rows
from asttrack.evaluation.tables import align, confidence_table
from asttrack.evaluation.trackers import parse_trackers
from asttrack.failures import DataError

NOWHERE = np.full(4, np.nan)
HERE = np.array([100.0, 100, 20, 20])


def sequence(truth: Floats, labels: Floats | None = None, name: str = "s") -> Sequence:
    paths = tuple(Path(f"{name}/{number}") for number in range(len(truth)))
    return Sequence(name, Path(name), paths, truth, labels=None if labels is None else labels.astype(bool))


def measured(frames: str, *, score: Floats | None = None, lost: str = "", labels: str = "", name: str = "s") -> Measured:
    """A run by a letter a frame: r right, w wrong, a absent, . not annotated; `lost` has an L where it said so."""
    truth = np.array([HERE if letter in "rw" else NOWHERE for letter in frames])
    boxes = np.array([HERE + (50 if letter == "w" else 0) * np.array([1, 0, 0, 0]) for letter in frames])
    ok = np.array([letter != "L" for letter in lost.ljust(len(frames))])
    found = sequence(truth, np.array([letter == "a" for letter in labels or frames]) * 1.0, name)
    scores = np.full(len(frames), np.nan) if score is None else score
    return measure(Run(name, "asttrack", 1, ONE_PASS.name, boxes, ok, scores, seconds=1.0), found)


# ---- The area under the ROC curve ----


@pytest.mark.parametrize("levels", [3, 10, 1000])
def test_auc_is_the_probability_that_a_right_frame_scores_higher(levels: int) -> None:
    random = np.random.default_rng(levels)
    wrong = random.random(150) < 0.3
    score = np.round((random.random(150) + 0.4 * ~wrong) * levels) / levels
    right_scores, wrong_scores = score[~wrong][:, None], score[wrong][None, :]
    direct = np.mean((right_scores > wrong_scores) + 0.5 * (right_scores == wrong_scores))
    assert roc_auc(score, wrong) == pytest.approx(direct, abs=1e-12)


def test_auc_of_the_extremes() -> None:
    wrong = np.array([True, True, False, False])
    assert roc_auc(np.array([0.1, 0.2, 0.3, 0.4]), wrong) == 1
    assert roc_auc(np.array([0.4, 0.3, 0.2, 0.1]), wrong) == 0
    assert roc_auc(np.full(4, 0.7), wrong) == 0.5
    assert np.isnan(roc_auc(np.arange(4.0), np.zeros(4, bool)))
    assert np.isnan(roc_auc(np.arange(4.0), np.ones(4, bool)))
    assert np.isnan(roc_auc(np.array([0.1, np.nan, 0.2, 0.3]), wrong))


def test_auc_of_a_flag_is_the_mean_of_its_two_rates() -> None:
    wrong = np.array([True] * 4 + [False] * 10)
    flag = np.array([0, 0, 0, 1] + [1] * 8 + [0] * 2, float)
    assert roc_auc(flag, wrong) == pytest.approx((3 / 4 + 8 / 10) / 2)


# ---- Reliability ----


def test_reliability_counts_bin_by_bin() -> None:
    random = np.random.default_rng(5)
    score = np.append(random.random(400), [0.0, 1.0])
    wrong = random.random(402) > score
    found = reliability(score, wrong)
    for place in range(len(BINS) - 1):
        top = np.inf if place == len(BINS) - 2 else BINS[place + 1]
        inside = (score >= BINS[place]) & (score < top)
        assert found.frames[place] == inside.sum()
        assert found.score[place] == pytest.approx(score[inside].mean())
        assert found.right[place] == pytest.approx((~wrong[inside]).mean())
    assert found.frames.sum() == 402
    direct = sum(n / 402 * abs(s - r) for n, s, r in zip(found.frames, found.score, found.right, strict=True))
    assert found.error == pytest.approx(direct)


def test_a_score_that_is_what_it_says_has_no_error_and_no_score_has_none() -> None:
    score = np.repeat([0.25, 0.75], 100)
    wrong = np.concatenate([np.arange(100) >= 25, np.arange(100) >= 75])
    assert reliability(score, wrong).error == pytest.approx(0)
    assert reliability(1 - score, wrong).error == pytest.approx(0.5)
    nothing = reliability(np.full(5, np.nan), np.zeros(5, bool))
    assert nothing.frames.sum() == 0
    assert np.isnan(nothing.error)


# ---- Runs ----


def test_what_is_wrong_known_and_visible() -> None:
    judged = judge(measured("rrw.a.r", lost="L   L L"))
    # The first frame, whose box is given, and those of which nothing is known do not count.
    assert judged.wrong.tolist() == [False, True, True, False]
    assert judged.visible.tolist() == [True, True, False, True]
    assert judged.lost.tolist() == [False, False, True, True]


def test_an_overlap_below_a_fifth_is_wrong() -> None:
    truth = np.tile(HERE, (4, 1))
    # Boxes of one size that share a part p of their width overlap by p / (2 - p).
    parts = np.array([1, 1 / 3 - 1e-6, 1 / 3 + 1e-6, 0])
    boxes = truth + np.outer(20 * (1 - parts), [1, 0, 0, 0])
    run = Run("s", "asttrack", 1, ONE_PASS.name, boxes, np.ones(4, bool), np.ones(4), 1.0)
    assert judge(measure(run, sequence(truth))).wrong.tolist() == [True, False, True]


def test_a_hidden_object_is_absent_although_the_truth_goes_on() -> None:
    judged = judge(measured("rrrr", labels="rraa"))
    assert judged.wrong.tolist() == [False, True, True]
    assert judged.visible.tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("frames", "lost", "delays"),
    [
        ("rrwwwrr", "       ", [np.nan]),
        ("rrwwwrr", "    L  ", [2]),
        ("rrwwwrr", " LLLL  ", [0]),
        ("rrwwwrr", "     L ", [np.nan]),  # right again when it says so
        ("rrwrwww", "      L", [np.nan, 2]),
        ("rr.w..w..r", "     L   ", [2]),  # between annotated frames it may say so, too
        ("rr.w..r", "    L ", [1]),
        ("rraaa", "   L", [1]),
        ("rww", "  L", [1]),
    ],
)
def test_delay_from_going_wrong_to_saying_so(frames: str, lost: str, delays: list[float]) -> None:
    assert np.array_equal(judge(measured(frames, lost=lost)).delays, delays, equal_nan=True)


def test_figures_of_a_run() -> None:
    #                     r   right and lost  wrong          absent     right
    frames, lost = "r" + "rr" + "wwww" + "aa" + "r", " " + " L" + "  LL" + "LL" + " "
    score = np.array([np.nan, 0.9, 0.4, 0.5, 0.3, 0.2, 0.1, 0.1, 0.2, 0.8])
    figures = confidence(judge(measured(frames, lost=lost, score=score)))
    assert figures["score_auc"] == pytest.approx(17 / 18)
    assert figures["flag_auc"] == pytest.approx((4 / 6 + 2 / 3) / 2)
    assert figures["wrong"] == pytest.approx(100 * 6 / 9)
    assert figures["lost_visible"] == pytest.approx(100 * 3 / 7)
    assert figures["false_lost"] == pytest.approx(100 * 1 / 7)
    assert (figures["losses"], figures["noticed"], figures["delay"]) == (1, 1, 2)


def test_pooled_frames_are_those_of_one_run() -> None:
    one = judge(measured("rrww", score=np.array([np.nan, 0.9, 0.3, 0.2])))
    other = judge(measured("rrw", score=np.array([np.nan, 0.25, 0.1])))
    both = pool([one, other])
    # Each run alone is told apart; together the other's right frame ranks below one of the first's wrong ones.
    assert confidence(one)["score_auc"] == confidence(other)["score_auc"] == 1
    assert confidence(both)["score_auc"] == pytest.approx(5 / 6)
    assert confidence(both)["losses"] == 2


def test_a_run_that_is_never_wrong_has_no_auc() -> None:
    figures = confidence(judge(measured("rrr", lost="  L", score=np.array([np.nan, 0.5, 0.6]))))
    assert np.isnan(figures["score_auc"])
    assert np.isnan(figures["delay"])
    assert figures["lost_visible"] == 50


# ---- Absence, on disk and by rule ----


def test_missing_boxes_mean_absence_where_neighbours_are_annotated() -> None:
    dense, sparse = np.tile(HERE, (9, 1)), np.tile(HERE, (9, 1))
    dense[3:5] = np.nan
    sparse[np.arange(9) % 4 != 0] = np.nan
    assert np.flatnonzero(sequence(dense).absent).tolist() == [3, 4]
    assert not sequence(sparse).absent.any()
    labels = np.zeros(9)
    labels[6] = 1
    assert np.flatnonzero(sequence(sparse, labels).absent).tolist() == [6]


def written(directory: Path, label: str | None) -> Path:
    (directory / "img").mkdir()
    for number in range(1, 4):
        (directory / "img" / f"{number}.pgm").write_bytes(b"P5\n2 2\n255\n1234")
    (directory / "groundtruth.txt").write_text("0,0,2,2\n" * 3)
    if label is not None:
        (directory / "absence.label").write_text(label)
    return directory


def test_labels_of_absence_are_read(tmp_path: Path) -> None:
    assert read_sequence(written(tmp_path, "0\n0\n1\n")).absent.tolist() == [False, False, True]


def test_without_labels_the_boxes_decide(tmp_path: Path) -> None:
    assert not read_sequence(written(tmp_path, None)).absent.any()


@pytest.mark.parametrize("label", ["0\n1\n", "0\n2\n0\n", "", "0\nno\n1\n"])
def test_labels_that_are_none_are_refused(tmp_path: Path, label: str) -> None:
    with pytest.raises(DataError, match=r"absence\.label: not a line 0 or 1 for each of 3 frames"):
        read_sequence(written(tmp_path, label))


# ---- Tables ----


def test_rows_have_the_median_over_seeds_and_the_frames_of_all_together() -> None:
    runs = [
        measured("rrww", score=np.array([np.nan, 0.9, 0.3, 0.2]), name="s"),
        measured("rrww", score=np.array([np.nan, 0.1, 0.3, 0.2]), name="s"),
        measured("rrw", score=np.array([np.nan, 0.25, 0.1]), name="t"),
        measured("rrr", score=np.array([np.nan, 0.25, 0.1]), name="t"),
    ]
    sequences = [sequence(np.tile(HERE, (4, 1)), name="s"), sequence(np.tile(HERE, (3, 1)), name="t")]
    evaluation = Evaluation(sequences, parse_trackers("asttrack", "tiny"), conditions(1), planned=4)
    for seed, one in zip((1, 2, 1, 2), runs, strict=True):
        evaluation.runs.append(replace(one, run=replace(one.run, seed=seed)))
    first, second, together = confidence_rows(evaluation)
    auc = first.figures["score_auc"]
    assert (auc.middle, auc.low, auc.high) == (0.5, 0, 1)
    assert (second.figures["score_auc"].low, second.figures["score_auc"].high) == (1, 1)
    assert (together.sequence, together.sequences, together.repeats) == (None, 2, 2)
    assert together.figures["score_auc"].high == pytest.approx(5 / 6)
    lines = align(confidence_table([first, second, together])).splitlines()
    assert [line.split("  ")[0] for line in lines if line] == ["sequence", "s", "t", "all 2"]
