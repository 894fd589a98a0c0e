#!/usr/bin/env python3
"""Fits the score of the robust preset to ground truth: the constants of ast_confidence_probability in src/confidence.c.

The command, built so that it tells the predictors of every step (observe.c), tracks each sequence with each seed. A frame is wrong
when its overlap with the truth is below 0.2 or nothing of the object is in view; a logistic regression on the terms below, in which
each sequence has the same weight, gives the probability that it is right. Beside the fit over all sequences stand the constants of
the source, and what each sequence gets from a fit over the others.

A predictor more: a column in observe.c, a line in TERMS, and the constants in src/confidence.c.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from asttrack.evaluation.confidence import Bools, judged_frames, reliability, roc_auc
from asttrack.evaluation.metrics import Floats, overlaps
from asttrack.evaluation.sequence import Sequence, read_sequence
from asttrack.failures import DataError

# Of the predictors by name, in the order of the source.
TERMS: dict[str, Callable[[Any], Floats]] = {
    "start": lambda row: row["start"],
    "-ln(spread + 0.01)": lambda row: -np.log(row["spread"] + 0.01),
    "inside": lambda row: row["inside"],
}
# Scores between which a float holds their log odds well.
LEAST, MOST = 0.001, 0.999
# How far the source's log odds may be from the best sum of the terms: rounding.
ROUNDING = 0.01


@dataclass(frozen=True)
class Seen:
    """The judged frames of one sequence, of all seeds.

    Attributes:
        name: of the sequence.
        terms: (frames, terms and a one).
        score: the tracker's.
        wrong: whether the box is not on the object.
    """

    name: str
    terms: Floats
    score: Floats
    wrong: Bools


def track(command: Path, sequence: Sequence, seed: int, folder: Path) -> tuple[Floats, Floats, Bools]:
    """Terms, score and outcome of the judged frames of one run."""
    track_path, rows_path = folder / f"{sequence.name}-{seed}.csv", folder / f"{sequence.name}-{seed}.rows"
    done = subprocess.run(  # noqa: S603  # the command that this build made
        [str(command), "track", str(sequence.directory), "--seed", str(seed), "--csv", str(track_path)],
        env={**os.environ, "AST_PREDICTORS": str(rows_path), "OPENBLAS_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise DataError(done.stderr.strip() or f"{command}: ended with status {done.returncode}")
    boxes = np.loadtxt(track_path, delimiter=",", skiprows=1, usecols=(1, 2, 3, 4), ndmin=2)[: len(sequence)]
    rows = np.genfromtxt(rows_path, delimiter=",", names=True)[: len(sequence) - 1]
    if len(boxes) != len(sequence) or len(rows) != len(sequence) - 1:
        raise DataError(f"{sequence.directory}: {len(sequence)} frames, but {len(boxes)} boxes and {len(rows)} rows of predictors")
    # The first frame, whose box is given, is no step and is not judged.
    known, wrong = judged_frames(overlaps(boxes, sequence.truth), sequence.absent)
    rows, wrong = rows[known[1:]], wrong[known]
    return np.column_stack([*(term(rows) for term in TERMS.values()), np.ones(len(rows))]), rows["score"], wrong


def chances(terms: Floats, beta: Floats) -> Floats:
    """The probability that a frame is right, by the coefficients."""
    with np.errstate(over="ignore"):  # to a probability of 0
        chance: Floats = 1 / (1 + np.exp(-terms @ beta))
    return chance


def logistic(terms: Floats, wrong: Bools, weight: Floats) -> Floats:
    """The coefficients that make the frames likeliest, by Newton's method."""
    beta = np.zeros(terms.shape[1])
    for _ in range(100):
        right = chances(terms, beta)
        slope = terms.T @ (weight * (~wrong - right))
        curvature = (terms * (weight * right * (1 - right))[:, None]).T @ terms
        step = np.linalg.solve(curvature + 1e-9 * np.eye(len(beta)), slope)
        beta = beta + step
        if np.abs(step).max() < 1e-9:
            return beta
    raise DataError("the regression does not settle: the terms part right frames from wrong ones without error")


