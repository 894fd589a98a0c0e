"""Tracks an object through a directory of PGM frames with nothing but numpy, and prints its boxes as CSV.

    python track_pgm.py FRAMES [--box x,y,w,h]

Without --box, the first line of FRAMES/groundtruth.txt is the box. `asttrack synth DIR` (the C command) renders such a directory.
"""

import argparse
import re
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import asttrack
from asttrack.natural_order import natural_key

# Magic, width, height and greatest value, between white space and comments; the pixels follow one white space later.
HEADER = re.compile(rb"P5" + 3 * rb"(?:\s|#[^\n]*\n)+(\d+)" + rb"\s")


def read_pgm(path: Path) -> NDArray[np.uint8]:
    """The pixels of a binary 8-bit PGM file. Raises ValueError for anything else."""
    data = path.read_bytes()
    header = HEADER.match(data)
    if header is None or not 0 < int(header[3]) <= 255:
        raise ValueError(f"{path}: not a binary 8-bit PGM file")
    width, height = int(header[1]), int(header[2])
    if len(data) - header.end() < width * height:
        raise ValueError(f"{path}: truncated: {len(data) - header.end()} of {width * height} pixels")
    return np.frombuffer(data, np.uint8, width * height, header.end()).reshape(height, width)


def four_numbers(text: str) -> asttrack.Box:
    """A box from `x,y,w,h`."""
    x, y, w, h = map(float, text.split(","))
    return asttrack.Box(x, y, w, h)


def track(frames: Path, box: asttrack.Box | None) -> None:
    """Prints a line for each frame."""
    # 10.pgm comes after 9.pgm.
    files = sorted(list(frames.glob("*.pgm")) or frames.glob("img/*.pgm"), key=lambda path: natural_key(path.name))
    if not files:
        raise ValueError(f"{frames}: no PGM frames in it")
    if box is None:
        truth = frames / "groundtruth.txt"
        try:
            box = four_numbers(truth.read_text(encoding="ascii").split("\n", 1)[0])
        except (OSError, ValueError) as error:
            raise ValueError(f"{truth}: no box in its first line: {error}") from None

    print("frame,x,y,w,h,score,status")
    with asttrack.Tracker() as tracker:
        tracker.init(read_pgm(files[0]), box)
        for file in files[1:]:
            result = tracker.update(read_pgm(file))
            sides = ",".join(f"{side:.2f}" for side in result.box)
            print(f"{file.stem},{sides},{result.score:.3f},{result.status.name}")


def main() -> int:
    """Reads the command line; 1 when the data will not do, 2 when the command line will not."""
    parser = argparse.ArgumentParser(description="Track an object through PGM frames, print its boxes as CSV.")
    parser.add_argument("frames", type=Path, help="directory of .pgm files, or with img/*.pgm in it")
    parser.add_argument("--box", type=four_numbers, metavar="x,y,w,h", help="where the object is in the first frame")
    arguments = parser.parse_args()
    try:
        track(arguments.frames, arguments.box)
    except (OSError, ValueError, asttrack.AstError) as error:
        print(f"track_pgm: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
