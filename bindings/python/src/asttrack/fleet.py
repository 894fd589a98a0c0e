"""Many sequences over a Dask cluster: one task a sequence; a worker that dies costs the time of its task and nothing else."""

import logging
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeAlias

from distributed import CancelledError, Client, KilledWorker, LocalCluster, Worker, WorkerPlugin

from asttrack.evaluation.protocol import Run, Task, run
from asttrack.evaluation.results import Measured, measure
from asttrack.evaluation.sequence import distinct_names, read_sequence
from asttrack.evaluation.store import TRACK_COLUMNS, csv_text, track_lines
from asttrack.evaluation.trackers import AsttrackSpec
from asttrack.failures import DataError, UsageError, unusable
from asttrack.output import replacing, write_text

RETRIES = 2  # of a task that raised; one whose worker died is moved to another by the scheduler itself
POLL_SECONDS = 0.05  # between two looks at what is finished
CONNECT_SECONDS = 60  # a busy machine's scheduler takes its time; where none listens, that is known at once
COLUMNS = ("sequence", "tracker", "seed", "frames", "compared", "centre_error", "precision", "success", "lost")
LAST_BOX = ("last_x", "last_y", "last_w", "last_h")
"""Columns of the table of results. There are no times in it: workers of a cluster have neighbours, and differ."""
FORMATS = (".csv", ".parquet")

Outcome: TypeAlias = Measured | str
Progress: TypeAlias = Callable[[Iterable[tuple[int, Outcome]], int], Iterable[tuple[int, Outcome]]]


@contextmanager
def connected(scheduler: str | None, workers: int) -> Iterator[Client]:
    """A client of the scheduler at an address, or of a new cluster of worker processes on this machine, heard on loopback only.

    Raises:
        DataError: there is no scheduler at the address.
    """
    if scheduler is not None:
        try:
            client = Client(scheduler, timeout=CONNECT_SECONDS)  # type: ignore[no-untyped-call]
        except (OSError, ValueError) as error:
            raise DataError(f"{scheduler}: no Dask scheduler answers: {error}") from error
        with client:
            yield client
        return
    cluster = LocalCluster(  # type: ignore[no-untyped-call]
        n_workers=workers,
        threads_per_worker=1,
        processes=True,
        host="127.0.0.1",
        dashboard_address=None,
        scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},  # there is an HTTP server even so: any port, without a warning
        silence_logs=logging.CRITICAL,
    )
    with cluster, Client(cluster) as client:  # type: ignore[no-untyped-call]
        client.register_plugin(_Deaf())
        yield client


class _Deaf(WorkerPlugin):
    """Makes workers of our own cluster ignore the keyboard's interrupt, which the terminal sends to them, too: it is for us."""

    def setup(self, worker: Worker) -> None:  # noqa: ARG002
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def track_directory(directory: str, name: str, spec: AsttrackSpec, seed: int) -> Outcome:
    """What a worker does: tracks the sequence in a directory, which it must be able to read. What is wrong with it is a line."""
    try:
        sequence = replace(read_sequence(Path(directory)), name=name)
    except DataError as error:
        return str(error)
    done: Run = run(Task(sequence, spec, seed))
    return measure(done, sequence) if done.error is None else f"{directory}: {done.error}"


def track_all(
    client: Client, directories: list[Path], spec: AsttrackSpec, seed: int, progress: Progress
) -> tuple[list[Measured], list[str], bool]:
    """Tracks each directory's sequence on some worker.

    Results are fetched as they come, so that what is finished is safe from whatever happens to the cluster.

    Returns:
        The results in the order of the directories, a line for each that failed, and whether an interrupt ended it early.
    """
    futures = {
        client.submit(track_directory, str(directory), name, spec, seed, retries=RETRIES, pure=False): index
        for index, (directory, name) in enumerate(zip(directories, distinct_names(directories), strict=True))
    }
    outcomes: dict[int, Outcome] = {}
    with _Interrupt() as interrupt:
        outcomes.update(progress(_finished(futures, directories, interrupt), len(futures)))
        interrupted = interrupt.asked and len(outcomes) < len(futures)
        if interrupted:
            client.cancel(list(futures))  # type: ignore[no-untyped-call]
    results = [outcome for _, outcome in sorted(outcomes.items()) if isinstance(outcome, Measured)]
    failures = [outcome for _, outcome in sorted(outcomes.items()) if isinstance(outcome, str)]
    return results, failures, interrupted


class _Interrupt:
    """While it is entered an interrupt is noted, not raised: raised inside a lock of Dask's it would leave that in disorder.

    Only the main thread is interrupted; in another one nothing changes.
    """

    def __init__(self) -> None:
        self.asked = False

    def __enter__(self) -> "_Interrupt":
        self._before = None
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _note(self, _number: int, _frame: object) -> None:
        self.asked = True


def _finished(futures: dict[Any, int], directories: list[Path], interrupt: _Interrupt) -> Iterator[tuple[int, Outcome]]:
    waiting = dict(futures)
    while waiting and not interrupt.asked:
        done = [future for future in waiting if future.done()]
        if not done:
            time.sleep(POLL_SECONDS)
        for future in done:
            index = waiting.pop(future)
            yield index, _outcome(future, directories[index])


def _outcome(future: Any, directory: Path) -> Outcome:
    try:
        outcome: Outcome = future.result()
    except KilledWorker as error:
        return f"{directory}: the workers that took it died, the last one {error.last_worker.address}"
    except CancelledError:
        return f"{directory}: the cluster is gone"
    except UsageError:
        raise
    except Exception as error:  # what a task raises is its own; the others go on
        return f"{directory}: {type(error).__name__}: {error}"
    return outcome


def result_line(measured: Measured) -> list[object]:
    """The figures of a sequence, as COLUMNS and LAST_BOX."""
    done, figures = measured.run, measured.accuracy
    return [
        done.sequence,
        done.tracker,
        done.seed,
        len(done.boxes),
        figures.compared,
        round(figures.centre_error, 4),
        round(figures.precision, 4),
        round(figures.success, 4),
        figures.lost,
        *(round(float(side), 4) for side in done.boxes[-1]),
    ]


def write_table(target: Path, columns: tuple[str, ...], lines: Iterable[list[object]]) -> None:
    """Writes a table as CSV or Parquet, by the end of its name. Raises DataError."""
    if target.suffix == ".csv":
        write_text(target, csv_text(columns, lines))
        return
    import pyarrow  # type: ignore[import-untyped]
    from pyarrow import parquet

    rows = list(lines)
    table: Any = pyarrow.table({column: [row[place] for row in rows] for place, column in enumerate(columns)})
    with replacing(target) as path:
        try:
            parquet.write_table(table, path)
        except OSError as error:
            raise unusable(target, error) from error


def write_results(target: Path, results: list[Measured]) -> None:
    """One line a sequence. Raises DataError."""
    write_table(target, (*COLUMNS, *LAST_BOX), map(result_line, results))


def write_tracks(target: Path, results: list[Measured]) -> None:
    """One line a frame. Raises DataError."""
    write_table(target, TRACK_COLUMNS, (line for measured in results for line in track_lines(measured)))
