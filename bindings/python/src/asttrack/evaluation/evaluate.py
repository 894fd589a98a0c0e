"""An evaluation from sequences and trackers to runs: plans it, runs it in processes, keeps what is finished."""

from collections.abc import Callable, Generator, Iterable
from contextlib import closing

from asttrack.evaluation.conditions import conditions
from asttrack.evaluation.kept_runs import KeptRuns
from asttrack.evaluation.processes import run_each
from asttrack.evaluation.protocol import Run, Task, plan, run
from asttrack.evaluation.results import Evaluation, measure
from asttrack.evaluation.sequence import Sequence
from asttrack.evaluation.trackers import TrackerSpec
from asttrack.failures import DataError, UsageError

Progress = Callable[[Iterable[tuple[Task, Run | Exception]], int], Iterable[tuple[Task, Run | Exception]]]


def evaluate(
    sequences: list[Sequence],
    trackers: list[TrackerSpec],
    *,
    seeds: int,
    jobs: int,
    spatial: bool,
    progress: Progress,
    kept: KeptRuns | None = None,
) -> tuple[Evaluation, bool]:
    """Runs every tracker on every sequence.

    Args:
        sequences: at least one.
        trackers: at least one, checked.
        seeds: for those that draw random numbers: 1 .. seeds.
        jobs: processes at a time.
        spatial: whether also from the twelve shifted and scaled first boxes.
        progress: passes the outcomes on, and may show that they come.
        kept: where finished runs are kept, and taken from instead of running them again; None keeps none.

    Returns:
        The evaluation, and whether an interrupt from the keyboard ended it early.
    """
    tasks = plan(sequences, trackers, seeds, spatial)
    evaluation = Evaluation(sequences, trackers, conditions(jobs), planned=len(tasks))
    outcomes = _outcomes(tasks, jobs, kept)
    interrupted = False
    try:
        with closing(outcomes):
            for task, outcome in progress(outcomes, len(tasks)):
                _keep(evaluation, task, outcome)
    except KeyboardInterrupt:
        interrupted = True
    evaluation.settle()
    return evaluation, interrupted


def _outcomes(tasks: list[Task], jobs: int, kept: KeptRuns | None) -> Generator[tuple[Task, Run | Exception], None, None]:
    """The kept runs at once, the others as they are done."""
    missing = []
    for task in tasks:
        done = kept.find(task) if kept is not None else None
        if done is not None:
            yield task, done
        else:
            missing.append(task)
    with closing(run_each(run, missing, jobs, preload=["asttrack.evaluation.protocol"])) as coming:
        for task, outcome in coming:
            if kept is not None and isinstance(outcome, Run) and outcome.error is None:
                kept.keep(task, outcome)
            yield task, outcome


def _keep(evaluation: Evaluation, task: Task, outcome: Run | Exception) -> None:
    if isinstance(outcome, Run) and outcome.error is None:
        evaluation.runs.append(measure(outcome, task.sequence))
        return
    reason = outcome.error if isinstance(outcome, Run) else _reason(outcome)
    evaluation.failures.append(f"{task.sequence.name}, {task.tracker.label}, {task.start.name}, seed {task.seed}: {reason}")


def _reason(error: Exception) -> str:
    """Ours in their own words; of a stranger, its kind as well."""
    return str(error) if isinstance(error, DataError | UsageError) else f"{type(error).__name__}: {error}"
