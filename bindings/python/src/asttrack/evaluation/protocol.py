"""How trackers are run on sequences: OTB's one-pass and spatial robustness evaluations, one run a process."""

import math
import time
from collections.abc import Iterable
from collections.abc import Sequence as Many
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from asttrack.evaluation.bag_pictures import BagRecorder, ModelPicture
from asttrack.evaluation.sequence import Sequence
from asttrack.evaluation.trackers import AsttrackFollower, AsttrackSpec, Step, TrackerSpec
from asttrack.failures import DataError
from asttrack.opencv import one_thread, quiet
from asttrack.result import Box


@dataclass(frozen=True)
class Start:
    """How the first box differs from the annotated one.

    Attributes:
        name: in tables.
        dx: shift to the right, in widths of the box.
        dy: shift downwards, in heights of the box.
        scale: of both sides, about the centre.
    """

    name: str
    dx: float = 0.0
    dy: float = 0.0
    scale: float = 1.0

    def apply(self, box: Iterable[float]) -> Box:
        """The box to start from, in whole pixels: OpenCV's trackers take no others, and all get the same one."""
        x, y, w, h = box
        x += self.dx * w + (1 - self.scale) * w / 2
        y += self.dy * h + (1 - self.scale) * h / 2
        left, top, wide, high = (float(np.rint(side)) for side in (x, y, w * self.scale, h * self.scale))
        return Box(left, top, max(wide, 1.0), max(high, 1.0))


ONE_PASS = Start("one pass")
SHIFT = 0.1  # of the box's size
SPATIAL = (
    *(
        Start(name, dx * SHIFT, dy * SHIFT)
        for name, dx, dy in (
            ("left", -1, 0),
            ("right", 1, 0),
            ("up", 0, -1),
            ("down", 0, 1),
            ("up left", -1, -1),
            ("up right", 1, -1),
            ("down left", -1, 1),
            ("down right", 1, 1),
        )
    ),
    *(Start(f"scale {scale}", scale=scale) for scale in (0.8, 0.9, 1.1, 1.2)),
)
"""The twelve first boxes of OTB's spatial robustness evaluation."""


@dataclass(frozen=True)
class Task:
    """One tracker on one sequence from one first box.

    Attributes:
        sequence: what to track.
        tracker: by what.
        seed: of the tracker's random numbers.
        start: the first box.
        look_inside: whether to keep pictures of our tracker's bag.
    """

    sequence: Sequence
    tracker: TrackerSpec
    seed: int
    start: Start = ONE_PASS
    look_inside: bool = False


@dataclass(frozen=True, eq=False)
class Run:
    """What came out of a task.

    Attributes:
        sequence: name.
        tracker: label.
        seed: of the random numbers.
        start: name of the first box.
        boxes: (frames, 4) the boxes, the given one first.
        ok: (frames,) false where the tracker said that it had lost the object.
        score: (frames,) the tracker's confidence; nan where it gives none.
        seconds: processor time of all updates together.
        bag: pictures of the last models that entered the bag, oldest first; empty unless asked for.
        error: why the run ended before the last frame, in one line; None when it did not. The arrays are then empty.
    """

    sequence: str
    tracker: str
    seed: int
    start: str
    boxes: NDArray[np.float64]
    ok: NDArray[np.bool_]
    score: NDArray[np.float64]
    seconds: float
    bag: tuple[ModelPicture, ...] = ()
    error: str | None = None

    @property
    def updates(self) -> int:
        """Frames tracked: all but the first."""
        return max(0, len(self.boxes) - 1)


def plan(sequences: Iterable[Sequence], trackers: Many[TrackerSpec], seeds: int, spatial: bool) -> list[Task]:
    """The tasks of an evaluation, sequence by sequence.

    Trackers that draw no random numbers run once; the spatial robustness evaluation takes the first seed only, since its twelve
    starts are a spread of their own. Pictures of the bag are kept of our first tracker's first run.
    """
    shown = next((tracker for tracker in trackers if isinstance(tracker, AsttrackSpec)), None)
    tasks = []
    for sequence in sequences:
        for tracker in trackers:
            last = 1 if tracker.repeats else seeds
            tasks += [Task(sequence, tracker, seed, look_inside=seed == 1 and tracker is shown) for seed in range(1, last + 1)]
            if spatial:
                tasks += [Task(sequence, tracker, 1, start) for start in SPATIAL]
    return tasks


def run(task: Task) -> Run:
    """Runs a task in this process, which should be a new one: some of OpenCV's trackers leave state behind in theirs.

    Time is the processor's, of the updates alone: reading the pictures, and the wait for a core that another process has, are not
    the tracker's.
    """
    one_thread()
    quiet()
    follower = task.tracker.make(task.seed)
    recorder = BagRecorder(follower.tracker) if task.look_inside and isinstance(follower, AsttrackFollower) else None
    first = task.start.apply(task.sequence.truth[0])
    steps: list[Step] = []
    nanoseconds = 0
    try:
        for number, picture in enumerate(task.sequence.pictures(), 1):
            try:
                if number == 1:
                    follower.init(picture, first)
                    steps.append(Step(first, True, math.nan))
                    continue
                frame = follower.prepare(picture)
                before = time.process_time_ns()
                step = follower.update(frame)
                nanoseconds += time.process_time_ns() - before
            except DataError as error:
                return failed(task, f"frame {number}: {error}")
            steps.append(step)
            if recorder is not None:
                recorder.look(number, picture, step.box)
    except DataError as error:
        return failed(task, str(error))
    return Run(
        task.sequence.name,
        task.tracker.label,
        task.seed,
        task.start.name,
        np.array([step.box for step in steps], float),
        np.array([step.ok for step in steps]),
        np.array([step.score for step in steps], float),
        nanoseconds / 1e9,
        recorder.pictures if recorder is not None else (),
    )


def failed(task: Task, reason: str) -> Run:
    """The run of a task that could not be finished."""
    nothing = np.empty(0)
    return Run(
        task.sequence.name,
        task.tracker.label,
        task.seed,
        task.start.name,
        np.empty((0, 4)),
        nothing.astype(bool),
        nothing,
        0.0,
        (),
        reason,
    )
