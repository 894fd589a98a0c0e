"""What a tracker says of a frame."""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple


class Status(IntEnum):
    """How sure the tracker is."""

    TRACKING = 0
    UNCERTAIN = 1
    LOST = 2


class Box(NamedTuple):
    """Top-left corner and size in pixels, 0-based; pixel centres lie at integer coordinates."""

    x: float
    y: float
    w: float
    h: float


@dataclass(frozen=True, slots=True)
class Result:
    """One tracked frame.

    Attributes:
        box: the object's box, pixels. It may reach beyond the frame; its centre does not.
        scale: size relative to the first box.
        score: confidence, 0 (nothing like the object) .. 1 (as seen before).
        status: `Status.TRACKING`, `UNCERTAIN` or `LOST`.
        distance: the winning particle's least distance to a model of the bag (paper eq. 2).
        effective_particles: effective sample size 1 / sum of squared weights, 1 .. N.
        best: index of the winning particle.
        frame: frames seen since `init`; the first `update` is 1.
    """

    box: Box
    scale: float
    score: float
    status: Status
    distance: float
    effective_particles: float
    best: int
    frame: int
