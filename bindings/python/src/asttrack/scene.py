"""A moving scene made from a seed, with its ground truth: for pictures, measurements and tests where there is no data."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from asttrack.output import make_directory, write_bytes, write_text
from asttrack.result import Box

_MARGIN = 8  # pixels between the target's path and the border of the frame
_TURNS = (1.0, 2.0)  # swings of the path across and down; unequal, so that it does not come back on itself


def _texture(generator: np.random.Generator, height: int, width: int, cells: tuple[int, ...]) -> NDArray[np.float64]:
    """Smooth noise in [0, 1]: random grids of several finenesses, stretched to the size and added.

    Args:
        generator: of the random numbers.
        height: of the texture, pixels.
        width: of the texture, pixels.
        cells: how many of a grid's square cells there are in the height; a grid each.
    """
    total = np.zeros((height, width))
    for rank, count in enumerate(cells):
        across = max(1, round(count * width / height))
        grid = generator.random((count + 1, across + 1))
        rows, columns = np.linspace(0, count, height), np.linspace(0, across, width)
        total += _bilinear(grid, rows[:, None], columns[None, :]) / (rank + 1)
    low, high = total.min(), total.max()
    scaled: NDArray[np.float64] = (total - low) / (high - low)
    return scaled


def _bilinear(image: NDArray[np.float64], rows: NDArray[np.float64], columns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Samples of an image at fractional places; beyond the border, the border."""
    rows = np.clip(rows, 0, image.shape[0] - 1)
    columns = np.clip(columns, 0, image.shape[1] - 1)
    top, left = np.floor(rows).astype(int), np.floor(columns).astype(int)
    bottom, right = np.minimum(top + 1, image.shape[0] - 1), np.minimum(left + 1, image.shape[1] - 1)
    down, across = rows - top, columns - left
    upper = image[top, left] * (1 - across) + image[top, right] * across
    lower = image[bottom, left] * (1 - across) + image[bottom, right] * across
    sampled: NDArray[np.float64] = upper * (1 - down) + lower * down
    return sampled


@dataclass(frozen=True)
class Scene:
    """A textured object on a swinging path over a textured, panning background; the light breathes, a bar passes over it once.

    The same arguments give the same pixels. Frames are made when asked for, in any order.

    Args:
        frames: how many.
        width: of a frame, pixels.
        height: of a frame, pixels.
        seed: of textures, path and noise.
        size: width and height of the object at scale 1, pixels.
        occlusion: whether the bar passes.
    """

    frames: int = 150
    width: int = 320
    height: int = 240
    seed: int = 1
    size: tuple[int, int] = (48, 40)
    occlusion: bool = True
    _background: NDArray[np.float64] = field(init=False, repr=False, compare=False)
    _object: NDArray[np.float64] = field(init=False, repr=False, compare=False)
    _phase: tuple[float, float] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        generator = np.random.default_rng(self.seed)
        ground = 50 + 120 * _texture(generator, 2 * self.height, 2 * self.width, (6, 14, 40))
        target = 255 * _texture(generator, 2 * self.size[1], 2 * self.size[0], (3, 5, 9))
        # Steps of grey give edges, which smooth noise has not: many on the object, some on the ground.
        object.__setattr__(self, "_background", 0.6 * ground + 0.4 * np.round(ground / 30) * 30)
        object.__setattr__(self, "_object", np.round(target / 64) * 64)
        object.__setattr__(self, "_phase", tuple(generator.uniform(0, 2 * np.pi, 2)))

    def _time(self, index: int) -> float:
        """0 at the first frame, 1 at 150 frames after it: motion a frame does not depend on the length."""
        if not 0 <= index < self.frames:
            raise IndexError(f"frame {index} of a scene of {self.frames}")
        return index / 150

    def box(self, index: int) -> Box:
        """The object's box in a frame (from 0)."""
        time = self._time(index)
        scale = 1 + 0.2 * np.sin(2 * np.pi * time)
        w, h = self.size[0] * scale, self.size[1] * scale
        reach_x = self.width / 2 - _MARGIN - 0.6 * self.size[0]
        reach_y = self.height / 2 - _MARGIN - 0.6 * self.size[1]
        x = self.width / 2 + reach_x * np.sin(2 * np.pi * _TURNS[0] * time + self._phase[0])
        y = self.height / 2 + reach_y * np.sin(2 * np.pi * _TURNS[1] * time + self._phase[1])
        return Box(float(x - w / 2), float(y - h / 2), float(w), float(h))

    def frame(self, index: int) -> NDArray[np.uint8]:
        """The pixels of a frame (from 0), grey."""
        time = self._time(index)
        rows, columns = np.arange(self.height, dtype=float)[:, None], np.arange(self.width, dtype=float)[None, :]
        pan_x = self.width / 2 * (1 + 0.6 * np.sin(2 * np.pi * 0.7 * time))
        pan_y = self.height / 2 * (1 + 0.6 * np.cos(2 * np.pi * 0.5 * time))
        picture = _bilinear(self._background, rows + pan_y, columns + pan_x)

        x, y, w, h = self.box(index)
        inside = (rows >= y - 0.5) & (rows < y + h - 0.5) & (columns >= x - 0.5) & (columns < x + w - 0.5)
        texture_rows = (rows - y + 0.5) / h * self._object.shape[0] - 0.5
        texture_columns = (columns - x + 0.5) / w * self._object.shape[1] - 0.5
        picture = np.where(inside, _bilinear(self._object, texture_rows, texture_columns), picture)
        if self.occlusion:
            # Stands in the object's way for a twelfth of the scene, and covers half of it.
            away = (index - self.frames / 2) / (self.frames / 12)
            centre = x + w / 2 + away * w
            picture = np.where((np.abs(columns - centre) < w / 4) & (abs(away) < 1), 90.0, picture)
        picture = picture * (1 + 0.25 * np.sin(2 * np.pi * 1.3 * time))
        noise = np.random.default_rng((self.seed, index)).normal(0, 3, picture.shape)
        return np.asarray(np.clip(np.round(picture + noise), 0, 255), np.uint8)

    def write(self, directory: Path) -> None:
        """Writes the scene as a sequence: `img/00001.pgm` and on, `groundtruth.txt`. Raises DataError."""
        make_directory(directory / "img")
        for index in range(self.frames):
            header = f"P5\n{self.width} {self.height}\n255\n".encode()
            write_bytes(directory / "img" / f"{index + 1:05d}.pgm", header + self.frame(index).tobytes())
        lines = (",".join(f"{side:.2f}" for side in self.box(index)) for index in range(self.frames))
        write_text(directory / "groundtruth.txt", "\n".join(lines) + "\n")
