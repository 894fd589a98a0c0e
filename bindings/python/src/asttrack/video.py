"""Moving pictures in and out: a file that OpenCV reads, a directory of numbered pictures, a camera; an annotated video."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np

from asttrack.evaluation.sequence import TRUTH_NAMES, numbered_pictures, read_truth
from asttrack.failures import DataError, SourceError, UsageError, unusable
from asttrack.frames import Frame
from asttrack.output import replacing
from asttrack.result import Box

CODECS = {".mp4": "mp4v", ".avi": "MJPG", ".mkv": "mp4v"}
"""Kinds of video that are written, by the end of the name; each with a codec that OpenCV's wheels bring."""
_COMPLETE = 0.95  # share of the frames that a file promises, below which it counts as cut short: the promise is an estimate
_DEFAULT_RATE = 25.0  # frames a second, where the source does not say


class Source:
    """Frames in colour (BGR), oldest first.

    Attributes:
        name: to be shown.
        count: how many frames, where that is known.
        rate: frames a second at which they were taken, or an assumption.
        first_box: the first box of a directory's ground truth, where it has one.
    """

    def __init__(self, name: str, count: int | None, rate: float, first_box: Box | None = None) -> None:
        self.name = name
        self.count = count
        self.rate = rate
        self.first_box = first_box

    def frames(self) -> Iterator[Frame]:
        """The frames, once. Raises DataError when the first one cannot be read, SourceError for a later one."""
        raise NotImplementedError


class _Directory(Source):
    def __init__(self, path: Path) -> None:
        self._paths = numbered_pictures(path)
        if not self._paths:
            raise DataError(f"{path}: no numbered pictures in it or in its img/")
        truth = next((path / name for name in TRUTH_NAMES if (path / name).is_file()), None)
        sides = read_truth(truth)[0] if truth is not None else None
        box = Box(*map(float, sides)) if sides is not None and not np.isnan(sides[0]) else None
        super().__init__(path.resolve().name, len(self._paths), _DEFAULT_RATE, box)

    def frames(self) -> Iterator[Frame]:
        for path in self._paths:
            picture = cv2.imread(str(path), cv2.IMREAD_COLOR)
            if picture is None:
                kind = DataError if path == self._paths[0] else SourceError
                raise kind(f"{path}: not a picture that OpenCV reads, or damaged")
            yield np.asarray(picture, np.uint8)


class _Capture(Source):
    def __init__(self, name: str, capture: cv2.VideoCapture, what: str) -> None:
        self._capture = capture
        self._what = what
        if not capture.isOpened():
            raise DataError(f"{name}: {what}")
        count = int(capture.get(cv2.CAP_PROP_FRAME_COUNT))
        rate = capture.get(cv2.CAP_PROP_FPS)
        super().__init__(name, count if count > 0 else None, rate if 0 < rate <= 1000 else _DEFAULT_RATE)

    def frames(self) -> Iterator[Frame]:
        try:
            good, picture = self._capture.read()
            if not good:
                raise DataError(f"{self.name}: no frame can be read from it")
            number = 0
            while good:
                number += 1
                yield np.asarray(picture, np.uint8)
                good, picture = self._capture.read()
            if self.count is not None and number < self.count * _COMPLETE:
                raise SourceError(f"{self.name}: ends after {number} of {self.count} frames")
        finally:
            self._capture.release()


def open_source(text: str) -> Source:
    """Opens what a user named: the number of a camera, a device, a directory, or a video file. Raises DataError."""
    if re.fullmatch(r"\d{1,3}", text) and not Path(text).exists():
        return _Capture(f"camera {text}", cv2.VideoCapture(int(text)), "there is no such camera, or it is in use")
    path = Path(text)
    if path.is_dir():
        return _Directory(path)
    try:
        device = path.is_char_device()
        if not device:
            path.open("rb").close()
    except OSError as error:
        raise unusable(path, error) from error
    return _Capture(path.name, cv2.VideoCapture(str(path)), "not a video that OpenCV reads, or damaged")


def require_codec(target: Path) -> None:
    """Raises UsageError for a name that no kind of video ends in."""
    if target.suffix.lower() not in CODECS:
        raise UsageError(f"{target}: the name of a video must end in {' or '.join(CODECS)}")


class VideoSink:
    """Takes the frames of a video being written; all become as large as the first."""

    def __init__(self, path: Path, codec: str, rate: float) -> None:
        self._path = path
        self._codec = codec
        self._rate = rate
        self._writer: cv2.VideoWriter | None = None
        self._size = (0, 0)
        self.written = 0

    def write(self, frame: Frame) -> None:
        """Appends a frame, BGR. Raises DataError when no video can be made of it."""
        if self._writer is None:
            self._size = (frame.shape[1], frame.shape[0])
            self._writer = cv2.VideoWriter(str(self._path), cv2.VideoWriter.fourcc(*self._codec), self._rate, self._size)
            if not self._writer.isOpened():
                raise DataError(f"OpenCV cannot write frames of {self._size[0]} x {self._size[1]} as {self._codec}")
        if (frame.shape[1], frame.shape[0]) != self._size:
            frame = np.asarray(cv2.resize(frame, self._size), np.uint8)
        self._writer.write(frame)
        self.written += 1

    def close(self) -> None:
        """Ends the file."""
        if self._writer is not None:
            self._writer.release()


@contextmanager
def writing_video(target: Path, rate: float) -> Iterator[VideoSink]:
    """A video under a temporary name that becomes `target` when all its frames are there. Raises DataError.

    OpenCV's writer does not say when the disk is full, so the last frame is read back from the finished file.
    """
    with replacing(target) as path:
        sink = VideoSink(path, CODECS[target.suffix.lower()], rate)
        try:
            yield sink
        except DataError as error:
            raise DataError(f"{target}: {error}") if sink.written == 0 else error from error
        finally:
            sink.close()
        if sink.written and not _has_frame(path, sink.written - 1):
            raise DataError(f"{target}: could not be written whole: is the disk full?")


def _has_frame(path: Path, index: int) -> bool:
    """Whether a frame can be read: the header of a file that was cut short still promises it."""
    capture = cv2.VideoCapture(str(path))
    try:
        return capture.isOpened() and capture.set(cv2.CAP_PROP_POS_FRAMES, index) and capture.read()[0]
    finally:
        capture.release()
