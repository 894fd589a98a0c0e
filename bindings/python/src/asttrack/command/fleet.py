"""`fleet`: many sequences over a Dask cluster."""

import argparse
import importlib
import logging
from functools import partial
from pathlib import Path

from asttrack.command.arguments import add_preset, add_sequences, add_settings, positive
from asttrack.command.speech import say
from asttrack.failures import DataError, UsageError

INTERRUPTED = 130


def add(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Adds the sub-command."""
    parser = commands.add_parser(
        "fleet",
        help="track many sequences over a Dask cluster",
        description="Tracks each sequence as one task of a Dask cluster, by default one of worker processes on this machine. "
        "Workers may die: their tasks are run again elsewhere. Workers must find the sequences under the same paths.",
    )
    add_sequences(parser)
    add_preset(parser)
    add_settings(parser)
    parser.add_argument("--seed", type=positive, default=1, help="of the tracker's random numbers (default: %(default)s)")
    parser.add_argument(
        "--scheduler", metavar="tcp://HOST:PORT", help="a running cluster's (default: a new cluster on this machine)"
    )
    parser.add_argument("--workers", type=positive, default=2, help="processes of the new cluster (default: %(default)s)")
    parser.add_argument("--out", metavar="FILE", type=Path, help="write a line for each sequence: .csv or .parquet")
    parser.add_argument("--tracks", metavar="FILE", type=Path, help="write a line for each frame: .csv or .parquet")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Does it; the exit code."""
    from asttrack.evaluation.sequence import sequence_directories
    from asttrack.evaluation.tables import align
    from asttrack.evaluation.trackers import AsttrackSpec, parse_changes
    from asttrack.fleet import COLUMNS, FORMATS, connected, result_line, track_all, write_results, write_tracks
    from asttrack.opencv import quiet
    from asttrack.progress import shown

    quiet()
    _silence_connections()
    for target in filter(None, (arguments.out, arguments.tracks)):
        if target.suffix not in FORMATS:
            raise UsageError(f"{target}: the name of a table must end in {' or '.join(FORMATS)}")
        if target.suffix == ".parquet":
            importlib.import_module("pyarrow")  # missing, it is to be missed before the work
    changes = parse_changes(arguments.settings)
    spec = AsttrackSpec(",".join([arguments.preset, *arguments.settings]), arguments.preset, tuple(changes.items()))
    spec.check()
    directories = [directory.resolve() for path in arguments.sequences for directory in sequence_directories(path)]
    with connected(arguments.scheduler, arguments.workers) as client:
        results, failures, interrupted = track_all(client, directories, spec, arguments.seed, partial(shown, unit="sequence"))
    for failure in failures:
        say(failure)
    if interrupted:
        say(f"interrupted: {len(results)} of {len(directories)} sequences are finished and kept")
    if not results and interrupted:
        return INTERRUPTED
    if not results:
        raise DataError("no sequence was tracked")
    print(align([list(COLUMNS), [], *([str(cell) for cell in result_line(measured)[: len(COLUMNS)]] for measured in results)]))
    if arguments.out is not None:
        write_results(arguments.out, results)
    if arguments.tracks is not None:
        write_tracks(arguments.tracks, results)
    return INTERRUPTED if interrupted else int(bool(failures))


def _silence_connections() -> None:
    """Leaves what clients' threads say of connections that end, an interrupt's among them, out of this command's own output.

    They go on after the client is closed, until the process ends, so there is no time to let them speak again. That is the
    command's to decide, whose process it is, not the library's. Importing `distributed` sets levels of its own: call this after.
    """
    for speaker in ("distributed", "distributed.client", "tornado.application", "asyncio"):
        logging.getLogger(speaker).setLevel(logging.CRITICAL)
