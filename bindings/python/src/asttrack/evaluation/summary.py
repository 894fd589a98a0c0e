"""From runs to rows of a table: a middle and a spread over seeds or first boxes, for each sequence and over all."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from asttrack.evaluation.confidence import Reliability, confidence, judge, pool, reliability
from asttrack.evaluation.protocol import ONE_PASS
from asttrack.evaluation.results import Evaluation, Measured


@dataclass(frozen=True)
class Figure:
    """A column of the tables.

    Attributes:
        key: in files.
        title: in tables.
        digits: after the point.
        better: 1 when more is better, -1 when less is, 0 when neither.
    """

    key: str
    title: str
    digits: int
    better: int


Means: TypeAlias = dict[object, dict[str, float]]
"""The mean figures over sequences, by seed or first box."""

FIGURES = (
    Figure("centre_error", "centre error px", 1, -1),
    Figure("precision", "precision at 20", 2, 1),
    Figure("success", "success", 2, 1),
    Figure("rate", "frames/s", 0, 1),
    Figure("lost", "lost frames", 0, -1),
)
ACCURACY = FIGURES[:3]
ABLATED = FIGURES[:4]
CONFIDENCE = (
    Figure("score_auc", "AUC of the score", 3, 1),
    Figure("flag_auc", "AUC of the flag", 3, 1),
    Figure("calibration", "calibration error", 3, -1),
    Figure("wrong", "wrong %", 1, -1),
    Figure("lost_visible", "lost while visible %", 2, -1),
    Figure("false_lost", "lost while on it %", 2, -1),
    Figure("losses", "losses", 0, 0),
    Figure("noticed", "noticed", 0, 0),
    Figure("delay", "delay frames", 0, -1),
)


@dataclass(frozen=True)
class Spread:
    """A middle with its range; all nan when there is nothing."""

    middle: float
    low: float
    high: float


@dataclass(frozen=True)
class Row:
    """The figures of one tracker on one sequence, or on all.

    Attributes:
        sequence: name; None for all together.
        tracker: label.
        figures: by key.
        repeats: seeds, or first boxes, that the spread is over.
        sequences: how many the row covers.
    """

    sequence: str | None
    tracker: str
    figures: dict[str, Spread]
    repeats: int
    sequences: int


def one_pass_rows(evaluation: Evaluation) -> list[Row]:
    """Medians and ranges over the seeds: sequences first, the mean over them last."""
    return _rows(evaluation, evaluation.one_pass, lambda m: m.run.seed, _median, FIGURES, over_sequences)


def spatial_rows(evaluation: Evaluation) -> list[Row]:
    """Means and ranges over the shifted and scaled first boxes; none when there were no such runs."""
    return _rows(
        evaluation, evaluation.spatial, lambda m: m.run.start, lambda values: float(np.mean(values)), FIGURES, over_sequences
    )


def confidence_rows(evaluation: Evaluation) -> list[Row]:
    """Medians and ranges over the seeds: sequences first, the frames of all of them as one last."""
    return _rows(evaluation, evaluation.one_pass, lambda m: m.run.seed, _median, CONFIDENCE, pooled)


def pooled(runs: Iterable[Measured]) -> dict[str, float]:
    """How well one tracker knows when it is wrong, over the frames of its runs together."""
    return confidence(pool(map(judge, runs)))


def tracker_reliability(evaluation: Evaluation, label: str) -> Reliability:
    """What the scores of a tracker are worth, over the frames of all its one-pass runs."""
    runs = evaluation.one_pass(label)
    if not runs:
        return reliability(np.empty(0), np.empty(0, bool))
    judged = pool(map(judge, runs))
    return reliability(judged.score, judged.wrong)


def over_sequences(runs: Iterable[Measured]) -> dict[str, float]:
    """The mean figures of one tracker's runs, one on each sequence; the rate is that of all their frames together."""
    measured = list(runs)
    seconds = sum(m.run.seconds for m in measured)
    return {
        **{figure.key: _mean(getattr(m.accuracy, figure.key) for m in measured) for figure in ACCURACY},
        "rate": sum(m.run.updates for m in measured) / seconds if seconds > 0 else float("nan"),
        "lost": _mean(m.accuracy.lost for m in measured),
    }


def complete(runs: Iterable[Measured], key: Callable[[Measured], object]) -> dict[object, list[Measured]]:
    """Runs grouped by seed or first box, where they are there for every sequence that the others are there for."""
    groups: dict[object, list[Measured]] = {}
    for measured in runs:
        groups.setdefault(key(measured), []).append(measured)
    most = max(map(len, groups.values()), default=0)
    return {name: group for name, group in groups.items() if len(group) == most}


def spread(values: Iterable[float], middle: Callable[[list[float]], float]) -> Spread:
    """The middle and the range of the numbers among the values."""
    known = [value for value in values if not np.isnan(value)]
    return Spread(middle(known), min(known), max(known)) if known else Spread(np.nan, np.nan, np.nan)


def _rows(
    evaluation: Evaluation,
    runs_of: Callable[[str, str | None], list[Measured]],
    key: Callable[[Measured], object],
    middle: Callable[[list[float]], float],
    columns: Iterable[Figure],
    taken: Callable[[list[Measured]], dict[str, float]],
) -> list[Row]:
    names: list[str | None] = [sequence.name for sequence in evaluation.sequences]
    rows = []
    for name in [*names, None] if len(names) > 1 else names:
        for label in evaluation.labels:
            groups = complete(runs_of(label, name), key)
            if not groups:
                continue
            values = [taken(group) for group in groups.values()]
            figures = {figure.key: spread((value[figure.key] for value in values), middle) for figure in columns}
            covered = len(next(iter(groups.values())))
            rows.append(Row(name, label, figures, len(groups), covered))
    return rows


def _mean(values: Iterable[float]) -> float:
    known = [value for value in values if not np.isnan(value)]
    return float(np.mean(known)) if known else float("nan")


@dataclass(frozen=True)
class Worth:
    """What a variant of an ablation is worth.

    Attributes:
        tracker: label of the variant.
        figures: of the variant itself, over the sequences.
        gains: its figures less those of the first variant, seed by seed; None for the first.
    """

    tracker: str
    figures: dict[str, Spread]
    gains: dict[str, Spread] | None


def ablation(evaluation: Evaluation) -> list[Worth]:
    """Compares each tracker with the first one, over the sequences and seed by seed."""
    worths: list[Worth] = []
    base: Means = {}
    for label in evaluation.labels:
        runs = complete((m for m in evaluation.one_pass(label) if m.run.start == ONE_PASS.name), lambda m: m.run.seed)
        means = {seed: over_sequences(group) for seed, group in runs.items()}
        if not means:
            continue
        figures = {figure.key: spread((mean[figure.key] for mean in means.values()), _median) for figure in FIGURES}
        pairs = _pairs(means, base)
        gains = {figure.key: spread((one[figure.key] - other[figure.key] for one, other in pairs), _median) for figure in FIGURES}
        worths.append(Worth(label, figures, gains if worths else None))
        base = base or means
    return worths


def _pairs(means: Means, base: Means) -> list[tuple[dict[str, float], dict[str, float]]]:
    """What to compare: the same seeds; a tracker with one run only, as it draws no random numbers, with every seed of the other."""
    if len(means) == 1 or len(base) == 1:
        return [(one, other) for one in means.values() for other in base.values()]
    return [(mean, base[seed]) for seed, mean in means.items() if seed in base]


def _median(values: list[float]) -> float:
    return float(np.median(values))