def fit(sequences: list[Seen]) -> Floats:
    """The coefficients over these sequences, each with the same weight."""
    weight = np.concatenate([np.full(len(seen.wrong), 1 / len(seen.wrong)) for seen in sequences])
    return logistic(np.concatenate([seen.terms for seen in sequences]), np.concatenate([seen.wrong for seen in sequences]), weight)


def of_source(sequences: list[Seen]) -> Floats:
    """The constants in the source, from the scores that it gives. Raises DataError where they are not made from the terms alone."""
    terms = np.concatenate([seen.terms for seen in sequences])
    score = np.concatenate([seen.score for seen in sequences])
    clear = (score > LEAST) & (score < MOST)
    log_odds = np.log(score[clear] / (1 - score[clear]))
    beta, *_ = np.linalg.lstsq(terms[clear], log_odds, rcond=None)
    worst = float(np.abs(terms[clear] @ beta - log_odds).max())
    if worst > ROUNDING:
        raise DataError(
            f"src/confidence.c: its log odds differ by up to {worst:.3g} from any sum of {', '.join(TERMS)}: "
            "give calibration/observe.c and TERMS its predictors"
        )
    return np.asarray(beta, float)


def report(sequences: list[Seen]) -> None:
    """Prints coefficients and figures."""
    source, fitted = of_source(sequences), fit(sequences)
    left_out = [fit([other for other in sequences if other is not seen]) for seen in sequences]
    print(f"{'log odds of a right frame':26s} {'source':>8s} {'fitted':>8s}   without one sequence")
    for name, inside, best, others in zip([*TERMS, "1"], source, fitted, np.transpose(left_out), strict=True):
        print(f"{name:26s} {inside:8.3f} {best:8.3f}   {others.min():.3f} .. {others.max():.3f}")

    ways = {
        "source": [seen.score for seen in sequences],
        "fitted": [chances(seen.terms, fitted) for seen in sequences],
        "left out": [chances(seen.terms, beta) for seen, beta in zip(sequences, left_out, strict=True)],
    }
    print(f"\n{'':16s} {'frames':>7s} {'wrong %':>8s}   ROC AUC:{''.join(f'{way:>9s}' for way in ways)}", end="")
    print(f"   calibration error:{''.join(f'{way:>9s}' for way in ways)}")

    def line(name: str, wrong: Bools, scores: list[Floats]) -> None:
        areas = "".join(f"{roc_auc(score, wrong):9.3f}" for score in scores).replace("nan", "  -")
        errors = "".join(f"{reliability(score, wrong).error:9.3f}" for score in scores)
        print(f"{name:16s} {len(wrong):7d} {100 * wrong.mean():8.1f}           {areas}                     {errors}")

    for place, seen in enumerate(sequences):
        line(seen.name, seen.wrong, [scores[place] for scores in ways.values()])
    line("all", np.concatenate([seen.wrong for seen in sequences]), [np.concatenate(scores) for scores in ways.values()])
    print("left out: each sequence by the constants that the others give")


def main() -> None:
    """Tracks, fits and reports."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--command", type=Path, required=True, help="the command with observe.c in front")
    parser.add_argument("--seeds", type=int, default=5, help="runs of each sequence")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time")
    parser.add_argument("sequences", type=Path, nargs="+", help="directories with ground truth")
    arguments = parser.parse_args()
    found = [read_sequence(directory) for directory in arguments.sequences]
    tasks = [(sequence, seed) for sequence in found for seed in range(1, arguments.seeds + 1)]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(arguments.jobs) as pool:
        runs = list(pool.map(lambda task: track(arguments.command.resolve(), task[0], task[1], Path(folder)), tasks))
    seen = []
    for place, sequence in enumerate(found):
        terms, score, wrong = zip(*runs[place * arguments.seeds : (place + 1) * arguments.seeds], strict=True)
        seen.append(Seen(sequence.name, np.concatenate(terms), np.concatenate(score), np.concatenate(wrong)))
    print(f"robust preset, {len(found)} sequences, {arguments.seeds} seeds, {sum(len(s.wrong) for s in seen)} frames\n")
    report(seen)


if __name__ == "__main__":
    try:
        main()
    except (DataError, OSError) as error:
        print(f"fit: {error}", file=sys.stderr)
        sys.exit(1)
