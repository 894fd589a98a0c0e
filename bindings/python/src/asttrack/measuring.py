"""Measurements of one library, in a process of their own: `python -m asttrack.measuring`.

A library is chosen, and linear algebra told its threads, when a process starts; so `bench` starts one for each. It writes the order
to stdin and reads the outcome from stdout, both as JSON.
"""

import json
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain, cycle, repeat
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from asttrack import __version__, subspace_distance, subspace_fit
from asttrack._library import LIBRARY
from asttrack.errors import AstError
from asttrack.evaluation.sequence import read_sequence
from asttrack.failures import DataError
from asttrack.frames import Frame
from asttrack.opencv import one_thread, quiet
from asttrack.result import Box
from asttrack.scene import Scene
from asttrack.tracker import Tracker

LEAST = 5  # calls that are timed, however long they take
PAPER = {"preset": "paper"}  # the one whose distances have a literal form, too
LITERAL = {**PAPER, "scoring": "literal"}
FEW = {**LITERAL, "particles": 50}  # the literal form is slow
SWEEPS: tuple[tuple[str, dict[str, Any], tuple[str, ...], tuple[int, ...]], ...] = (
    ("particles N", {}, ("particles",), (75, 150, 300, 600, 1200)),
    ("patch side, pixels", {}, ("patch_width", "patch_height"), (8, 16, 32, 64)),
    ("models in the bag k", {}, ("bag_size",), (1, 4, 8, 16, 32)),
    ("history P", {}, ("history",), (2, 4, 8, 15)),
    ("paper, literal: particles N", LITERAL, ("particles",), (25, 50, 100, 200)),
    ("paper, literal, N = 50: patch side", FEW, ("patch_width", "patch_height"), (8, 16, 32, 64)),
)
"""What is varied: its name, the changes to the preset that is measured, the fields that take the value, the values."""
PARTS: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("without gradients", "gradient_weight", {"gradient_weight": 0}),
    ("without background", "background", {"background": 0, "background_refresh": 0, "background_ratio": 0}),
)
"""What an update is timed without, where the preset has it: its name, the field that says so, the changes."""

Timing = dict[str, float | int]
Measure = Callable[[Tracker], Timing]


def load_film(sequence: str | None, count: int) -> tuple[list[Frame], NDArray[np.float64]]:
    """The frames to track, in memory, and the object's box in each, a row of nan where it is not known.

    They are the beginning of a sequence, or of the synthetic scene. Raises DataError.
    """
    if sequence is None:
        scene = Scene(frames=count, occlusion=False)
        return [scene.frame(index) for index in range(count)], np.array([scene.box(index) for index in range(count)], float)
    found = read_sequence(Path(sequence))
    pictures = [picture for picture, _ in zip(found.pictures(), range(count), strict=False)]
    return pictures, found.truth[: len(pictures)]


def load_frames(sequence: str | None, count: int) -> tuple[list[Frame], Box]:
    """The frames and the first box, of a sequence rounded to pixels. Raises DataError."""
    pictures, truth = load_film(sequence, count)
    return pictures, Box(*map(float, truth[0] if sequence is None else np.rint(truth[0])))


def forth_and_back(frames: list[Frame]) -> Iterator[Frame]:
    """The frames after the first, then backwards, without end: the object never jumps."""
    return cycle(chain(frames[1:], frames[-2::-1]))


def timing(call: Callable[[], object], seconds: float) -> Timing:
    """Processor time of a call, repeated for so many seconds: the median and the least, milliseconds."""
    return _timing(repeat(call), seconds)


def update_timing(tracker: Tracker, frames: list[Frame], box: Box, seconds: float) -> Timing:
    """Time of an update once the bag is full."""
    tracker.init(frames[0], box)
    settings = tracker.config
    coming = forth_and_back(frames)
    for _ in range(int(settings["bag_size"]) * int(settings["bag_interval"])):
        tracker.update(next(coming))
    return _timing((partial(tracker.update, frame) for frame in coming), seconds)


