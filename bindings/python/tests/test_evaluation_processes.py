"""Tasks in processes of their own: results, failures, deaths, and a caller that stops."""

import multiprocessing
import os
import signal
import time
from pathlib import Path

import pytest

from asttrack.evaluation.processes import DiedError, run_each
from asttrack.opencv import ONE_THREAD


def work(order: tuple[str, int]) -> object:
    kind, number = order
    if kind == "raise":
        raise ValueError(f"number {number}")
    if kind == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if kind == "exit":
        os._exit(3)
    if kind == "sleep":
        time.sleep(60)
    if kind == "environment":
        return {name: os.environ.get(name) for name in ONE_THREAD}
    if kind == "interrupt":
        os.kill(os.getpid(), signal.SIGINT)
    return number, os.getpid()


def outcomes(orders: list[tuple[str, int]], jobs: int = 2) -> dict[tuple[str, int], object]:
    return dict(run_each(work, orders, jobs, ["asttrack"]))


def test_each_task_has_a_process_of_its_own() -> None:
    done = outcomes([("return", number) for number in range(5)])
    assert [done["return", number][0] for number in range(5)] == list(range(5))  # type: ignore[index]
    processes = {done["return", number][1] for number in range(5)}  # type: ignore[index]
    assert len(processes) == 5
    assert os.getpid() not in processes


def test_a_failure_or_a_death_touches_no_other_task() -> None:
    done = outcomes([("raise", 1), ("die", 2), ("exit", 3), ("return", 4), ("interrupt", 5)])
    assert isinstance(done["raise", 1], ValueError)
    assert str(done["raise", 1]) == "number 1"
    assert isinstance(done["die", 2], DiedError)
    assert str(done["die", 2]) == "its process was ended by SIGKILL"
    assert str(done["exit", 3]) == "its process ended with status 3"
    assert done["return", 4][0] == 4  # type: ignore[index]
    assert done["interrupt", 5][0] == 5  # type: ignore[index]


def test_processes_compute_on_one_thread() -> None:
    assert outcomes([("environment", 0)])["environment", 0] == dict(ONE_THREAD)


@pytest.mark.parametrize("stop", ["close", "interrupt"])
def test_what_runs_is_ended_with_its_caller(stop: str) -> None:
    running = run_each(work, [("return", 1), ("sleep", 2), ("sleep", 3)], 2, ["asttrack"])
    assert next(running)[0] == ("return", 1)
    started = time.monotonic()
    if stop == "close":
        running.close()
    else:
        with pytest.raises(KeyboardInterrupt):
            running.throw(KeyboardInterrupt)
    assert time.monotonic() - started < 10
    assert not multiprocessing.active_children()


def test_no_task_is_started_before_it_has_a_place(tmp_path: Path) -> None:
    taken: list[int] = []

    def orders() -> object:
        for number in range(6):
            taken.append(number)
            yield ("return", number)

    for count, _ in enumerate(run_each(work, orders(), 2, ["asttrack"]), 1):  # type: ignore[arg-type]
        assert len(taken) <= count + 2
    assert len(taken) == 6
    assert not list(tmp_path.iterdir())
