"""Tracks an object through a video file or a camera's pictures with OpenCV, shows it or writes an annotated video.

    python track_video.py VIDEO --box x,y,w,h --out annotated.mp4
    python track_video.py 0 --select --show              (camera 0; Ctrl-C or q ends it)

Windows (--select, --show) need an OpenCV that has them: `pip install opencv-python` instead of a headless one.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

import asttrack

Frame = NDArray[np.uint8]
COLOURS = {  # BGR
    asttrack.Status.TRACKING: (80, 200, 80),
    asttrack.Status.UNCERTAIN: (60, 200, 230),
    asttrack.Status.LOST: (60, 60, 220),
}
TITLE = "asttrack"


def open_source(source: str) -> cv2.VideoCapture:
    """A camera by its number, or a video file."""
    capture = cv2.VideoCapture(int(source)) if source.isdigit() else cv2.VideoCapture(source)
    if not capture.isOpened():
        raise ValueError(f"{source}: not a video or camera that OpenCV can read")
    return capture


def open_window() -> None:
    """The window of --select and --show."""
    try:
        cv2.namedWindow(TITLE)
    except cv2.error:
        raise ValueError("this OpenCV has no windows: install opencv-python instead of a headless one") from None


def draw(frame: Frame, result: asttrack.Result) -> Frame:
    """A copy of the frame with the box and the status on it."""
    picture = frame.copy()
    x, y, w, h = (round(side) for side in result.box)
    cv2.rectangle(picture, (x, y), (x + w, y + h), COLOURS[result.status], 2)
    text = f"{result.status.name.lower()} {result.score:.2f}"
    cv2.putText(picture, text, (x, max(y - 6, 12)), cv2.FONT_HERSHEY_SIMPLEX, 0.5, COLOURS[result.status], 1, cv2.LINE_AA)
    return picture


def show(picture: Frame) -> bool:
    """Shows a picture in the window; False when the user pressed q."""
    cv2.imshow(TITLE, picture)
    return cv2.waitKey(1) & 0xFF != ord("q")


def track(capture: cv2.VideoCapture, box: tuple[float, ...] | None, use: Callable[[Frame], bool]) -> None:
    """Tracks until the pictures end, the user interrupts, or `use`, which gets the annotated pictures, wants no more."""
    ok, image = capture.read()
    if not ok:
        raise ValueError("the source has no pictures")
    tracker = asttrack.Tracker()
    tracker.init(image.astype(np.uint8, copy=False), box or cv2.selectROI(TITLE, image))
    while True:
        ok, image = capture.read()
        if not ok:
            return
        frame = image.astype(np.uint8, copy=False)
        result = tracker.update(frame)
        print(result.frame, *(f"{side:.1f}" for side in result.box), f"{result.score:.2f}", result.status.name)
        if not use(draw(frame, result)):
            return


def write_video(path: Path, capture: cv2.VideoCapture, box: tuple[float, ...] | None, also: Callable[[Frame], bool]) -> None:
    """Tracks into an MP4 file, which appears under its name when it is whole."""
    size = (int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)), int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT)))
    part = path.with_name(f"{path.stem}.part.mp4")
    writer = cv2.VideoWriter(str(part), cv2.VideoWriter.fourcc(*"mp4v"), capture.get(cv2.CAP_PROP_FPS) or 25.0, size)
    if not writer.isOpened():
        raise ValueError(f"{path}: cannot be written")

    def use(picture: Frame) -> bool:
        writer.write(picture)
        return also(picture)

    try:
        track(capture, box, use)
    except KeyboardInterrupt:
        pass  # what has been written is a whole video
    except BaseException:
        writer.release()
        part.unlink()
        raise
    writer.release()
    part.replace(path)


def four_numbers(text: str) -> tuple[float, ...]:
    """A box from `x,y,w,h`."""
    x, y, w, h = map(float, text.split(","))
    return x, y, w, h


def main() -> int:
    """Reads the command line; 1 when the data will not do, 2 when the command line will not."""
    parser = argparse.ArgumentParser(description="Track an object through a video or a camera's pictures.")
    parser.add_argument("source", help="video file, or number of a camera")
    where = parser.add_mutually_exclusive_group(required=True)
    where.add_argument("--box", type=four_numbers, metavar="x,y,w,h", help="where the object is in the first picture")
    where.add_argument("--select", action="store_true", help="draw the box with the mouse")
    parser.add_argument("--out", type=Path, metavar="FILE.mp4", help="annotated video to write")
    parser.add_argument("--show", action="store_true", help="show the pictures while tracking")
    arguments = parser.parse_args()
    also: Callable[[Frame], bool] = show if arguments.show else lambda _picture: True
    try:
        capture = open_source(arguments.source)
        if arguments.select or arguments.show:
            open_window()
        if arguments.out is None:
            track(capture, arguments.box, also)
        else:
            write_video(arguments.out, capture, arguments.box, also)
    except KeyboardInterrupt:
        return 0
    except (OSError, ValueError, asttrack.AstError) as error:
        print(f"track_video: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
