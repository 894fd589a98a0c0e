"""How well a track fits the ground truth: the figures of the tracking literature.

Boxes are (frames, 4) arrays of x, y, w, h; frames without ground truth are rows of nan and are not counted.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

RADIUS = 20.0
"""Pixels within which a frame counts as precise, inclusive."""
RADII = np.arange(0.0, 51.0)
"""Thresholds of the precision curve, pixels."""
OVERLAPS = np.linspace(0.0, 1.0, 101)
"""Thresholds of the success curve."""

Floats = NDArray[np.float64]


def centre_errors(boxes: Floats, truth: Floats) -> Floats:
    """Distance of the boxes' centres in each frame, pixels; nan where there is no ground truth."""
    apart = (boxes[:, :2] + boxes[:, 2:] / 2) - (truth[:, :2] + truth[:, 2:] / 2)
    distances: Floats = np.hypot(apart[:, 0], apart[:, 1])
    return distances


def overlaps(boxes: Floats, truth: Floats) -> Floats:
    """Intersection over union in each frame; nan where there is no ground truth."""
    start = np.maximum(boxes[:, :2], truth[:, :2])
    end = np.minimum(boxes[:, :2] + boxes[:, 2:], truth[:, :2] + truth[:, 2:])
    both: Floats = np.prod(np.maximum(end - start, 0), axis=1)
    either = np.prod(boxes[:, 2:], axis=1) + np.prod(truth[:, 2:], axis=1) - both
    shares: Floats = both / either
    return shares


def precision_curve(errors: Floats) -> Floats:
    """Share of the annotated frames with a centre error of at most each of RADII."""
    known = errors[~np.isnan(errors)]
    return _shares(known[None, :] <= RADII[:, None])


def success_curve(shares: Floats) -> Floats:
    """Share of the annotated frames with an overlap above each of OVERLAPS."""
    known = shares[~np.isnan(shares)]
    return _shares(known[None, :] > OVERLAPS[:, None])


def _shares(hits: NDArray[np.bool_]) -> Floats:
    if hits.shape[1] == 0:
        return np.full(hits.shape[0], np.nan)
    counted: Floats = hits.mean(axis=1)
    return counted


@dataclass(frozen=True)
class Accuracy:
    """The figures of one track. The first frame, whose box is given, is not counted; nan where no other frame has ground truth.

    Attributes:
        centre_error: mean distance of the centres, pixels.
        precision: share of frames with a centre error of at most RADIUS.
        success: area under the success curve over all thresholds, which is the mean overlap.
        compared: frames with ground truth.
        lost: frames on which the tracker itself said that it had lost the object, with ground truth or not.
    """

    centre_error: float
    precision: float
    success: float
    compared: int
    lost: int


def accuracy(boxes: Floats, truth: Floats, ok: NDArray[np.bool_]) -> Accuracy:
    """The figures of a track of boxes; `ok` is false on frames that the tracker called lost."""
    errors = centre_errors(boxes, truth)[1:]
    shares = overlaps(boxes, truth)[1:]
    known = ~np.isnan(errors)
    lost = int(np.count_nonzero(~ok[1:]))
    if not known.any():
        return Accuracy(np.nan, np.nan, np.nan, 0, lost)
    errors, shares = errors[known], shares[known]
    return Accuracy(
        centre_error=float(errors.mean()),
        precision=float((errors <= RADIUS).mean()),
        success=float(shares.mean()),
        compared=int(known.sum()),
        lost=lost,
    )
