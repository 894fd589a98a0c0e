"""A sequence on disk that is tracked in a second, for the tests of the evaluation."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from asttrack.evaluation.results import Evaluation
from asttrack.evaluation.sequence import Sequence, read_sequence
from asttrack.evaluation.trackers import parse_trackers
from asttrack.scene import Scene

Item = TypeVar("Item")

SCENE = Scene(frames=24, width=160, height=120, size=(28, 24), occlusion=False)


HARD = replace(SCENE, occlusion=True)


def write(directory: Path, scene: Scene = SCENE) -> Sequence:
    """Writes a scene and reads it back."""
    scene.write(directory)
    return read_sequence(directory)


def unseen(items: Iterable[Item], _total: int) -> Iterable[Item]:
    """Progress that nobody watches."""
    return items


def evaluated(sequences: list[Sequence], trackers: str, *, seeds: int = 1, spatial: bool = False) -> Evaluation:
    """An evaluation of trackers that are given as on the command line."""
    from asttrack.evaluation.evaluate import evaluate

    evaluation, interrupted = evaluate(
        sequences, parse_trackers(trackers, "tiny"), seeds=seeds, jobs=2, spatial=spatial, progress=unseen
    )
    assert not interrupted
    return evaluation
