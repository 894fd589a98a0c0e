"""`bench`: how fast, and why."""

import argparse
import json
from pathlib import Path
from typing import Any

from asttrack.command.arguments import add_preset, positive
from asttrack.command.speech import say
from asttrack.failures import DataError, MissingExtraError, UsageError
from asttrack.json_file import read_figures

_PARTS = ("conditions", "libraries", "races", "core")

TRACKERS = "asttrack:robust,asttrack:paper,asttrack:tiny,csrt,kcf,mil,medianflow,mosse,tld,boosting"


def add(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the sub-command."""
    parser = commands.add_parser(
        "bench",
        help="measure speed",
        description="Times each stage, update by literal and by gram scoring, its growth with particles, patch, bag and history, "
        "all on one thread, each library in a process of its own; and sets the presets beside OpenCV's trackers, which take turns "
        "on the same frames.",
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
    parser.add_argument(
        "--sequence",
        metavar="DIR",
        type=Path,
        action="append",
        default=[],
        help="take its frames instead of the synthetic scene's; may be repeated: each has a race, the first one the stages",
    )
    parser.add_argument("--frames", type=positive, default=60, help="frames that are tracked (default: %(default)s)")
    parser.add_argument(
        "--seconds", type=seconds, default=0.5, help="processor time to spend on each figure of a library (default: %(default)s)"
    )
    parser.add_argument("--trackers", metavar="LIST", default=TRACKERS, help="as for eval; may be empty (default: %(default)s)")
    parser.add_argument("--passes", type=positive, default=3, help="over the frames, for each tracker (default: %(default)s)")
    parser.add_argument("--core", metavar="FILE", type=Path, help="figures that `make bench` wrote, to show and keep with these")
    parser.add_argument("--only-trackers", action="store_true", help="leave out the stages and the growth of the libraries")
    parser.add_argument("--read", metavar="FILE", type=Path, help="measure nothing: take the figures that --out wrote")
    parser.add_argument("--out", metavar="FILE", type=Path, help="write all figures as JSON")
    parser.add_argument(
        "--markdown",
        metavar="FILE",
        type=Path,
        help="replace the tables between the marks of this document, such as performance.md",
    )
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
    from asttrack.core_bench import core_table, read_core
    from asttrack.output import write_text
    from asttrack.performance import put_into

    problems: list[str] = []
    core = read_core(arguments.core) if arguments.core is not None else None
    figures = read_figures(arguments.read, _PARTS, "bench --out") if arguments.read is not None else _measured(arguments, problems)
    if core is not None:
        figures["core"] = core
    for problem in problems:
        say(problem)
    _print(figures)
    if figures["core"] is not None:
        print("", core_table(figures["core"]), sep="\n")
    if figures["libraries"] or figures["races"] or arguments.read is not None:
        if arguments.out is not None:
            write_text(arguments.out, json.dumps(figures, indent=1) + "\n")
        if arguments.markdown is not None:
            put_into(arguments.markdown, figures)
    return int(bool(problems))


def _measured(arguments: argparse.Namespace, problems: list[str]) -> dict[str, Any]:
    """Measures what is asked for; what cannot be done is a line more in `problems`."""
    from asttrack.bench import libraries_or_own, measure
    from asttrack.evaluation.conditions import conditions
    from asttrack.evaluation.trackers import AsttrackSpec, parse_trackers
    from asttrack.opencv import quiet
    from asttrack.progress import shown
    from asttrack.race import run as race

    quiet()
    if arguments.only_trackers and not arguments.trackers.strip():
        raise UsageError("--only-trackers: there are none in --trackers")
    specs = parse_trackers(arguments.trackers, arguments.preset) if arguments.trackers.strip() else []
    libraries = libraries_or_own(arguments.library)
    sequences: list[Path | None] = arguments.sequence or [None]
    frames = max(2, arguments.frames)
    order = {
        "preset": arguments.preset,
        "sequence": str(sequences[0]) if sequences[0] is not None else None,
        "frames": frames,
        "seconds": arguments.seconds,
    }
    figures: dict[str, Any] = {
        "conditions": conditions(jobs=1).as_dict(),
        "order": order,
        "libraries": [],
        "races": [],
        "core": None,
    }
    wanted = [] if arguments.only_trackers else libraries
    for library in shown(wanted, len(wanted), "library"):
        try:
            figures["libraries"].append(measure(library, order))
        except DataError as error:
            problems.append(str(error))
    entries: list[tuple[Path, str]] = []
    for spec in specs:
        try:
            spec.check()
        except MissingExtraError as error:
            problems.append(str(error))
            continue
        entries += [(library, spec.label) for library in (libraries if isinstance(spec, AsttrackSpec) else libraries[:1])]
    for sequence in sequences if entries else []:
        found, failures = race(
            entries, arguments.preset, sequence, frames, arguments.passes, lambda items, total: shown(items, total, "pass")
        )
        problems += failures
        figures["races"] += [found] if found is not None else []
    return figures


def _print(figures: dict[str, Any]) -> None:
    from asttrack.bench import stages_table, sweeps_table
    from asttrack.race import table

    blocks = []
    if figures["libraries"]:
        blocks += [stages_table(figures["libraries"]), sweeps_table(figures["libraries"])]
    blocks += map(table, figures["races"])
    print("\n\n".join(blocks))
