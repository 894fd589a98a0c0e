"""Frames of every layout give the library the pixels that numpy says they hold."""

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from asttrack import Result, Tracker, _abi
from asttrack.frames import ColourOrder, FrameReader
from short_scene import BOXES, FRAMES

Pixels = NDArray[np.uint8]
RANDOM = np.random.default_rng(3)
GREY: Pixels = RANDOM.integers(0, 256, (37, 53), dtype=np.uint8)
COLOUR: Pixels = RANDOM.integers(0, 256, (37, 53, 3), dtype=np.uint8)


def seen(frame: Pixels, colour: ColourOrder = "bgr") -> tuple[Pixels, bool]:
    """The grey picture that the library reads by pointer, sides and stride, and whether it lies in the frame itself."""
    reader = FrameReader(colour)
    target = _abi.Frame()
    reader.point(frame, target)
    rows = [ctypes.string_at(target.pixels + row * target.stride, target.width) for row in range(target.height)]
    picture = np.frombuffer(b"".join(rows), np.uint8).reshape(target.height, target.width)
    return picture, target.pixels == frame.ctypes.data


def luma(frame: Pixels, order: ColourOrder) -> NDArray[np.float64]:
    """ITU-R BT.601, before rounding."""
    red, green, blue = (frame[:, :, channel].astype(np.float64) for channel in ((2, 1, 0) if order == "bgr" else (0, 1, 2)))
    return 0.299 * red + 0.587 * green + 0.114 * blue


def padded(frame: Pixels, columns: int) -> Pixels:
    """The same picture as a window into a wider one."""
    wide = np.zeros((frame.shape[0], frame.shape[1] + columns, *frame.shape[2:]), np.uint8)
    wide[:, : frame.shape[1]] = frame
    return wide[:, : frame.shape[1]]


def spread(frame: Pixels) -> Pixels:
    """The same picture in every second column of a wider one."""
    return np.repeat(frame, 2, axis=1)[:, ::2]


BORROWED: dict[str, Callable[[Pixels], Pixels]] = {
    "contiguous": lambda f: f,
    "read-only": lambda f: np.frombuffer(f.tobytes(), np.uint8).reshape(f.shape),
    "rows apart": lambda f: padded(f, 11),
    "every second row": lambda f: np.repeat(f, 2, axis=0)[::2],
    "one row": lambda f: f[:1],
    "one column": lambda f: f[:, :1],
}
COPIED: dict[str, Callable[[Pixels], Pixels]] = {
    "upside down": lambda f: np.ascontiguousarray(f[::-1])[::-1],
    "mirrored": lambda f: np.ascontiguousarray(f[:, ::-1])[:, ::-1],
    "columns apart": spread,
    "column-major": np.asfortranarray,
    "one row broadcast": lambda f: np.broadcast_to(f[:1], f.shape),
    "one pixel broadcast": lambda f: np.broadcast_to(f[:1, :1], f.shape),
}


@pytest.mark.parametrize("layout", BORROWED)
def test_contiguous_rows_are_borrowed(layout: str) -> None:
    frame = BORROWED[layout](GREY)
    picture, borrowed = seen(frame)
    assert borrowed
    np.testing.assert_array_equal(picture, frame)


@pytest.mark.parametrize("layout", COPIED)
def test_other_layouts_are_copied(layout: str) -> None:
    frame = COPIED[layout](GREY)
    picture, borrowed = seen(frame)
    assert not borrowed
    np.testing.assert_array_equal(picture, frame)


@pytest.mark.parametrize("layout", [*BORROWED, *COPIED])
@pytest.mark.parametrize("order", ["bgr", "rgb"])
def test_colour_becomes_luma(layout: str, order: ColourOrder) -> None:
    frame = (BORROWED | COPIED)[layout](COLOUR)
    picture, _ = seen(frame, order)
    assert np.abs(picture - luma(frame, order)).max() <= 0.5 + 1e-2


def test_the_channel_order_matters() -> None:
    np.testing.assert_array_equal(seen(COLOUR, "bgr")[0], seen(COLOUR[:, :, ::-1], "rgb")[0])
    assert (seen(COLOUR, "bgr")[0] != seen(COLOUR, "rgb")[0]).any()


@pytest.mark.parametrize("layout", [*BORROWED, *COPIED])
def test_one_channel_is_grey(layout: str) -> None:
    frame = (BORROWED | COPIED)[layout](GREY[:, :, np.newaxis])
    np.testing.assert_array_equal(seen(frame)[0], frame[:, :, 0])


