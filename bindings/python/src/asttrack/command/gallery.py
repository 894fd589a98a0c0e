"""`gallery`: pictures of what the tracker does, from the synthetic scene."""

import argparse
from functools import partial
from pathlib import Path

from asttrack.command.arguments import positive

SHORTEST = 80  # frames: the pictures show the particles of frame 75


def add(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the sub-command."""
    parser = commands.add_parser(
        "gallery",
        help="draw what the tracker does, on a synthetic scene",
        description="Tracks a scene made from a seed with every preset and draws film strip, particles, bag of models and curves.",
    )
    parser.add_argument(
        "directory", metavar="OUTDIR", type=Path, help="where to write the pictures and a README.md that shows them"
    )
    parser.add_argument("--frames", type=positive, default=150, help="of the scene (default: %(default)s)")
    parser.add_argument("--seed", type=positive, default=1, help="of the scene (default: %(default)s)")
    parser.add_argument("--jobs", type=positive, default=1, help="processes at a time (default: %(default)s)")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Does it; the exit code."""
    from asttrack.failures import UsageError
    from asttrack.gallery import make
    from asttrack.opencv import quiet
    from asttrack.progress import shown
    from asttrack.scene import Scene

    quiet()
    if arguments.frames < SHORTEST:
        raise UsageError(f"--frames: at least {SHORTEST}")
    scene = Scene(frames=arguments.frames, seed=arguments.seed)
    paths = make(arguments.directory, scene, arguments.jobs, partial(shown, unit="run"))
    print(f"written: {', '.join(map(str, paths))}")
    return 0
