"""An easy sequence for the tests of the binding, where the question is the way to the library and not how well it tracks."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from asttrack import Box

COUNT: Final = 30
HEIGHT: Final = 120
WIDTH: Final = 160
SIDE: Final = 32


def _texture(random: np.random.Generator, height: int, width: int, cell: int) -> NDArray[np.uint8]:
    """Random squares of `cell` pixels a side, and some noise."""
    squares = np.kron(random.integers(30, 220, (height // cell, width // cell)), np.ones((cell, cell)))
    return np.clip(squares + random.normal(0, 6, (height, width)), 0, 255).astype(np.uint8)


def _render() -> tuple[list[NDArray[np.uint8]], list[Box]]:
    """A textured square that moves by some 3 pixels a frame over a texture that stands still."""
    random = np.random.default_rng(7)
    background, target = _texture(random, HEIGHT, WIDTH, 8), _texture(random, SIDE, SIDE, 4)
    frames, boxes = [], []
    for number in range(COUNT):
        x, y = 20 + 3 * number, round(40 + 15 * np.sin(number / 8))
        frame = background.copy()
        frame[y : y + SIDE, x : x + SIDE] = target
        frames.append(frame)
        boxes.append(Box(x, y, SIDE, SIDE))
    return frames, boxes


FRAMES, BOXES = _render()
