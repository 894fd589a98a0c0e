"""numpy frames to the library's borrowed grey frames, without a copy where none is needed."""

from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from asttrack import _abi
from asttrack._library import LIBRARY

ColourOrder: TypeAlias = Literal["bgr", "rgb"]
Frame: TypeAlias = NDArray[np.uint8]
"""Pixels of one picture: uint8, grey (height, width) or (height, width, 1), or colour (height, width, 3)."""

_UINT8 = np.dtype(np.uint8)
_CONVERSIONS = {"bgr": "ast_grey_from_bgr", "rgb": "ast_grey_from_rgb"}
_STRIDE_LIMIT = 2**31 - 1


class FrameReader:
    """Points an `ast_frame` at numpy pixels.

    Grey rows that are contiguous are borrowed where they lie, whatever the distance between rows; other layouts are copied, and
    colour is converted (ITU-R BT.601 luma), into a buffer that stays for the next frame.

    Args:
        colour: order of the channels of colour frames: "bgr" as OpenCV reads them, or "rgb".
    """

    def __init__(self, colour: ColourOrder) -> None:
        if colour not in _CONVERSIONS:
            raise ValueError(f"colour must be 'bgr' or 'rgb', not {colour!r}")
        self.colour: ColourOrder = colour
        self._grey_from_colour = getattr(LIBRARY.calls, _CONVERSIONS[colour])
        self._grey = np.empty((0, 0), _UINT8)
        self._copy = np.empty((0, 0), _UINT8)

    def point(self, frame: object, target: _abi.Frame) -> None:
        """Makes `target` describe `frame`; good while both `frame` and this reader live and until the next call.

        Raises:
            TypeError: not a numpy array of uint8.
            ValueError: the shape is not that of a picture.
        """
        if not isinstance(frame, np.ndarray):
            raise TypeError(f"a frame must be a numpy array of uint8, not {type(frame).__name__}")
        if frame.dtype != _UINT8:
            raise TypeError(f"a frame must be of dtype uint8 (0 .. 255), not {frame.dtype}")
        shape = frame.shape
        channels = 1 if len(shape) == 2 else shape[2] if len(shape) == 3 else 0
        if channels not in (1, 3):
            raise ValueError(_shape_message(shape))
        height, width = shape[:2]
        if not (1 <= height <= _abi.MAX_FRAME and 1 <= width <= _abi.MAX_FRAME):
            raise ValueError(f"a frame must have 1 .. {_abi.MAX_FRAME} pixels a side, not shape {shape}")
        address, stride = self._rows(frame[:, :, 0] if shape[2:] == (1,) else frame)
        if channels == 3:
            address, stride = self._converted(address, stride, height, width)
        target.pixels = address
        target.width = width
        target.height = height
        target.stride = stride

    def _rows(self, pixels: NDArray[Any]) -> tuple[int, int]:
        """Address of the first pixel and bytes between rows, of `pixels` itself or of a copy whose rows are contiguous."""
        _, width, *channels = pixels.shape
        row = width * channels[0] if channels else width
        stride = pixels.strides[0]
        if pixels.strides[1:] != ((channels[0], 1) if channels else (1,)) or not row <= stride <= _STRIDE_LIMIT:
            if self._copy.shape != pixels.shape:
                self._copy = np.empty(pixels.shape, _UINT8)
            np.copyto(self._copy, pixels)
            pixels, stride = self._copy, row
        return pixels.__array_interface__["data"][0], stride

    def _converted(self, address: int, stride: int, height: int, width: int) -> tuple[int, int]:
        """The same for colour rows made grey."""
        if self._grey.shape != (height, width):
            self._grey = np.empty((height, width), _UINT8)
        grey = self._grey.__array_interface__["data"][0]
        LIBRARY.check(self._grey_from_colour(grey, width, address, stride, width, height))
        return grey, width


def _shape_message(shape: tuple[int, ...]) -> str:
    message = f"a frame must be (height, width), (height, width, 1) or (height, width, 3), not {shape}"
    if len(shape) == 3 and shape[2] == 4:
        message += ": drop the alpha channel with frame[:, :, :3]"
    return message