def _timing(calls: Iterator[Callable[[], object]], seconds: float) -> Timing:
    spent: list[int] = []
    while len(spent) < LEAST or sum(spent) < seconds * 1e9:
        call = next(calls)
        before = time.process_time_ns()
        call()
        spent.append(time.process_time_ns() - before)
    return {"median_ms": round(statistics.median(spent) / 1e6, 6), "least_ms": round(min(spent) / 1e6, 6), "calls": len(spent)}


def made(preset: str, changes: dict[str, Any]) -> Tracker:
    """A tracker whose bag takes a model each frame: it is full at once, and one more model a frame costs next to nothing."""
    return Tracker(**{"preset": preset, "bag_interval": 1, **changes})


def stages(preset: str, frames: list[Frame], box: Box, seconds: float) -> dict[str, Timing]:
    """Times of what the public interface lets one call, and of updates without some of their parts."""
    tracker = made(preset, {})
    times = {"init": timing(lambda: tracker.init(frames[0], box), seconds), "update": update_timing(tracker, frames, box, seconds)}
    for name, field, changes in PARTS:
        if float(tracker.config[field]) > 0:
            times[f"update {name}"] = update_timing(made(preset, changes), frames, box, seconds)
    coloured = [np.asarray(cv2.cvtColor(frame, cv2.COLOR_GRAY2BGR), np.uint8) for frame in frames]
    times["update, BGR frames"] = update_timing(tracker, coloured, box, seconds)
    times["update, paper, gram scoring"] = update_timing(made(preset, {**PAPER, "scoring": "gram"}), frames, box, seconds)
    times["update, paper, literal scoring"] = update_timing(made(preset, LITERAL), frames, box, seconds)

    state = tracker.save()
    times["save"] = timing(tracker.save, seconds)
    times["restore"] = timing(lambda: tracker.restore(state), seconds)

    size, history = int(tracker.config["basis_size"]), int(tracker.config["history"])
    images = np.random.default_rng(1).random((history + 1, tracker.feature_length), np.float32)
    fitted = subspace_fit(images, n=size)
    times["subspace_fit, one image set"] = timing(lambda: subspace_fit(images, n=size), seconds)
    times["subspace_distance, one pair"] = timing(lambda: subspace_distance(fitted, fitted, 1.0), seconds)
    return times


def sweep(preset: str, varied: tuple[str, ...], values: tuple[int, ...], fixed: dict[str, Any], measure: Measure) -> dict[str, Any]:
    """Times of an update over the values of a field, and the exponent of the power of it that fits them best."""
    points = [{"value": value, **measure(made(preset, {**fixed, **dict.fromkeys(varied, value)}))} for value in values]
    slope = np.polyfit(np.log(values), np.log([point["median_ms"] for point in points]), 1)[0]
    return {"fields": list(varied), "fixed": fixed, "points": points, "exponent": round(float(slope), 3)}


def measure_library(order: dict[str, Any]) -> dict[str, Any]:
    """Everything about the library that this process has loaded."""
    frames, box = load_frames(order["sequence"], order["frames"])
    preset, seconds = order["preset"], order["seconds"]
    return {
        "path": str(LIBRARY.path),
        "version": LIBRARY.version,
        "package": __version__,
        "backend": LIBRARY.backend,
        "preset": preset,
        "memory_bytes": Tracker(preset).memory_size,
        "stages": stages(preset, frames, box, seconds),
        "sweeps": [
            {"name": name, **sweep(preset, varied, values, fixed, lambda tracker: update_timing(tracker, frames, box, seconds))}
            for name, fixed, varied, values in SWEEPS
        ],
    }


def main() -> int:
    """Reads an order, writes what came of it: an object, of which `error` is a line when it failed."""
    one_thread()
    quiet()
    order = json.load(sys.stdin)
    try:
        outcome = measure_library(order)
    except (DataError, AstError) as error:
        outcome = {"error": str(error)}
    json.dump(outcome, sys.stdout)
    return 0


if __name__ == "__main__":
    sys.exit(main())
