"""Whether a tracker knows when it is wrong: its score and its flag as classifiers of frames.

A frame is wrong when its overlap with the truth is below WRONG, or when nothing of the object is in view. Frames of which nothing
is known, being neither annotated nor labelled, do not count, nor does the first, whose box is given.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asttrack.evaluation.metrics import Floats
from asttrack.evaluation.results import Measured

WRONG = 0.2
"""Overlap below which a frame is wrong."""
BINS = np.linspace(0.0, 1.0, 11)
"""Edges of the scores that the reliability curve takes together."""

Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Judged:
    """Frames of one run or of several, of which it is known whether they are wrong.

    Attributes:
        wrong: (frames,) whether the box is not on the object.
        visible: (frames,) whether something of the object is in view.
        lost: (frames,) whether the tracker said that it had lost the object.
        score: (frames,) the tracker's confidence; nan where it gives none.
        delays: for each time that the tracker went wrong, the frames until it said so; nan where it did not before it was right
            again.
    """

    wrong: Bools
    visible: Bools
    lost: Bools
    score: Floats
    delays: Floats


def judged_frames(shares: Floats, absent: Bools) -> tuple[Bools, Bools]:
    """Of which frames something is known, and which are wrong, from their overlaps (nan without ground truth)."""
    known = absent | ~np.isnan(shares)
    known[0] = False
    return known, absent | (np.nan_to_num(shares) < WRONG)


def judge(measured: Measured) -> Judged:
    """The frames of a run against its truth."""
    absent = measured.absent
    known, wrong = judged_frames(measured.shares, absent)
    lost = ~measured.run.ok
    return Judged(wrong[known], ~absent[known], lost[known], measured.run.score[known], _delays(wrong, known, lost))


def pool(parts: Iterable[Judged]) -> Judged:
    """The frames of several runs as those of one."""
    all_parts = list(parts)
    return Judged(
        *(np.concatenate([getattr(part, name) for part in all_parts]) for name in ("wrong", "visible", "lost", "score", "delays"))
    )


def _delays(wrong: Bools, known: Bools, lost: Bools) -> Floats:
    """From the first known wrong frame to the first one that the tracker called lost, before the next known right one."""
    frames = np.flatnonzero(known)
    turns = np.flatnonzero(wrong[frames] & ~np.concatenate([[False], wrong[frames][:-1]]))
    delays = []
    for turn in turns:
        start = frames[turn]
        right = frames[turn:][~wrong[frames[turn:]]]
        said = np.flatnonzero(lost[start : right[0] if len(right) else len(lost)])
        delays.append(float(said[0]) if len(said) else np.nan)
    return np.array(delays, float)


def roc_auc(score: Floats, wrong: Bools) -> float:
    """Area under the ROC curve: how probable it is that a right frame has a higher score than a wrong one; equal ones count half.

    nan where there are no right frames, no wrong ones, or a frame without a score.
    """
    right = int(np.count_nonzero(~wrong))
    pairs = right * (len(wrong) - right)
    if pairs == 0 or np.isnan(score).any():
        return float("nan")
    # The mean rank of those that share a score stands for each of them: Mann and Whitney's U.
    _, places, counts = np.unique(score, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts - 1) / 2)[places]
    return float((ranks[~wrong].sum() - right * (right + 1) / 2) / pairs)


@dataclass(frozen=True, eq=False)
class Reliability:
    """What scores are worth, bin by bin of BINS; a score on an edge is in the upper bin, 1 in the last.

    Attributes:
        frames: how many have such a score.
        score: their mean; nan of none.
        right: share of them that are right; nan of none.
    """

    frames: NDArray[np.int_]
    score: Floats
    right: Floats

    @property
    def error(self) -> float:
        """Expected calibration error: mean distance of score and share of right frames, weighted by the frames; nan of none."""
        some = self.frames > 0
        if not some.any():
            return float("nan")
        return float(np.average(np.abs(self.score - self.right)[some], weights=self.frames[some]))


def reliability(score: Floats, wrong: Bools) -> Reliability:
    """The reliability of the frames that have a score."""
    scored = ~np.isnan(score)
    score, right = score[scored], ~wrong[scored]
    places = np.clip(np.digitize(score, BINS) - 1, 0, len(BINS) - 2)
    frames = np.bincount(places, minlength=len(BINS) - 1)
    with np.errstate(invalid="ignore"):
        return Reliability(
            frames,
            np.bincount(places, weights=score, minlength=len(frames)) / frames,
            np.bincount(places, weights=right, minlength=len(frames)) / frames,
        )


def confidence(judged: Judged) -> dict[str, float]:
    """The figures by key, as CONFIDENCE of the tables; nan where there is nothing to measure."""
    visible = int(np.count_nonzero(judged.visible))
    lost = judged.lost & judged.visible
    noticed = judged.delays[~np.isnan(judged.delays)]
    return {
        "score_auc": roc_auc(judged.score, judged.wrong),
        "flag_auc": roc_auc((~judged.lost).astype(float), judged.wrong),
        "calibration": reliability(judged.score, judged.wrong).error,
        "wrong": _percent(int(np.count_nonzero(judged.wrong)), len(judged.wrong)),
        "lost_visible": _percent(int(np.count_nonzero(lost)), visible),
        "false_lost": _percent(int(np.count_nonzero(lost & ~judged.wrong)), visible),
        "losses": float(len(judged.delays)),
        "noticed": float(len(noticed)),
        "delay": float(np.median(noticed)) if len(noticed) else float("nan"),
    }


def _percent(count: int, of: int) -> float:
    return 100 * count / of if of else float("nan")
