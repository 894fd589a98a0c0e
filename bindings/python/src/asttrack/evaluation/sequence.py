"""Sequences on disk: a directory with numbered frames in `img/` and the object's box in each."""

import codecs
import math
import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from asttrack.failures import DataError, unusable
from asttrack.frames import Frame
from asttrack.natural_order import natural_key

TRUTH_NAMES = ("groundtruth.txt", "groundtruth_rect.txt")
ABSENCE_NAME = "absence.label"
PICTURES = (".jpg", ".jpeg", ".png", ".bmp", ".pgm", ".ppm", ".tif", ".tiff", ".webp")

# A line of ground truth, as the C command reads it (examples/truth.c), which gives the same reasons.
_MOST_BYTES = 511  # far longer than four numbers are
_LARGEST = float(np.finfo(np.float32).max)
_NUMBER = rb"([+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[nN][aA][nN])"
_BOX = re.compile(rb"[ \t]*" + rb"(?:[ \t]*,[ \t]*|[ \t]+)".join([_NUMBER] * 4) + rb"[ \t]*,?[ \t]*")


@dataclass(frozen=True)
class Sequence:
    """A sequence to evaluate on.

    Attributes:
        name: of its directory; unique among the sequences found together.
        directory: where it lies.
        frames: paths of the frames that have a line of ground truth.
        truth: (frames, 4) boxes x, y, w, h in pixels; a row of nan where there is none. The first row is a box.
        notes: what a reader of the figures should know, one line each.
        labels: (frames,) whether nothing of the object is in view, where a file says so; None without one.
    """

    name: str
    directory: Path
    frames: tuple[Path, ...]
    truth: NDArray[np.float64]
    notes: tuple[str, ...] = ()
    labels: NDArray[np.bool_] | None = None

    def __len__(self) -> int:
        return len(self.frames)

    @property
    def absent(self) -> NDArray[np.bool_]:
        """Frames in which there is nothing of the object: by the labels, or else by boxes that are missing.

        Where no two neighbouring frames have boxes, the annotator left frames out, and a missing box says nothing.
        """
        if self.labels is not None:
            return self.labels
        boxed = ~np.isnan(self.truth[:, 0])
        sparse = not (boxed[1:] & boxed[:-1]).any()
        return np.zeros(len(boxed), bool) if sparse else ~boxed

    def pictures(self) -> Iterator[Frame]:
        """The frames, grey, oldest first. Raises DataError at one that cannot be read."""
        return map(read_grey, self.frames)


def find_sequences(paths: Iterable[Path]) -> tuple[list[Sequence], list[str]]:
    """The sequences at `paths`, each a sequence or a directory of sequences, and one line for each that cannot be used."""
    found: list[Sequence] = []
    problems: list[str] = []
    for path in paths:
        for directory in sequence_directories(path):
            try:
                found.append(read_sequence(directory))
            except DataError as error:
                problems.append(str(error))
    names = distinct_names([sequence.directory for sequence in found])
    return [replace(sequence, name=name) for sequence, name in zip(found, names, strict=True)], problems


def distinct_names(directories: list[Path]) -> list[str]:
    """What to call the sequences in these directories: by the directory, by its whole path where others are called so, too."""
    names = [directory.resolve().name for directory in directories]
    return [str(directory) if names.count(name) > 1 else name for name, directory in zip(names, directories, strict=True)]


def read_sequence(directory: Path) -> Sequence:
    """Reads one sequence; its pictures stay on disk. Raises DataError."""
    truth_path = _truth_path(directory)
    if not directory.is_dir():
        raise DataError(f"{directory}: {'is not a directory' if directory.exists() else 'no such directory'}")
    if truth_path is None:
        raise DataError(f"{directory}: no {' or '.join(TRUTH_NAMES)}")
    truth = read_truth(truth_path)
    if np.isnan(truth[0, 0]):
        raise DataError(f"{truth_path}:1: no box to start from")
    frames = numbered_pictures(directory)
    if not frames:
        raise DataError(f"{directory}: no numbered pictures in it or in its img/")
    count = min(len(frames), len(truth))
    notes = []
    if len(frames) != len(truth):
        notes.append(f"{directory}: {len(frames)} frames but {len(truth)} lines of ground truth: evaluated on the first {count}")
    if count < 2:
        raise DataError(f"{directory}: fewer than two frames with ground truth")
    labels = _read_absence(directory / ABSENCE_NAME, count)
    return Sequence(directory.resolve().name, directory, tuple(frames[:count]), truth[:count], tuple(notes), labels)


