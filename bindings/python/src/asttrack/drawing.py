"""Tracks drawn into frames."""

import cv2
import numpy as np

from asttrack.frames import Frame
from asttrack.result import Result, Status
from asttrack.views import Particles

COLOURS = {Status.TRACKING: (80, 200, 60), Status.UNCERTAIN: (40, 170, 250), Status.LOST: (60, 60, 230)}
"""BGR by status."""
_POINT = (230, 200, 90)
_SUBPIXEL_BITS = 4  # of the coordinates that OpenCV's drawing takes


def draw_track(frame: Frame, result: Result, particles: Particles | None = None) -> Frame:
    """A copy of a BGR frame with the box, its status and score, and the particles where they are given."""
    canvas = frame.copy()
    thickness = max(1, round(min(frame.shape[:2]) / 240))
    if particles is not None:
        for x, y in zip(particles.x, particles.y, strict=True):
            cv2.circle(canvas, _fixed(x, y), thickness << _SUBPIXEL_BITS, _POINT, -1, cv2.LINE_AA, _SUBPIXEL_BITS)
    box, colour = result.box, COLOURS[result.status]
    corners = _fixed(box.x - 0.5, box.y - 0.5), _fixed(box.x + box.w - 0.5, box.y + box.h - 0.5)
    cv2.rectangle(canvas, *corners, colour, 2 * thickness, cv2.LINE_AA, _SUBPIXEL_BITS)
    return label(canvas, f"{result.status.name.lower()} {result.score:.2f}", colour)


def label(canvas: Frame, text: str, colour: tuple[int, int, int]) -> Frame:
    """Writes a line into the lower left corner, on a dark ground; changes the canvas."""
    scale = min(canvas.shape[:2]) / 480
    thickness = max(1, round(2 * scale))
    (width, height), base = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, thickness)
    bottom = canvas.shape[0] - base - thickness
    canvas[bottom - height - base :, : width + 2 * base] //= np.uint8(3)
    cv2.putText(canvas, text, (base, bottom), cv2.FONT_HERSHEY_SIMPLEX, scale, colour, thickness, cv2.LINE_AA)
    return canvas


def _fixed(x: float, y: float) -> tuple[int, int]:
    return round(float(x) * (1 << _SUBPIXEL_BITS)), round(float(y) * (1 << _SUBPIXEL_BITS))
