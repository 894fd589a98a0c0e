"""`recovery`: does a tracker find its object again?"""

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from asttrack.command.arguments import add_preset, positive
from asttrack.command.speech import say
from asttrack.failures import DataError

if TYPE_CHECKING:
    from asttrack.evaluation.recovery import Recovery

INTERRUPTED = 130
EVENTS = "occlusion:5,occlusion:10,occlusion:20,occlusion:50,occlusion:100,leave:10,leave:50,cut:5,cut:50,occlusion:50:look-alike"


def add(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the sub-command."""
    parser = commands.add_parser(
        "recovery",
        help="does a tracker find its object again?",
        description="Renders scenes in which the object is hidden, leaves the view, or another scene is shown for a while, and "
        "counts how often each tracker is on the object again soon. Needs the C command, which renders.",
    )
    parser.add_argument("--trackers", metavar="LIST", default="asttrack", help="as for eval (default: %(default)s)")
    add_preset(parser)
    parser.add_argument("--events", metavar="LIST", default=EVENTS, help="kinds and frames (default: %(default)s)")
    parser.add_argument("--scenes", type=positive, default=10, help="of each event, seeds 1 and on (default: %(default)s)")
    parser.add_argument("--jobs", type=positive, default=1, help="processes at a time (default: %(default)s)")
    parser.add_argument("--synth", metavar="FILE", type=Path, help="the C command (default: build/asttrack, or the installed one)")
    parser.add_argument("--out", metavar="DIR", type=Path, help="where to write recovery.csv and recovery.md")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Does it; the exit code."""
    from asttrack.command.evaluate import usable
    from asttrack.evaluation.recovery import find_command, parse_events, recover
    from asttrack.evaluation.trackers import parse_trackers
    from asttrack.opencv import quiet
    from asttrack.output import make_directory
    from asttrack.progress import shown

    quiet()
    events, command = parse_events(arguments.events), find_command(arguments.synth)
    trackers, problems = usable(parse_trackers(arguments.trackers, arguments.preset))
    for problem in problems:
        say(problem)
    if not trackers:
        raise DataError("nothing to evaluate")
    if arguments.out is not None:
        make_directory(arguments.out)
    found, interrupted = recover(command, events, arguments.scenes, trackers, arguments.jobs, partial(shown, unit="run"))
    failures = [f"{one.event.name}, scene {one.scene}, {one.tracker}: {one.error}" for one in found if one.error is not None]
    for failure in failures:
        say(failure)
    planned = len(events) * arguments.scenes * len(trackers)
    if interrupted:
        say(f"interrupted: {len(found)} of {planned} runs are finished and kept")
    notes = problems + failures + ([f"incomplete: {planned - len(found)} of {planned} runs are missing"] if interrupted else [])
    if found:
        publish(found, notes, arguments.jobs, arguments.out)
    return INTERRUPTED if interrupted else int(bool(problems or failures))


def publish(found: "list[Recovery]", notes: list[str], jobs: int, directory: Path | None) -> None:
    """Prints the tables and writes the files. Raises DataError."""
    from asttrack.evaluation.conditions import conditions
    from asttrack.evaluation.store import RECOVERY_COLUMNS, csv_text, markdown_text, recovery_line
    from asttrack.evaluation.tables import align, recovery_tables
    from asttrack.output import write_text

    tables = recovery_tables(found)
    print("\n\n".join(f"{title}\n\n{align(lines)}" for title, lines in tables))
    if directory is not None:
        paths = [directory / "recovery.csv", directory / "recovery.md"]
        write_text(paths[0], csv_text(RECOVERY_COLUMNS, map(recovery_line, found)))
        write_text(paths[1], markdown_text(conditions(jobs), notes, tables))
        print(f"\nwritten: {', '.join(map(str, paths))}")
