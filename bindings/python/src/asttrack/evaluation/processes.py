"""Work in processes of its own, one a task: nothing that one task leaves behind, nor its death, touches another."""

import multiprocessing
import os
import signal
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from multiprocessing import forkserver, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerContext
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

from asttrack.opencv import ONE_THREAD

Task = TypeVar("Task")
Outcome = TypeVar("Outcome")

_END_SECONDS = 5.0  # for a process that has sent its result, or was told to end, to be gone


class DiedError(Exception):
    """A process ended without a result; the message says how."""


class _Work(Generic[Task]):
    def __init__(self, task: Task, process: BaseProcess, receiver: Connection) -> None:
        self.task = task
        self.process = process
        self.receiver = receiver

    def outcome(self) -> Any:
        """What the task returned, or the exception that ended it."""
        try:
            result = self.receiver.recv()
        except EOFError:
            self.process.join(_END_SECONDS)
            return DiedError(_how_it_ended(self.process.exitcode))
        self.process.join(_END_SECONDS)
        return result

    def end(self) -> None:
        self.process.terminate()
        self.process.join(_END_SECONDS)


def run_each(
    function: Callable[[Task], Outcome], tasks: Iterable[Task], jobs: int, preload: list[str]
) -> Generator[tuple[Task, Outcome | Exception], None, None]:
    """Calls a function on each task, each in a new process on one thread, `jobs` of them at a time.

    Gives the pairs as they are done. When the caller stops, or is interrupted, what runs is ended. Interrupts from the keyboard
    reach the caller only.

    Args:
        function: importable by name, as its tasks and results are pickled.
        tasks: what to call it on.
        jobs: processes at a time, at least one.
        preload: modules to import once, before the first process.

    Yields:
        A task with what the function returned, with the exception that it raised, or with `DiedError`.
    """
    queue = iter(tasks)
    running: dict[Connection, _Work[Task]] = {}
    context = _context(preload)
    try:
        while True:
            while len(running) < jobs and (task := next(queue, None)) is not None:
                with _interrupts_held():
                    work = _start(context, function, task)
                    running[work.receiver] = work
            if not running:
                return
            for ready in wait(list(running)):
                work = running[ready]  # type: ignore[index]  # wait gives back what it was given
                outcome = work.outcome()
                del running[work.receiver]
                work.receiver.close()
                yield work.task, outcome
    finally:
        for work in running.values():
            work.end()


def _context(preload: list[str]) -> ForkServerContext:
    """A server that has loaded everything and forks: a new process then costs milliseconds."""
    os.environ.update(ONE_THREAD)
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(preload)
    # What starts the server undoes the mask when it has to start this one, too: so it comes first.
    resource_tracker.ensure_running()
    with _interrupts_held():
        forkserver.ensure_running()
    return context


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """Keeps the keyboard's interrupt waiting; processes that are started meanwhile never get one."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _start(context: ForkServerContext, function: Callable[[Task], Outcome], task: Task) -> _Work[Task]:
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(function, task, sender), daemon=True)
    process.start()
    sender.close()
    return _Work(task, process, receiver)


def _work(function: Callable[[Any], Any], task: Any, sender: Connection) -> None:
    try:
        result = function(task)
    except Exception as error:  # whatever it is, it is the caller's to judge
        result = error
    try:
        sender.send(result)
    except BrokenPipeError:
        # The caller was interrupted, and wants no more results.
        return


def _how_it_ended(code: int | None) -> str:
    if code is not None and code < 0:
        return f"its process was ended by {signal.Signals(-code).name}"
    return f"its process ended with status {code}"
