"""The bag of models as pictures: what each model was made from, its mean, its first eigenbasis (the paper's figure on the bag)."""

from collections import deque
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from asttrack.frames import Frame
from asttrack.geometry import Subspace
from asttrack.result import Box
from asttrack.tracker import Tracker

CROP_HEIGHT = 64  # pixels of a picture of the object


@dataclass(frozen=True, eq=False)
class ModelPicture:
    """One model of the bag.

    Attributes:
        frame: number of the frame, from 1, after which it entered the bag.
        crop: the tracked box in that frame, grey.
        mean: the model's mean as grey pixels; None where its vectors hold none.
        basis: its first basis vector in the same way, zero in the middle of the grey scale.
    """

    frame: int
    crop: NDArray[np.uint8]
    mean: NDArray[np.uint8] | None
    basis: NDArray[np.uint8] | None


class BagRecorder:
    """Watches a tracker and keeps a picture of each model that enters its bag, as many as the bag holds."""

    def __init__(self, tracker: Tracker) -> None:
        settings = tracker.config
        self._tracker = tracker
        self._grey = float(settings["patch_weight"]) > 0
        self._kept: deque[ModelPicture] = deque(maxlen=int(settings["bag_size"]))
        self._known: set[bytes] = set()

    @property
    def pictures(self) -> tuple[ModelPicture, ...]:
        """The pictures, oldest first."""
        return tuple(self._kept)

    def look(self, number: int, frame: Frame, box: Box) -> None:
        """To be called after each update with the frame, its number and the tracked box."""
        models = {model.mean.tobytes(): model for model in self._tracker.bag}
        for identity, model in models.items():
            if identity not in self._known:
                self._kept.append(self._picture(number, frame, box, model))
        self._known = set(models)

    def _picture(self, number: int, frame: Frame, box: Box, model: Subspace) -> ModelPicture:
        if not self._grey:
            return ModelPicture(number, crop(frame, box), None, None)
        mean, basis = self._tracker.patch(model.mean), self._tracker.patch(model.basis[:, 0])
        # The sign of a singular vector is arbitrary: take the one that resembles the mean, so that neighbours look alike.
        turn = -1 if float((basis * (mean - mean.mean())).sum()) < 0 else 1
        span = float(np.abs(basis).max()) or 1.0
        return ModelPicture(number, crop(frame, box), _stretch(mean), _grey(0.5 + 0.5 * turn * basis / span))


def crop(frame: Frame, box: Box) -> NDArray[np.uint8]:
    """The pixels inside a box, grey, CROP_HEIGHT high; beyond the frame, its border."""
    width = min(4 * CROP_HEIGHT, max(1, round(CROP_HEIGHT * box.w / box.h)))
    across, down = box.w / width, box.h / CROP_HEIGHT
    # Patch pixel c lies at x + (c + 1/2) w / width - 1/2: pixel centres are at integers.
    place = np.array([[across, 0, box.x + across / 2 - 0.5], [0, down, box.y + down / 2 - 0.5]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return np.asarray(cv2.warpAffine(frame, place, (width, CROP_HEIGHT), flags=flags, borderMode=cv2.BORDER_REPLICATE), np.uint8)


def _stretch(image: NDArray[np.float32]) -> NDArray[np.uint8]:
    low, high = float(image.min()), float(image.max())
    return _grey((image - low) / ((high - low) or 1.0))


def _grey(image: NDArray[np.float32]) -> NDArray[np.uint8]:
    """From 0 .. 1."""
    return np.asarray(np.round(255 * image), np.uint8)
