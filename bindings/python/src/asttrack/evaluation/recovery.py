"""Whether trackers find an object again: scenes in which it is hidden, leaves the view, or another scene is shown for a while.

The scenes are rendered by the C command, `asttrack synth`, which labels the frames in which nothing of the object is in view.
"""

import shutil
import subprocess
import tempfile
from collections.abc import Callable, Generator, Iterable
from collections.abc import Sequence as Many
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from asttrack.evaluation.confidence import Bools, Judged, confidence, judge, pool
from asttrack.evaluation.metrics import Floats
from asttrack.evaluation.processes import run_each
from asttrack.evaluation.protocol import Run, Task, run
from asttrack.evaluation.results import Measured, measure
from asttrack.evaluation.sequence import Sequence, read_sequence
from asttrack.evaluation.trackers import TrackerSpec
from asttrack.failures import DataError, UsageError

KINDS = ("occlusion", "leave", "cut")
LOOK_ALIKE = "look-alike"
"""Behind an event: a twin of the object crosses the scene, too, and may be there first."""
WITHIN = 15
"""Frames in which the object should be found, the first one in which it is back included."""
ON_IT = 0.5
"""Overlap of a box that is on the object."""
HOLD = 5
"""Frames in a row that make a find: an object that passes a box that waits is none."""
BEFORE = 10
"""Frames before the event in one of which a tracker must be on the object to have something to lose."""
_WIDTH, _HEIGHT = 320, 240  # of a frame, pixels
_SCRIPT = 200  # frames of a scene without its event

Progress = Callable[[Iterable["Recovery"], int], Iterable["Recovery"]]


@dataclass(frozen=True)
class Event:
    """What happens in a scene.

    Attributes:
        kind: one of KINDS.
        frames: how long nothing of the object is in view.
        met: whether the object's look-alike crosses the scene afterwards, at the place where a tracker may search.
    """

    kind: str
    frames: int
    met: bool = False

    @property
    def name(self) -> str:
        """In tables, and how it is given."""
        return f"{self.kind}:{self.frames}" + (f":{LOOK_ALIKE}" if self.met else "")


def parse_events(text: str) -> list[Event]:
    """The events of a list `occlusion:50,leave:20`. Raises UsageError."""
    events = []
    for word in text.split(","):
        kind, _, rest = word.strip().partition(":")
        frames, _, company = rest.partition(":")
        if kind not in KINDS or not frames.isdecimal() or int(frames) < 1 or (":" in rest and company != LOOK_ALIKE):
            known = ", ".join(f"{kind}:FRAMES" for kind in KINDS)
            raise UsageError(f"{word.strip()}: not an event: {known}, with :{LOOK_ALIKE} behind it or not")
        events.append(Event(kind, int(frames), company == LOOK_ALIKE))
    if len(set(events)) < len(events):
        raise UsageError(f"{text}: an event is given twice")
    return events


@dataclass(frozen=True, eq=False)
class Recovery:
    """How a tracker came through one scene.

    Attributes:
        event: what happened.
        scene: seed of the scene, and of the tracker's random numbers.
        tracker: label.
        held: whether it was on the object before.
        noticed: whether it said lost while nothing of the object was in view.
        took: frames until it was on the object again, 1 when it was at once; nan when it never was.
        judged: its frames, right and wrong.
        error: why the run failed; None when it did not.
    """

    event: Event
    scene: int
    tracker: str
    held: bool
    noticed: bool
    took: float
    judged: Judged | None
    error: str | None = None

    @property
    def recovered(self) -> bool:
        """Whether it was on the object again soon enough."""
        return self.took <= WITHIN


def half_inside(truth: Floats, width: int, height: int) -> Bools:
    """The frames in which at least half of the object's box lies in the frame; false where there is no box."""
    x, y, w, h = truth.T
    across = np.minimum(x + w, width) - np.maximum(x, 0)
    down = np.minimum(y + h, height) - np.maximum(y, 0)
    return np.asarray(np.maximum(across, 0) * np.maximum(down, 0) >= 0.5 * w * h)


def frames_to_recover(on_it: Bools, back: int) -> float:
    """Frames from the object's return to the first of HOLD in a row that are on it, that one included; nan when there is none."""
    for start in range(back, len(on_it) - HOLD + 1):
        if on_it[start : start + HOLD].all():
            return float(start - back + 1)
    return float("nan")


def examine(measured: Measured, sequence: Sequence, event: Event, scene: int) -> Recovery:
    """How a finished run came through its scene. Raises DataError where the object does not vanish and come back."""
    absent = sequence.absent
    in_view = half_inside(sequence.truth, _WIDTH, _HEIGHT) & ~absent
    gone = np.flatnonzero(absent)
    returned = np.flatnonzero(in_view[gone[-1] :]) if len(gone) else gone
    if not len(returned):
        raise DataError(f"{sequence.directory}: the object does not vanish and come back")
    on_it = np.nan_to_num(measured.shares) >= ON_IT
    before = np.flatnonzero(in_view[: gone[0]])[-BEFORE:]
    return Recovery(
        event,
        scene,
        measured.run.tracker,
        held=bool(on_it[before].any()),
        noticed=bool((~measured.run.ok[gone]).any()),
        took=frames_to_recover(on_it, int(gone[-1] + returned[0])),
        judged=judge(measured),
    )


