"""Finished runs kept in a directory: an evaluation that was ended goes on where it was, a larger one builds on a smaller.

A run is known by what decides its outcome: pictures and ground truth, first box, seed, configuration, and the library or OpenCV
that ran. Where any of these changes, it is another run, and the old one is left alone.
"""

import hashlib
import io
import json
import zipfile
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from asttrack._library import LIBRARY
from asttrack.evaluation.bag_pictures import ModelPicture
from asttrack.evaluation.protocol import Run, Task
from asttrack.evaluation.sequence import Sequence
from asttrack.evaluation.trackers import AsttrackSpec, TrackerSpec
from asttrack.output import make_directory, write_bytes

_FORMAT = 1  # of the files, and of what the protocol does with a task


class KeptRuns:
    """A directory of finished runs, a file each."""

    def __init__(self, directory: Path) -> None:
        """Makes the directory where it is missing. Raises DataError."""
        make_directory(directory)
        self._directory = directory

    def find(self, task: Task) -> Run | None:
        """The kept run of a task; None where there is none, or where its file is damaged."""
        try:
            with np.load(self._path(task), allow_pickle=False) as arrays:
                frames = arrays["bag_frames"].tolist()
                return Run(
                    task.sequence.name,
                    task.tracker.label,
                    task.seed,
                    task.start.name,
                    arrays["boxes"],
                    arrays["ok"],
                    arrays["score"],
                    float(arrays["seconds"]),
                    tuple(_picture(arrays, place, frame) for place, frame in enumerate(frames)),
                )
        except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
            return None

    def keep(self, task: Task, run: Run) -> None:
        """Keeps a run that was finished. Raises DataError."""
        arrays: dict[str, Any] = {"boxes": run.boxes, "ok": run.ok, "score": run.score, "seconds": run.seconds}
        arrays["bag_frames"] = np.array([picture.frame for picture in run.bag], int)
        for place, picture in enumerate(run.bag):
            images = {"crop": picture.crop, "mean": picture.mean, "basis": picture.basis}
            arrays |= {f"bag_{place}_{name}": image for name, image in images.items() if image is not None}
        stream = io.BytesIO()
        np.savez_compressed(stream, **arrays)
        write_bytes(self._path(task), stream.getvalue())

    def _path(self, task: Task) -> Path:
        identity = {
            "format": _FORMAT,
            "pictures": _pictures(task.sequence),
            "truth": hashlib.sha256(task.sequence.truth.tobytes()).hexdigest(),
            "tracker": _tracker(task.tracker, task.seed),
            "start": asdict(task.start),
            "bag": task.look_inside,
        }
        return self._directory / f"{hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()[:32]}.npz"


def _picture(arrays: Any, place: int, frame: int) -> ModelPicture:
    mean, basis = (arrays[name] if (name := f"bag_{place}_{part}") in arrays else None for part in ("mean", "basis"))
    return ModelPicture(frame, arrays[f"bag_{place}_crop"], mean, basis)


@cache
def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _pictures(sequence: Sequence) -> list[tuple[str, int, int]]:
    """Where the pictures lie, and how large and how old they are: reading them all would take as long as tracking them."""
    found = []
    for path in sequence.frames:
        status = path.stat() if path.exists() else None
        found.append((str(path.resolve()), status.st_size if status else -1, status.st_mtime_ns if status else -1))
    return found


def _tracker(spec: TrackerSpec, seed: int) -> dict[str, Any]:
    if isinstance(spec, AsttrackSpec):
        return {"library": _digest(LIBRARY.path), "config": spec.make(seed).tracker.config}
    return {"opencv": cv2.__version__, "maker": spec.maker, "seed": seed}
