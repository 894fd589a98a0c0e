"""A gallery of what the tracker does and remembers, on the synthetic scene: no data is needed for it."""

import io
import tempfile
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from asttrack.evaluation.bag_pictures import ModelPicture
from asttrack.evaluation.evaluate import Progress, evaluate
from asttrack.evaluation.figures import colour, curves, errors_over_time
from asttrack.evaluation.results import Evaluation
from asttrack.evaluation.sequence import Sequence, read_grey, read_sequence
from asttrack.evaluation.trackers import AsttrackSpec, TrackerSpec
from asttrack.failures import DataError
from asttrack.frames import Frame
from asttrack.output import make_directory, write_bytes, write_text
from asttrack.scene import Scene
from asttrack.tracker import Tracker

PRESETS = ("robust", "paper", "tiny")
STILLS = 6
CLOUDS = (2, 40, 75)  # frames whose particles are shown: the first step, free motion, the bar in front of the object
_INK = "#7d7d7d"  # of charts that stand alone: readable on white and on black
_DPI = 110

CAPTIONS = {
    "film.png": "The scene: an object on a swinging path, light that breathes, a bar that passes over. White is the truth.",
    "particles.png": "Particles of the robust preset, coloured by weight, and the tracked box.",
    "bag.png": "The bag of the robust preset: the object when each model was made, the model's mean and first basis vector.",
    "errors.svg": "Centre error and confidence over the frames.",
    "precision.svg": "Share of frames whose centre is within so many pixels.",
    "success.svg": "Share of frames whose box overlaps the truth by more than so much.",
}


def make(directory: Path, scene: Scene, jobs: int, progress: Progress) -> list[Path]:
    """Makes the pictures; the files written. Raises DataError."""
    make_directory(directory)
    with tempfile.TemporaryDirectory() as place:
        scene.write(Path(place) / "scene")
        sequence = read_sequence(Path(place) / "scene")
        trackers: list[TrackerSpec] = [AsttrackSpec(preset, preset) for preset in PRESETS]
        evaluation, interrupted = evaluate([sequence], trackers, seeds=1, jobs=jobs, spatial=False, progress=progress)
        if interrupted:
            raise KeyboardInterrupt
        if evaluation.failures:
            raise DataError(evaluation.failures[0])
        precision, success = curves(evaluation)
        pictures: dict[str, Callable[[], bytes]] = {
            "film.png": lambda: _film(evaluation, sequence),
            "particles.png": lambda: _particles(sequence),
            "bag.png": lambda: _bag(evaluation, sequence),
            "errors.svg": lambda: _alone(errors_over_time(evaluation, sequence.name)),
            "precision.svg": lambda: _alone(precision),
            "success.svg": lambda: _alone(success),
        }
        for name, draw in pictures.items():
            write_bytes(directory / name, draw())
    lines = "\n\n".join(f"![{caption}]({name})\n\n{caption}" for name, caption in CAPTIONS.items())
    colours = "The presets: robust is orange, paper blue, tiny green."
    write_text(directory / "README.md", f"# Gallery\n\nMade by `python -m asttrack gallery`. {colours}\n\n{lines}\n")
    return [directory / name for name in (*CAPTIONS, "README.md")]


def _film(evaluation: Evaluation, sequence: Sequence) -> bytes:
    tiles = []
    for index in np.linspace(0, len(sequence) - 1, STILLS).round().astype(int):
        canvas = np.asarray(cv2.cvtColor(read_grey(sequence.frames[index]), cv2.COLOR_GRAY2BGR), np.uint8)
        canvas = np.asarray(cv2.resize(canvas, None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR), np.uint8)
        _rectangle(canvas, sequence.truth[index], (255, 255, 255))
        for rank, label in reversed(list(enumerate(evaluation.labels))):
            measured = evaluation.first(label, sequence.name)
            if measured is not None:
                red, green, blue = (round(255 * part) for part in to_rgb(colour(rank)))
                _rectangle(canvas, measured.run.boxes[index], (blue, green, red))
        tiles.append(cv2.copyMakeBorder(canvas, 4, 4, 4, 4, cv2.BORDER_CONSTANT, value=(255, 255, 255)))
    rows = [np.hstack(tiles[start : start + 3]) for start in range(0, STILLS, 3)]
    return _png(np.vstack(rows))


