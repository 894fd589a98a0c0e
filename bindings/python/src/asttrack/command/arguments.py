"""Arguments that several sub-commands take."""

import argparse
import math
from pathlib import Path

from asttrack.config import PRESETS
from asttrack.result import Box


def add_preset(parser: argparse.ArgumentParser) -> None:
    """--preset."""
    parser.add_argument("--preset", choices=PRESETS, default="robust", help="configuration to start from (default: %(default)s)")


def add_settings(parser: argparse.ArgumentParser) -> None:
    """--set, any number of times."""
    parser.add_argument(
        "--set",
        dest="settings",
        metavar="FIELD=VALUE",
        action="append",
        default=[],
        help="change a configuration field; may be repeated",
    )


def add_sequences(parser: argparse.ArgumentParser) -> None:
    """Directories of sequences."""
    parser.add_argument(
        "sequences",
        metavar="SEQUENCE",
        nargs="+",
        type=Path,
        help="directory with img/ and groundtruth.txt (or groundtruth_rect.txt), or a directory of such",
    )


def positive(text: str) -> int:
    """An integer of at least 1."""
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text}: not a whole number above 0")
    return number


def box(text: str) -> Box:
    """X,Y,W,H."""
    try:
        sides = [float(word) for word in text.split(",")]
    except ValueError:
        sides = []
    if len(sides) != 4 or not all(map(math.isfinite, sides)) or min(sides[2:]) <= 0:
        raise argparse.ArgumentTypeError(f"{text}: not four numbers x,y,w,h with w and h above 0")
    return Box(*sides)
