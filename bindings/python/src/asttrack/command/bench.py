"""`bench`: how fast, and why."""

import argparse
import json
from pathlib import Path
from typing import Any

from asttrack.command.arguments import add_preset, positive
from asttrack.command.speech import say
from asttrack.failures import DataError, MissingExtraError

TRACKERS = "asttrack:robust,asttrack:paper,asttrack:tiny,csrt,kcf,mil,medianflow,mosse"


def add(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the sub-command."""
    parser = commands.add_parser(
        "bench",
        help="measure speed",
        description="Times each stage, update by literal and by gram scoring, its growth with particles, patch, bag and history, "
        "and OpenCV's trackers on the same frames; all on one thread, each library and tracker in a process of its own.",
    )
    add_preset(parser)
    parser.add_argument(
        "--library",
        metavar="FILE",
        type=Path,
        action="append",
        default=[],
        help="a libasttrack.so to measure, such as one with another backend; may be repeated (default: the package's)",
    )
    parser.add_argument("--sequence", metavar="DIR", type=Path, help="take its frames instead of the synthetic scene's")
    parser.add_argument("--frames", type=positive, default=60, help="frames that are tracked forth and back (default: %(default)s)")
    parser.add_argument(
        "--seconds", type=seconds, default=0.5, help="processor time to spend on each figure (default: %(default)s)"
    )
    parser.add_argument("--trackers", metavar="LIST", default=TRACKERS, help="as for eval; may be empty (default: %(default)s)")
    parser.add_argument("--out", metavar="FILE", type=Path, help="write all figures as JSON")
    parser.set_defaults(run=run)


def seconds(text: str) -> float:
    """A time of more than nothing."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0 < number <= 3600:
        raise argparse.ArgumentTypeError(f"{text}: not a number of seconds above 0")
    return number


def run(arguments: argparse.Namespace) -> int:
    """Does it; the exit code."""
    from asttrack.bench import libraries_or_own, measure, orders, stages_table, sweeps_table, trackers_table
    from asttrack.evaluation.conditions import conditions
    from asttrack.evaluation.trackers import parse_trackers
    from asttrack.opencv import quiet
    from asttrack.output import write_text
    from asttrack.progress import shown

    quiet()
    specs = parse_trackers(arguments.trackers, arguments.preset) if arguments.trackers.strip() else []
    problems = []
    labels = []
    for spec in specs:
        try:
            spec.check()
            labels.append(spec.label)
        except MissingExtraError as error:
            problems.append(str(error))
    facts = conditions(jobs=1)
    common = {
        "preset": arguments.preset,
        "sequence": str(arguments.sequence) if arguments.sequence is not None else None,
        "frames": max(2, arguments.frames),
        "seconds": arguments.seconds,
    }
    libraries: list[dict[str, Any]] = []
    trackers: list[dict[str, Any]] = []
    planned = orders(libraries_or_own(arguments.library), labels, common)
    for _, library, order in shown(planned, len(planned), "process"):
        try:
            outcome = measure(library, order)
        except DataError as error:
            problems.append(str(error))
            continue
        (trackers if "tracker" in order else libraries).append(outcome)
    for problem in problems:
        say(problem)
    if libraries:
        print(stages_table(libraries), sweeps_table(libraries), sep="\n\n")
    if trackers:
        print("", trackers_table(trackers), sep="\n")
    if arguments.out is not None and (libraries or trackers):
        figures = {"conditions": facts.as_dict(), "order": common, "libraries": libraries, "trackers": trackers}
        write_text(arguments.out, json.dumps(figures, indent=1) + "\n")
    return int(bool(problems))
