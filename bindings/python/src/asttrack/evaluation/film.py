"""Film strips: some frames of a sequence with the boxes of all trackers."""

import base64
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from asttrack.evaluation.results import Evaluation
from asttrack.evaluation.sequence import Sequence, read_grey
from asttrack.failures import DataError

EVENLY = 7  # frames of a strip, spread over the sequence; the first tracker's worst comes on top
WIDTH = 300  # pixels of a picture, at most
QUALITY = 78  # of its JPEG


@dataclass(frozen=True, eq=False)
class Still:
    """One frame of a strip.

    Attributes:
        number: from 1.
        caption: why it is shown, where that is not for being evenly spaced.
        picture: as a data URI.
        size: width and height of the frame, pixels: the boxes are in those.
        boxes: of the trackers by place in their list, and the truth as None; x, y, w, h.
    """

    number: int
    caption: str
    picture: str
    size: tuple[int, int]
    boxes: list[tuple[int | None, tuple[float, ...]]]


def strip(evaluation: Evaluation, sequence: Sequence) -> list[Still]:
    """The stills of a sequence with the boxes of each tracker's first run. Frames that cannot be read any more are left out."""
    runs = [(rank, m) for rank, label in enumerate(evaluation.labels) if (m := evaluation.first(label, sequence.name)) is not None]
    annotated = np.flatnonzero(~np.isnan(sequence.truth[:, 0]))
    chosen = dict.fromkeys((int(annotated[round(place)]) for place in np.linspace(0, len(annotated) - 1, EVENLY)), "")
    if runs and runs[0][0] == 0:
        errors = runs[0][1].errors
        chosen[int(np.nanargmax(errors))] = f"{evaluation.labels[0]} at its worst: {float(np.nanmax(errors)):.0f} px"
    stills = []
    for index in sorted(chosen):
        try:
            frame = read_grey(sequence.frames[index])
        except DataError:
            continue
        boxes: list[tuple[int | None, tuple[float, ...]]] = []
        if not np.isnan(sequence.truth[index, 0]):
            boxes.append((None, tuple(sequence.truth[index])))
        boxes += [(rank, tuple(m.run.boxes[index])) for rank, m in runs]
        stills.append(Still(index + 1, chosen[index], jpeg_uri(shrink(frame)), (frame.shape[1], frame.shape[0]), boxes))
    return stills


def shrink(frame: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The frame, at most WIDTH wide."""
    height, width = frame.shape[:2]
    if width <= WIDTH:
        return frame
    size = (WIDTH, max(1, round(height * WIDTH / width)))
    return np.asarray(cv2.resize(frame, size, interpolation=cv2.INTER_AREA), np.uint8)


def jpeg_uri(image: NDArray[np.uint8]) -> str:
    """A picture as a JPEG data URI."""
    return _uri("image/jpeg", cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])[1])


def png_uri(image: NDArray[np.uint8]) -> str:
    """A picture as a PNG data URI: not a pixel is changed."""
    return _uri("image/png", cv2.imencode(".png", image)[1])


def _uri(kind: str, data: NDArray[np.uint8]) -> str:
    return f"data:{kind};base64,{base64.b64encode(data.tobytes()).decode()}"