def test_the_window_of_four_channels_that_the_message_recommends_works() -> None:
    bgra: Pixels = np.dstack([COLOUR, GREY])
    np.testing.assert_array_equal(seen(bgra[:, :, :3])[0], seen(COLOUR)[0])


def test_a_matrix_subclass_is_a_frame() -> None:
    class Picture(np.ndarray[Any, Any]):
        pass

    np.testing.assert_array_equal(seen(GREY.view(Picture))[0], GREY)


@pytest.mark.parametrize(
    ("frame", "error", "message"),
    [
        ([[1, 2], [3, 4]], TypeError, "a frame must be a numpy array of uint8, not list"),
        (None, TypeError, "a frame must be a numpy array of uint8, not NoneType"),
        (b"pixels", TypeError, "not bytes"),
        (GREY.astype(np.float32) / 255, TypeError, r"a frame must be of dtype uint8 \(0 .. 255\), not float32"),
        (GREY.astype(np.int8), TypeError, "not int8"),
        (GREY > 127, TypeError, "not bool"),
        (GREY.astype(">u2"), TypeError, "not >u2"),
        (GREY[0], ValueError, r"a frame must be \(height, width\), \(height, width, 1\) or \(height, width, 3\), not \(53,\)"),
        (np.array(3, np.uint8), ValueError, r"not \(\)"),
        (np.dstack([COLOUR, GREY]), ValueError, r"not \(37, 53, 4\): drop the alpha channel with frame\[:, :, :3\]"),
        (COLOUR[:, :, :2], ValueError, r"not \(37, 53, 2\)$"),
        (COLOUR[np.newaxis], ValueError, r"not \(1, 37, 53, 3\)"),
        (COLOUR.transpose(2, 0, 1), ValueError, r"not \(3, 37, 53\)"),
        (GREY[:0], ValueError, r"a frame must have 1 .. 65535 pixels a side, not shape \(0, 53\)"),
        (COLOUR[:, :0], ValueError, r"not shape \(37, 0, 3\)"),
        (np.broadcast_to(GREY[:1, :1], (65536, 1)), ValueError, r"not shape \(65536, 1\)"),
        (np.broadcast_to(COLOUR[:1, :1], (1, 65536, 3)), ValueError, r"not shape \(1, 65536, 3\)"),
    ],
)
def test_what_is_no_frame_is_refused(frame: Any, error: type[Exception], message: str) -> None:
    tracker = Tracker("tiny")
    with pytest.raises(error, match=message):
        tracker.init(frame, (1, 1, 10, 10))
    tracker.init(GREY, (1, 1, 10, 10))
    before = tracker.save()
    with pytest.raises(error, match=message):
        tracker.update(frame)
    with pytest.raises(error, match=message):
        tracker.update_cv(frame)
    with pytest.raises(error, match=message):
        tracker.init_sequence([GREY, frame], [(1, 1, 10, 10)] * 2)
    assert tracker.save() == before


def test_the_largest_sides_are_accepted() -> None:
    for shape in ((65535, 2), (2, 65535)):
        tracker = Tracker("tiny")
        tracker.init(np.zeros(shape, np.uint8), (0, 0, 2, 2))
        assert tracker.update(np.zeros((*shape, 3), np.uint8)).frame == 1


def test_layouts_track_alike() -> None:
    def track(change: Callable[[Pixels], Pixels]) -> list[Result]:
        tracker = Tracker("tiny")
        tracker.init(change(FRAMES[0]), BOXES[0])
        return [tracker.update(change(frame)) for frame in FRAMES[1:6]]

    expected = track(lambda f: f)
    for change in (
        lambda f: padded(f, 5),
        spread,
        np.asfortranarray,
        lambda f: np.dstack([f, f, f]),
        lambda f: f[:, :, np.newaxis],
    ):
        assert track(change) == expected


def test_a_copied_frame_is_not_kept() -> None:
    reader = FrameReader("bgr")
    target = _abi.Frame()
    first = np.asfortranarray(GREY)
    reader.point(first, target)
    place = target.pixels
    reader.point(np.asfortranarray(255 - GREY), target)
    assert target.pixels == place  # the buffer is used again
    assert ctypes.string_at(target.pixels, 53) == (255 - GREY)[0].tobytes()