def numbered_pictures(directory: Path) -> list[Path]:
    """Pictures whose names end in a number, in natural order: those of `img/` where it has any, else the directory's own.

    Raises DataError where the directory cannot be read, or holds the same frame twice (`7.pgm` and `07.jpg`).
    """
    for place in (directory / "img", directory):
        if not place.is_dir() and place != directory:
            continue
        try:
            keyed = [(natural_key(path.name), os.fsencode(path.name), path) for path in place.iterdir() if _is_numbered(path)]
        except OSError as error:
            raise unusable(place, error) from error
        keyed.sort()
        for (key, _, path), (next_key, _, next_path) in pairwise(keyed):
            if key == next_key:
                raise DataError(f"{place}: {path.name} and {next_path.name} have the same number")
        if keyed:
            return [path for _, _, path in keyed]
    return []


def read_truth(path: Path) -> NDArray[np.float64]:
    """Reads boxes, one line a frame, numbers parted by a comma, by tabs and spaces, or by both.

    `nan` or zero four times stand for no box.

    Raises DataError, with the file, the line and the reason that the C command gives.
    """
    try:
        lines = path.read_bytes().split(b"\n")
    except OSError as error:
        raise unusable(path, error) from error
    boxes: list[list[float]] = []
    for number, line in enumerate(lines, 1):
        text = line.removesuffix(b"\r").removeprefix(codecs.BOM_UTF8 if number == 1 else b"")
        if len(line) <= _MOST_BYTES and not text.strip(b" \t"):
            continue  # fine at the end of the file
        if len(boxes) < number - 1:
            raise DataError(f"{path}:{len(boxes) + 1}: an empty line before the end")
        if len(line) > _MOST_BYTES:
            raise DataError(f"{path}:{number}: too long for four numbers x,y,w,h")
        boxes.append(_parse_box(text, f"{path}:{number}"))
    if not boxes:
        raise DataError(f"{path}: the file is empty")
    return np.array(boxes)


def _read_absence(path: Path, count: int) -> NDArray[np.bool_] | None:
    """GOT-10k's labels: a line a frame, 1 where the object is absent, else 0. None where there is no such file."""
    try:
        words = path.read_text(encoding="ascii", errors="replace").split()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise unusable(path, error) from error
    if len(words) < count or not set(words) <= {"0", "1"}:
        raise DataError(f"{path}: not a line 0 or 1 for each of {count} frames")
    return np.array([word == "1" for word in words[:count]])


def read_grey(path: Path) -> Frame:
    """Reads a picture as grey. Raises DataError."""
    picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if picture is None:
        try:
            path.open("rb").close()
        except OSError as error:
            raise unusable(path, error) from error
        raise DataError(f"{path}: not a picture that OpenCV reads, or damaged")
    return np.asarray(picture, np.uint8)


def sequence_directories(path: Path) -> list[Path]:
    """`path` itself, or the sequences in it when it is a directory of them."""
    if _truth_path(path) is not None or not path.is_dir():
        return [path]
    try:
        inside = sorted(child for child in path.iterdir() if child.is_dir() and _truth_path(child) is not None)
    except OSError:
        inside = []
    return inside or [path]


def _truth_path(directory: Path) -> Path | None:
    return next((directory / name for name in TRUTH_NAMES if (directory / name).is_file()), None)


def _is_numbered(path: Path) -> bool:
    """Whether this is the name of a picture with a digit before the extension."""
    return path.suffix.lower() in PICTURES and path.stem[-1] in "0123456789" and not path.name.startswith(".")


def _parse_box(line: bytes, place: str) -> list[float]:
    match = _BOX.fullmatch(line)
    if match is None:
        raise DataError(f"{place}: not four numbers x,y,w,h")
    box = [float(number) for number in match.groups()]
    if any(abs(number) > _LARGEST for number in box):
        raise DataError(f"{place}: a number larger than a float holds")
    absent = [math.isnan(number) for number in box]
    if all(absent) or not any(box):
        return [math.nan] * 4
    if any(absent):
        raise DataError(f"{place}: nan in part of a box")
    if np.array(box[2:], np.float32).min() <= 0:  # a side may vanish in a float
        raise DataError(f"{place}: a box without area (nan,nan,nan,nan stands for no box)")
    return box
