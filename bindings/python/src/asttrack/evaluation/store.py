"""Results as files: tables to compute with, tables to read, everything in one JSON. Each appears whole or not at all."""

import csv
import io
import json
import math
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from asttrack.evaluation.conditions import Conditions
from asttrack.evaluation.confidence import BINS
from asttrack.evaluation.metrics import OVERLAPS, RADII, precision_curve, success_curve
from asttrack.evaluation.recovery import Recovery
from asttrack.evaluation.results import Evaluation, Measured, mean_curve
from asttrack.evaluation.summary import (
    ABLATED,
    CONFIDENCE,
    Row,
    Spread,
    Worth,
    ablation,
    complete,
    confidence_rows,
    one_pass_rows,
    pooled,
    spatial_rows,
    tracker_reliability,
)
from asttrack.evaluation.tables import Lines, markdown, tables
from asttrack.evaluation.trackers import AsttrackSpec
from asttrack.output import write_text

RUN_COLUMNS = ("sequence", "tracker", "start", "seed", "frames", "compared", "centre_error", "precision", "success", "rate", "lost")
CONFIDENCE_COLUMNS = ("sequence", "tracker", "seed", *(figure.key for figure in CONFIDENCE))
ABLATION_COLUMNS = (
    "variant",
    *(f"{figure.key}{end}" for figure in ABLATED for end in ("", "_low", "_high", "_change", "_change_low", "_change_high")),
)
RECOVERY_COLUMNS = ("event", "frames", "look_alike", "scene", "tracker", "held", "noticed", "took", "recovered")
TRACK_COLUMNS = ("sequence", "tracker", "start", "seed", "frame", "x", "y", "w", "h", "ok", "score", "centre_error", "overlap")


def write_results(evaluation: Evaluation, directory: Path, compare: bool) -> list[Path]:
    """Writes results.csv, tracks.csv, confidence.csv, tables.md, results.json, and ablation.csv when variants are compared.

    Args:
        evaluation: what to write.
        directory: where.
        compare: whether the trackers are variants to be compared with the first.

    Returns:
        The files written. Raises DataError.
    """
    contents = {
        "results.csv": csv_text(RUN_COLUMNS, map(run_line, evaluation.runs)),
        "tracks.csv": csv_text(TRACK_COLUMNS, (line for measured in evaluation.runs for line in track_lines(measured))),
        "confidence.csv": csv_text(CONFIDENCE_COLUMNS, confidence_lines(evaluation)),
        "tables.md": markdown_text(evaluation.conditions, evaluation.notes, tables(evaluation, compare)),
        **({"ablation.csv": csv_text(ABLATION_COLUMNS, map(worth_line, ablation(evaluation)))} if compare else {}),
        "results.json": json.dumps(_finite(as_json(evaluation, compare)), indent=1, allow_nan=False) + "\n",
    }
    for name, text in contents.items():
        write_text(directory / name, text)
    return [directory / name for name in contents]