def _rectangle(canvas: Frame, box: np.ndarray[tuple[int], np.dtype[np.float64]], colour: tuple[int, int, int]) -> None:
    """A box in frame coordinates on a canvas of twice the size."""
    x, y, w, h = (round(2 * float(side)) for side in box)
    cv2.rectangle(canvas, (x, y), (x + w, y + h), colour, 2, cv2.LINE_AA)


def _particles(sequence: Sequence) -> bytes:
    figure = Figure(figsize=(10, 3.1), dpi=_DPI, layout="constrained")
    panels = figure.subplots(1, len(CLOUDS))
    tracker = Tracker("robust")
    pictures = sequence.pictures()
    tracker.init(next(pictures), sequence.truth[0])
    count = len(tracker.particles.x)
    norm = LogNorm(1e-2 / count, 1e2 / count)
    for number, frame in enumerate(pictures, 2):
        result = tracker.update(frame)
        if number - 1 not in CLOUDS:
            continue
        axes, cloud = panels[CLOUDS.index(number - 1)], tracker.particles
        axes.set_facecolor(_INK)
        axes.imshow(frame, cmap="gray", vmin=0, vmax=255)
        order = np.argsort(cloud.weight)
        weights = np.clip(cloud.weight[order], norm.vmin, norm.vmax)
        axes.scatter(cloud.x[order], cloud.y[order], c=weights, norm=norm, cmap="plasma", s=6, linewidths=0)
        x, y, w, h = result.box
        axes.add_patch(Rectangle((x - 0.5, y - 0.5), w, h, fill=False, edgecolor=colour(0), linewidth=2))
        reach = 1.4 * max(w, h)
        axes.set(
            xlim=(x + w / 2 - reach, x + w / 2 + reach),
            ylim=(y + h / 2 + 0.75 * reach, y + h / 2 - 0.75 * reach),
            xticks=[],
            yticks=[],
        )
        axes.set_title(f"frame {number}: {result.effective_particles:.0f} of {count} effective", fontsize=9)
    figure.colorbar(ScalarMappable(norm, "plasma"), ax=panels, label="weight", shrink=0.9)
    stream = io.BytesIO()
    figure.savefig(stream, format="png", metadata={"Software": None})
    return stream.getvalue()


def _bag(evaluation: Evaluation, sequence: Sequence) -> bytes:
    measured = evaluation.first(PRESETS[0], sequence.name)
    models = measured.run.bag if measured is not None else ()
    if not models:
        raise DataError("gallery: the scene is too short for a model to enter the bag")
    return _png(np.hstack([_column(model) for model in models[-10:]]))


def _column(model: ModelPicture) -> Frame:
    """A model's pictures above each other, twice as large."""
    height, width = model.crop.shape
    images = [image for image in (model.crop, model.mean, model.basis) if image is not None]
    scaled = [cv2.resize(image, (2 * width, 2 * height), interpolation=cv2.INTER_CUBIC) for image in images]
    framed = [cv2.copyMakeBorder(image, 3, 3, 3, 3, cv2.BORDER_CONSTANT, value=(255,)) for image in scaled]
    # Boxes differ by a pixel in width as the scale changes: the mosaic's columns may, its rows not.
    return np.vstack(framed)


def _png(image: Frame) -> bytes:
    return cv2.imencode(".png", image)[1].tobytes()


def _alone(svg: str) -> bytes:
    """A chart as a file: without a page, there is no text colour to take."""
    return svg.replace("currentColor", _INK).encode()
