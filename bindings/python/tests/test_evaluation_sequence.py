"""Sequences on disk: layouts, forms of ground truth, and what is wrong with them.

The lists in tests/sequences are the C tests', too.
"""

import os
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from asttrack.evaluation.sequence import find_sequences, numbered_pictures, read_grey, read_sequence, read_truth
from asttrack.failures import DataError
from asttrack.natural_order import natural_key
from header import REPOSITORY

BOX = "10,12,20,22"


def listed(name: str) -> list[str]:
    """The lines of a list that are neither empty nor comments."""
    lines = (REPOSITORY / "tests" / "sequences" / name).read_text(encoding="utf-8").split("\n")
    return [line for line in lines if line and not line.startswith("#")]


def make(directory: Path, lines: list[str], frames: int, truth: str = "groundtruth.txt", folder: str = "img") -> Path:
    (directory / folder).mkdir(parents=True)
    for number in range(1, frames + 1):
        cv2.imwrite(str(directory / folder / f"{number:04d}.png"), np.full((48, 64), number, np.uint8))
    (directory / truth).write_text("\n".join(lines) + "\n")
    return directory


def bytes_of(text: str) -> bytes:
    r"""What the list writes with \n, \t, \r and \xNN."""
    return text.encode("ascii").decode("unicode_escape").encode("latin-1")


def as_listed(truth: NDArray[np.float64]) -> str:
    """Boxes as the list has them, to the digits that a float keeps."""
    return " ".join("-" if np.isnan(box[0]) else ",".join(f"{side:g}" for side in box) for box in truth.astype(np.float32))


@pytest.mark.parametrize("line", listed("ground_truth.txt"))
def test_ground_truth_is_read_or_refused_by_its_line(tmp_path: Path, line: str) -> None:
    path = tmp_path / "groundtruth.txt"
    text, _, expected = line.partition(" | ")
    path.write_bytes(bytes_of(text))
    if expected.startswith(":"):
        with pytest.raises(DataError) as failure:
            read_truth(path)
        assert str(failure.value) == f"{path}{expected}"
    else:
        assert as_listed(read_truth(path)) == expected


def test_long_lines_are_refused(tmp_path: Path) -> None:
    """511 bytes are a line, its carriage return counted, and 512 are none, even where they are blank."""
    path = tmp_path / "groundtruth.txt"
    for text in (f"{BOX:510}\r\n", f"{BOX:510}", f"{BOX}\n{'':511}"):
        path.write_bytes(text.encode())
        assert read_truth(path).tolist() == [[10, 12, 20, 22]]
    for text, number in ((f"{BOX:511}\r\n", 1), (f"{BOX}\n{'':512}", 2)):
        path.write_bytes(text.encode())
        with pytest.raises(DataError) as failure:
            read_truth(path)
        assert str(failure.value) == f"{path}:{number}: too long for four numbers x,y,w,h"


def test_frames_come_in_natural_order(tmp_path: Path) -> None:
    names = listed("frame_names.txt")
    for name in (*names, "notes.txt", "cover.pgm", ".1.pgm", "1", "1.pgm.part", "\u0663.pgm"):
        (tmp_path / name).touch()
    assert [path.name for path in numbered_pictures(tmp_path)] == names


def test_names_that_are_no_text_come_in_the_order_of_their_bytes() -> None:
    names = [b"\xf0\x9f\x99\x821.pgm", b"\xff2.pgm", b"\xff10.pgm"]
    assert sorted(map(os.fsdecode, reversed(names)), key=natural_key) == list(map(os.fsdecode, names))


@pytest.mark.parametrize("pair", listed("same_frames.txt"))
def test_the_same_frame_twice_is_refused(tmp_path: Path, pair: str) -> None:
    first, second = pair.split()
    for name in (second, first):
        (tmp_path / name).touch()
    with pytest.raises(DataError) as failure:
        numbered_pictures(tmp_path)
    assert str(failure.value) == f"{tmp_path}: {first} and {second} have the same number"


def test_pictures_are_read_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    (tmp_path / "img").mkdir()
    for number in (1, 2, 10, 100):
        cv2.imwrite(str(tmp_path / "img" / f"frame{number}.png"), np.full((8, 8), number, np.uint8))
    (tmp_path / "img" / "notes.txt").write_text("not a picture")
    (tmp_path / "img" / "cover.png").write_text("a picture without a number")
    (tmp_path / "groundtruth_rect.txt").write_text(f"{BOX}\n" * 4)
    sequence = read_sequence(tmp_path)
    assert [int(picture[0, 0]) for picture in sequence.pictures()] == [1, 2, 10, 100]
    assert sequence.name == tmp_path.name
    assert sequence.notes == ()


@pytest.mark.parametrize(("lines", "frames", "kept"), [(3, 5, 3), (5, 3, 3)])
def test_what_has_both_frame_and_line_is_evaluated_and_the_rest_is_told(tmp_path: Path, lines: int, frames: int, kept: int) -> None:
    sequence = read_sequence(make(tmp_path, [BOX] * lines, frames))
    assert (len(sequence), sequence.truth.shape) == (kept, (kept, 4))
    (note,) = sequence.notes
    assert f"{frames} frames but {lines} lines of ground truth: evaluated on the first {kept}" in note


@pytest.mark.parametrize(
    ("lines", "frames", "message"),
    [
        ([BOX], 1, "fewer than two frames"),
        ([BOX] * 2, 0, "no numbered pictures"),
        (["nan,nan,nan,nan", BOX], 2, "groundtruth.txt:1: no box to start from"),
    ],
)
def test_a_directory_that_is_no_sequence_is_refused(tmp_path: Path, lines: list[str], frames: int, message: str) -> None:
    with pytest.raises(DataError, match=message):
        read_sequence(make(tmp_path, lines, frames))


def test_a_directory_of_sequences_stands_for_them_and_the_unusable_are_told(tmp_path: Path) -> None:
    make(tmp_path / "many" / "b", [BOX] * 2, 2)
    make(tmp_path / "many" / "a", [BOX] * 2, 2, truth="groundtruth_rect.txt", folder=".")
    make(tmp_path / "one" / "a", [BOX] * 2, 2)
    (tmp_path / "many" / "README.md").write_text("text")
    paths = [tmp_path / "many", tmp_path / "one" / "a", tmp_path / "none", tmp_path / "many" / "README.md"]
    sequences, problems = find_sequences(paths)
    assert [sequence.directory.name for sequence in sequences] == ["a", "b", "a"]
    names = [sequence.name for sequence in sequences]
    assert len(set(names)) == 3
    assert names[1] == "b"
    assert [problem.split(": ")[1] for problem in problems] == ["no such directory", "is not a directory"]


def test_a_damaged_picture_is_named(tmp_path: Path) -> None:
    sequence = read_sequence(make(tmp_path, [BOX] * 3, 3))
    sequence.frames[1].write_bytes(b"not a picture")
    pictures = sequence.pictures()
    next(pictures)
    with pytest.raises(DataError, match=r"0002\.png: not a picture that OpenCV reads, or damaged"):
        next(pictures)
    with pytest.raises(DataError, match="No such file"):
        read_grey(tmp_path / "absent.png")
