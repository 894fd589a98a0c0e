"""Everything that an evaluation found out, as the tables, the files and the report take it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from asttrack.evaluation.conditions import Conditions
from asttrack.evaluation.metrics import Accuracy, Floats, accuracy, centre_errors, overlaps
from asttrack.evaluation.protocol import ONE_PASS, Run
from asttrack.evaluation.sequence import Sequence
from asttrack.evaluation.trackers import TrackerSpec


@dataclass(frozen=True, eq=False)
class Measured:
    """A finished run against the ground truth of its sequence.

    Attributes:
        run: the run.
        errors: (frames,) centre errors, nan without ground truth.
        shares: (frames,) overlaps, nan without ground truth.
        absent: (frames,) whether nothing of the object is in view.
        accuracy: the figures.
    """

    run: Run
    errors: Floats
    shares: Floats
    absent: NDArray[np.bool_]
    accuracy: Accuracy

    @property
    def rate(self) -> float:
        """Updates a second of processor time."""
        return self.run.updates / self.run.seconds if self.run.seconds > 0 else float("nan")


def measure(run: Run, sequence: Sequence) -> Measured:
    """Compares a finished run with its sequence."""
    return Measured(
        run,
        centre_errors(run.boxes, sequence.truth),
        overlaps(run.boxes, sequence.truth),
        sequence.absent,
        accuracy(run.boxes, sequence.truth, run.ok),
    )


@dataclass
class Evaluation:
    """An evaluation, complete or as far as it came.

    Attributes:
        sequences: what was tracked.
        trackers: by what.
        conditions: where and how.
        runs: the finished runs, in the order of the plan.
        failures: one line for each run that could not be finished, or sequence or tracker that could not be used.
        planned: runs that there were to be; more than there are when it was interrupted.
    """

    sequences: list[Sequence]
    trackers: list[TrackerSpec]
    conditions: Conditions
    runs: list[Measured] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    planned: int = 0

    @property
    def notes(self) -> list[str]:
        """What a reader of the figures must know, one line each."""
        notes = [note for sequence in self.sequences for note in sequence.notes]
        missing = self.planned - len(self.runs)
        if missing:
            notes.append(f"incomplete: {missing} of {self.planned} runs are missing")
        return notes + self.failures

    @property
    def labels(self) -> list[str]:
        """The trackers' names."""
        return [tracker.label for tracker in self.trackers]

    def one_pass(self, tracker: str, sequence: str | None = None) -> list[Measured]:
        """The runs of a tracker from the annotated first box, on one sequence or on all."""
        return [m for m in self._of(tracker, sequence) if m.run.start == ONE_PASS.name]

    def spatial(self, tracker: str, sequence: str | None = None) -> list[Measured]:
        """The runs of a tracker from the shifted and scaled first boxes, on one sequence or on all."""
        return [m for m in self._of(tracker, sequence) if m.run.start != ONE_PASS.name]

    def first(self, tracker: str, sequence: str) -> Measured | None:
        """The one-pass run with the first seed: what pictures show."""
        return next((m for m in self.one_pass(tracker, sequence) if m.run.seed == 1), None)

    def _of(self, tracker: str, sequence: str | None) -> list[Measured]:
        return [m for m in self.runs if m.run.tracker == tracker and sequence in (None, m.run.sequence)]

    def settle(self) -> None:
        """Puts the runs, which arrive as they are done, into the order of sequences, trackers, first boxes and seeds."""
        sequences = [sequence.name for sequence in self.sequences]
        labels = self.labels
        self.runs.sort(
            key=lambda m: (sequences.index(m.run.sequence), labels.index(m.run.tracker), m.run.start != ONE_PASS.name, m.run.seed)
        )
        self.failures.sort()


def mean_curve(curves: list[Floats]) -> Floats | None:
    """The mean of curves over the same thresholds; None of none."""
    known = [curve for curve in curves if not np.isnan(curve).any()]
    return np.mean(known, axis=0) if known else None