def find_command(given: Path | None) -> Path:
    """The C command that renders: the given one, that of the build directory here, or an installed one. Raises UsageError."""
    installed = shutil.which("asttrack")
    places = [given] if given is not None else [Path("build/asttrack"), *([Path(installed)] if installed else [])]
    for place in places:
        if place.is_file():
            return place.resolve()
    raise UsageError(f"{places[0]}: no such file: `make` builds the command asttrack, which renders; name it with --synth")


def render(command: Path, directory: Path, event: Event, scene: int) -> Sequence:
    """Renders a scene with an event. Raises DataError."""
    options = {"frames": _SCRIPT + event.frames, "seed": scene, "size": f"{_WIDTH}x{_HEIGHT}", "occlusion": 0}
    options[event.kind] = event.frames
    words = [word for name, value in options.items() for word in (f"--{name}", str(value))]
    whole: list[str | Path] = [command, "synth", directory, *words, *([] if event.met else ["--alone"])]
    done = subprocess.run(whole, capture_output=True, text=True, check=False)  # noqa: S603  # what the user named
    if done.returncode != 0:
        raise DataError(done.stderr.strip() or f"{command}: ended with status {done.returncode}")
    return read_sequence(directory)


def recover(
    command: Path, events: Many[Event], scenes: int, trackers: Many[TrackerSpec], jobs: int, progress: Progress
) -> tuple[list[Recovery], bool]:
    """Runs every tracker through every event in so many scenes; scene and tracker have the same seed.

    Returns:
        The recoveries in the order of events, trackers and scenes, and whether an interrupt ended it early. Raises DataError.
    """
    found: list[Recovery] = []
    coming = _recoveries(command, [(event, scene) for event in events for scene in range(1, scenes + 1)], trackers, jobs)
    interrupted = False
    try:
        with closing(coming):
            found.extend(progress(coming, len(events) * scenes * len(trackers)))
    except KeyboardInterrupt:
        interrupted = True
    labels = [tracker.label for tracker in trackers]
    found.sort(key=lambda one: (events.index(one.event), labels.index(one.tracker), one.scene))
    return found, interrupted


def _recoveries(
    command: Path, scenes: list[tuple[Event, int]], trackers: Many[TrackerSpec], jobs: int
) -> Generator[Recovery, None, None]:
    """A few scenes at a time, since all of them would fill a disk."""
    for first in range(0, len(scenes), jobs):
        batch = scenes[first : first + jobs]
        with tempfile.TemporaryDirectory(prefix="asttrack-") as place, ThreadPoolExecutor(jobs) as pool:
            directories = [Path(place, str(number)) for number in range(len(batch))]
            sequences = list(pool.map(lambda pair: render(command, pair[0], *pair[1]), zip(directories, batch, strict=True)))
            known = {id(sequence): pair for sequence, pair in zip(sequences, batch, strict=True)}
            tasks = [
                Task(sequence, tracker, scene)
                for sequence, (_, scene) in zip(sequences, batch, strict=True)
                for tracker in trackers
            ]
            with closing(run_each(run, tasks, jobs, preload=["asttrack.evaluation.protocol"])) as outcomes:
                for task, outcome in outcomes:
                    yield _recovery(task, outcome, *known[id(task.sequence)])


def _recovery(task: Task, outcome: Run | Exception, event: Event, scene: int) -> Recovery:
    reason = outcome.error if isinstance(outcome, Run) else f"{type(outcome).__name__}: {outcome}"
    if not isinstance(outcome, Run) or reason is not None:
        return Recovery(event, scene, task.tracker.label, False, False, float("nan"), None, reason)
    return examine(measure(outcome, task.sequence), task.sequence, event, scene)


@dataclass(frozen=True)
class Summary:
    """The recoveries of a tracker from one event.

    Attributes:
        event: what happened.
        tracker: label.
        runs: scenes.
        held: of them, those in which the tracker was on the object before.
        noticed: those in which it said lost while the object was away.
        recovered: those in which it was on the object again within WITHIN frames.
        ever: those in which it was on it again before the end.
        took: median frames of those; nan of none.
    """

    event: Event
    tracker: str
    runs: int
    held: int
    noticed: int
    recovered: int
    ever: int
    took: float


def summaries(found: Iterable[Recovery]) -> list[Summary]:
    """By event and tracker, in the order of the recoveries; a run that failed has not recovered."""
    groups: dict[tuple[Event, str], list[Recovery]] = {}
    for one in found:
        groups.setdefault((one.event, one.tracker), []).append(one)
    lines = []
    for (event, tracker), group in groups.items():
        took = [one.took for one in group if not np.isnan(one.took)]
        lines.append(
            Summary(
                event,
                tracker,
                runs=len(group),
                held=sum(one.held for one in group),
                noticed=sum(one.noticed for one in group),
                recovered=sum(one.recovered for one in group),
                ever=len(took),
                took=float(np.median(took)) if took else float("nan"),
            )
        )
    return lines


def confidences(found: Iterable[Recovery]) -> dict[str, dict[str, float]]:
    """How well each tracker knows when it is wrong, over the frames of all its runs."""
    groups: dict[str, list[Judged]] = {}
    for one in found:
        if one.judged is not None:
            groups.setdefault(one.tracker, []).append(one.judged)
    return {tracker: confidence(pool(parts)) for tracker, parts in groups.items()}
