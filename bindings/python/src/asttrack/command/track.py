"""`track`: follows one object through a video, a directory of pictures or a camera."""

import argparse
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from asttrack import AstError, Box, Result, Status, Tracker
from asttrack.command.arguments import add_preset, add_settings, box, positive
from asttrack.command.speech import say
from asttrack.failures import DataError, SourceError, UsageError
from asttrack.output import replacing

if TYPE_CHECKING:
    from asttrack.frames import Frame
    from asttrack.video import Source, VideoSink

DEFAULT_SEED = 1
COLUMNS = ("frame", "x", "y", "w", "h", "scale", "score", "status")


def add(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the sub-command."""
    parser = commands.add_parser(
        "track",
        help="follow one object through a video",
        description="Follows one object through a video file, a directory of numbered pictures (or its img/), or a camera, "
        "and prints one line on it. An interrupt ends it and keeps what is written.",
    )
    parser.add_argument(
        "source", metavar="VIDEO|DIR|CAMERA", help="a file that OpenCV reads, a directory, the number of a camera or its device"
    )
    start = parser.add_mutually_exclusive_group()
    start.add_argument(
        "--box",
        type=box,
        metavar="X,Y,W,H",
        help="the object in the first frame, pixels, 0-based top-left corner "
        "(default: the first line of the directory's groundtruth.txt)",
    )
    start.add_argument("--select", action="store_true", help="draw the box with the mouse on the first frame")
    add_preset(parser)
    add_settings(parser)
    parser.add_argument("--frames", type=positive, metavar="N", help="stop after so many frames")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write an annotated video: .mp4, .avi or .mkv")
    parser.add_argument("--particles", action="store_true", help="draw the particles into it, too")
    parser.add_argument("--csv", type=Path, metavar="FILE", help=f"write the track: {','.join(COLUMNS)}")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Does it; the exit code."""
    from asttrack.evaluation.trackers import AsttrackSpec, parse_changes
    from asttrack.opencv import quiet
    from asttrack.video import open_source, require_codec

    quiet()
    changes = parse_changes(arguments.settings)
    tracker = AsttrackSpec("--set", arguments.preset, tuple(changes.items())).make(DEFAULT_SEED).tracker
    if arguments.out is not None:
        require_codec(arguments.out)
    elif arguments.particles:
        raise UsageError("--particles: draws into the video of --out, which is not given")
    return follow(open_source(arguments.source), tracker, arguments)


def follow(source: "Source", tracker: Tracker, arguments: argparse.Namespace) -> int:
    """Tracks to the end of the source, or to an interrupt; the exit code."""
    from asttrack.video import writing_video

    frames = source.frames()
    first = next(frames)
    box = start_box(source, first, arguments)
    try:
        tracker.init(first, box)
    except AstError as error:
        sides = ",".join(f"{side:g}" for side in box)
        raise DataError(f"{source.name}: box {sides} in {first.shape[1]} x {first.shape[0]} pixels: {error}") from error
    with ExitStack() as outputs:
        recorder = Recorder(
            outputs.enter_context(writing_video(arguments.out, source.rate)) if arguments.out is not None else None,
            outputs.enter_context(writing_track(arguments.csv)) if arguments.csv is not None else None,
            tracker if arguments.particles else None,
        )
        recorder.take(first, given(box, tracker))
        whole = steps(source, frames, tracker, recorder, arguments.frames)
    print(f"result name={source.name.replace(' ', '_')} frames={recorder.frames} fps={recorder.rate:.1f} lost={recorder.lost}")
    return 0 if whole else 1


def start_box(source: "Source", first: "Frame", arguments: argparse.Namespace) -> Box:
    """The box that the user gave or draws now, or else the source's own."""
    if arguments.select:
        return select(first)
    chosen = arguments.box or source.first_box
    if chosen is None:
        raise UsageError(f"{arguments.source}: say where the object is with --box X,Y,W,H or --select")
    return Box(*chosen)


def given(box: Box, tracker: Tracker) -> Result:
    """What the frame whose box is given gets in the track."""
    return Result(box, 1.0, 1.0, Status.TRACKING, 0.0, float(len(tracker.particles.x)), 0, 0)


def steps(source: "Source", frames: "Iterator[Frame]", tracker: Tracker, recorder: "Recorder", limit: int | None) -> bool:
    """Tracks the frames after the first. False when the source failed before its end: what was tracked is good all the same."""
    from asttrack.progress import shown

    rest = islice(frames, None if limit is None else limit - 1)
    total = min(filter(None, (source.count, limit)), default=None)
    try:
        for frame in shown(rest, None if total is None else total - 1, "frame", pause=0.1):
            before = time.perf_counter()
            result = tracker.update(frame)
            recorder.seconds += time.perf_counter() - before
            recorder.take(frame, result)
    except KeyboardInterrupt:
        say(f"interrupted after {recorder.frames} frames, which are kept")
    except SourceError as error:
        say(f"{error}; the {recorder.frames} frames before it are kept")
        return False
    return True


class Recorder:
    """Takes the tracked frames to where they are wanted."""

    def __init__(self, video: "VideoSink | None", table: "TextIO | None", inside: Tracker | None) -> None:
        self._video = video
        self._table = table
        self._inside = inside
        self.frames = 0
        self.lost = 0
        self.seconds = 0.0

    @property
    def rate(self) -> float:
        """Updates a second."""
        return (self.frames - 1) / self.seconds if self.seconds > 0 else float("nan")

    def take(self, frame: "Frame", result: Result) -> None:
        """Counts and writes a frame."""
        from asttrack.drawing import draw_track

        self.frames += 1
        self.lost += result.status is Status.LOST
        if self._table is not None:
            sides = ",".join(f"{side:.4f}" for side in result.box)
            self._table.write(f"{self.frames},{sides},{result.scale:.6f},{result.score:.6f},{result.status.name.lower()}\n")
        if self._video is not None:
            self._video.write(draw_track(frame, result, self._inside.particles if self._inside is not None else None))


@contextmanager
def writing_track(target: Path) -> "Iterator[TextIO]":
    """A CSV of the track, under a temporary name until it is whole."""
    with replacing(target) as path, path.open("w", encoding="ascii", newline="") as stream:
        stream.write(f"{','.join(COLUMNS)}\n")
        yield stream


def select(first: "Frame") -> Box:
    """Lets the user draw the box. Raises DataError where OpenCV has no windows, or nothing was drawn."""
    import cv2

    title = "Draw the box, then press Enter"
    try:
        sides = cv2.selectROI(title, first, showCrosshair=False, printNotice=False)
        cv2.destroyWindow(title)
    except cv2.error as error:
        raise DataError(
            "--select: this OpenCV opens no windows: give --box X,Y,W,H, or replace the package opencv-contrib-python-headless "
            "by opencv-contrib-python on a machine with a display"
        ) from error
    if min(sides[2:]) < 1:
        raise DataError("--select: no box was drawn")
    return Box(*map(float, sides))
