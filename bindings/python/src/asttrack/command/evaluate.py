"""`eval`: trackers against ground truth."""

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from asttrack.command.arguments import add_preset, add_sequences, positive
from asttrack.command.speech import say
from asttrack.failures import DataError, MissingExtraError, UsageError

if TYPE_CHECKING:
    from asttrack.evaluation.results import Evaluation
    from asttrack.evaluation.trackers import TrackerSpec

INTERRUPTED = 130


def add(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the sub-command."""
    parser = commands.add_parser(
        "eval",
        help="measure trackers against ground truth",
        description="Runs every tracker on every sequence, prints the figures, and writes CSV, JSON and an HTML report. "
        "docs/evaluation.md says what is measured and how.",
    )
    add_sequences(parser)
    add_preset(parser)
    parser.add_argument(
        "--trackers",
        metavar="LIST",
        help="comma-separated: asttrack[:preset][:field=value,...], csrt, kcf, mil, tld, boosting, medianflow, mosse "
        "(default: asttrack)",
    )
    parser.add_argument(
        "--seeds", type=positive, default=5, help="runs of each tracker that draws random numbers (default: %(default)s)"
    )
    parser.add_argument(
        "--jobs", type=positive, default=1, help="processes at a time (default: %(default)s, for rates that can be quoted)"
    )
    parser.add_argument(
        "--sre", action="store_true", help="also from 12 shifted and scaled first boxes (spatial robustness evaluation)"
    )
    parser.add_argument("--ablation", metavar="FILE", type=Path, help="TOML list of variants, each compared with the first one")
    parser.add_argument(
        "--runs",
        metavar="DIR",
        type=Path,
        help="keep each finished run in DIR, and take from it those that are there: an evaluation that was ended goes on",
    )
    parser.add_argument(
        "--out", metavar="DIR", type=Path, help="where to write results.csv, tracks.csv, results.json and report.html"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Does it; the exit code."""
    from asttrack.evaluation.evaluate import evaluate
    from asttrack.evaluation.kept_runs import KeptRuns
    from asttrack.evaluation.sequence import find_sequences
    from asttrack.opencv import quiet
    from asttrack.output import make_directory
    from asttrack.progress import shown

    quiet()
    trackers, problems = usable(requested(arguments))
    sequences, unreadable = find_sequences(arguments.sequences)
    problems += unreadable
    for problem in problems:
        say(problem)
    if not sequences or not trackers:
        raise DataError("nothing to evaluate")
    if arguments.out is not None:
        make_directory(arguments.out)
    kept = KeptRuns(arguments.runs) if arguments.runs is not None else None
    for note in (note for sequence in sequences for note in sequence.notes):
        say(note)
    evaluation, interrupted = evaluate(
        sequences,
        trackers,
        seeds=arguments.seeds,
        jobs=arguments.jobs,
        spatial=arguments.sre,
        progress=partial(shown, unit="run"),
        kept=kept,
    )
    for failure in evaluation.failures:
        say(failure)
    failed = bool(problems or evaluation.failures)
    evaluation.failures[:0] = problems
    if interrupted:
        say(f"interrupted: {len(evaluation.runs)} of {evaluation.planned} runs are finished and kept")
    if evaluation.runs:
        publish(evaluation, arguments.out, arguments.ablation is not None)
    return INTERRUPTED if interrupted else int(failed)


def requested(arguments: argparse.Namespace) -> "list[TrackerSpec]":
    """The trackers that the arguments ask for. Raises UsageError and DataError."""
    from asttrack.evaluation.ablation import read_variants
    from asttrack.evaluation.trackers import parse_trackers

    trackers: list[TrackerSpec] = []
    if arguments.ablation is not None:
        trackers += read_variants(arguments.ablation)
    if arguments.trackers is not None or not trackers:
        trackers += parse_trackers(arguments.trackers or "asttrack", arguments.preset)
    labels = [tracker.label for tracker in trackers]
    for label in labels:
        if labels.count(label) > 1:
            raise UsageError(f"{label}: both a variant of {arguments.ablation} and one of --trackers")
    return trackers


def usable(trackers: "list[TrackerSpec]") -> "tuple[list[TrackerSpec], list[str]]":
    """Those that are installed, and a line for each that is not. Raises UsageError for a configuration that is not one."""
    found: list[TrackerSpec] = []
    problems: list[str] = []
    for tracker in trackers:
        try:
            tracker.check()
        except MissingExtraError as error:
            problems.append(str(error))
        else:
            found.append(tracker)
    return found, problems


def publish(evaluation: "Evaluation", directory: Path | None, compare: bool) -> None:
    """Prints the tables and writes the files. Raises DataError."""
    from asttrack.evaluation.report import render
    from asttrack.evaluation.store import write_results
    from asttrack.evaluation.tables import align, tables
    from asttrack.output import write_text

    print("\n\n".join(f"{title}\n\n{align(lines)}" for title, lines in tables(evaluation, compare)))
    if directory is not None:
        paths = write_results(evaluation, directory, compare)
        write_text(directory / "report.html", render(evaluation, compare))
        print(f"\nwritten: {', '.join(str(path) for path in [*paths, directory / 'report.html'])}")