def csv_text(columns: Iterable[str], lines: Iterable[Iterable[object]]) -> str:
    """Lines under a header; nan is an empty field."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(["" if isinstance(cell, float) and math.isnan(cell) else cell for cell in line] for line in lines)
    return stream.getvalue()


def run_line(measured: Measured) -> list[object]:
    """The figures of a run, as RUN_COLUMNS."""
    run, figures = measured.run, measured.accuracy
    return [
        run.sequence,
        run.tracker,
        run.start,
        run.seed,
        len(run.boxes),
        figures.compared,
        round(figures.centre_error, 4),
        round(figures.precision, 4),
        round(figures.success, 4),
        round(measured.rate, 1),
        figures.lost,
    ]


def track_lines(measured: Measured) -> Iterable[list[object]]:
    """The frames of a run, as TRACK_COLUMNS; frames count from 1."""
    run = measured.run
    for index, box in enumerate(run.boxes):
        yield [
            run.sequence,
            run.tracker,
            run.start,
            run.seed,
            index + 1,
            *(round(float(side), 2) for side in box),
            int(run.ok[index]),
            round(float(run.score[index]), 4),
            round(float(measured.errors[index]), 3),
            round(float(measured.shares[index]), 4),
        ]


def confidence_lines(evaluation: Evaluation) -> Iterable[list[object]]:
    """The figures of each run, and of those of a seed together under the sequence `all`, as CONFIDENCE_COLUMNS."""
    for label in evaluation.labels:
        runs = evaluation.one_pass(label)
        together = complete(runs, lambda m: m.run.seed)
        parts = [(m.run.sequence, m.run.seed, [m]) for m in runs] + [("all", seed, group) for seed, group in together.items()]
        for name, seed, group in parts:
            figures = pooled(group)
            yield [name, label, seed, *(round(figures[figure.key], 4) for figure in CONFIDENCE)]


def worth_line(worth: Worth) -> list[object]:
    """A variant, as ABLATION_COLUMNS."""
    nothing = Spread(math.nan, math.nan, math.nan)
    line: list[object] = [worth.tracker]
    for figure in ABLATED:
        for spread in (worth.figures[figure.key], worth.gains[figure.key] if worth.gains is not None else nothing):
            line += [round(spread.middle, 4), round(spread.low, 4), round(spread.high, 4)]
    return line


def markdown_text(told: Conditions, notes: list[str], tables: list[tuple[str, Lines]]) -> str:
    """Tables in Markdown, with what made them."""
    made = (
        f"Made by `{told.command}` ({told.date}; asttrack {told.asttrack}, {told.backend}; OpenCV {told.opencv}; "
        f"{told.processor}, {told.jobs} at a time)."
    )
    lines = [f"- {note}" for note in notes]
    sections = [f"## {title[0].upper()}{title[1:]}\n\n{markdown(table)}" for title, table in tables]
    return "\n\n".join([made, *(["\n".join(lines)] if lines else []), *sections]) + "\n"


def recovery_line(one: Recovery) -> list[object]:
    """A run through a scene, as RECOVERY_COLUMNS."""
    return [
        one.event.kind,
        one.event.frames,
        int(one.event.met),
        one.scene,
        one.tracker,
        int(one.held),
        int(one.noticed),
        one.took,
        int(one.recovered),
    ]


def as_json(evaluation: Evaluation, compare: bool) -> dict[str, Any]:
    """Everything but the tracks."""
    return {
        "conditions": evaluation.conditions.as_dict(),
        "notes": evaluation.notes,
        "sequences": [
            {"name": s.name, "frames": len(s), "annotated": int((~(s.truth[:, 0] != s.truth[:, 0])).sum())}
            for s in evaluation.sequences
        ],
        "trackers": [_tracker(spec) for spec in evaluation.trackers],
        "runs": [dict(zip(RUN_COLUMNS, run_line(measured), strict=True)) for measured in evaluation.runs],
        "one_pass": list(map(_row, one_pass_rows(evaluation))),
        "spatial": list(map(_row, spatial_rows(evaluation))),
        "confidence": list(map(_row, confidence_rows(evaluation))),
        "ablation": [asdict(worth) for worth in ablation(evaluation)] if compare else [],
        "curves": {
            "radius": RADII.tolist(),
            "overlap": OVERLAPS.round(2).tolist(),
            "trackers": {label: _curves(evaluation, label) for label in evaluation.labels},
        },
        "reliability": {
            "bins": BINS.round(2).tolist(),
            "trackers": {label: _reliability(evaluation, label) for label in evaluation.labels},
        },
    }


def _tracker(spec: Any) -> dict[str, Any]:
    settings = spec.make(1).tracker.config if isinstance(spec, AsttrackSpec) else {}
    return {
        "label": spec.label,
        "random": not spec.repeats,
        "config": {k: v for k, v in settings.items() if k != "seed" or spec.repeats},
    }


def _row(row: Row) -> dict[str, Any]:
    return asdict(row)


def _curves(evaluation: Evaluation, label: str) -> dict[str, list[float] | None]:
    runs = evaluation.one_pass(label)
    precision = mean_curve([precision_curve(m.errors[1:]) for m in runs])
    success = mean_curve([success_curve(m.shares[1:]) for m in runs])
    return {
        "precision": precision.round(4).tolist() if precision is not None else None,
        "success": success.round(4).tolist() if success is not None else None,
    }


def _reliability(evaluation: Evaluation, label: str) -> dict[str, list[float]]:
    found = tracker_reliability(evaluation, label)
    return {"frames": found.frames.tolist(), "score": found.score.round(4).tolist(), "right": found.right.round(4).tolist()}


def _finite(value: Any) -> Any:
    """The same with null for nan, which JSON has not."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value
