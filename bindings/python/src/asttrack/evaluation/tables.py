"""Rows as text: aligned for a terminal, or Markdown."""

import math
from collections.abc import Sequence as Many
from typing import TypeAlias

from asttrack.evaluation.confidence import WRONG
from asttrack.evaluation.recovery import WITHIN, Recovery, confidences, summaries
from asttrack.evaluation.results import Evaluation
from asttrack.evaluation.summary import (
    ABLATED,
    CONFIDENCE,
    FIGURES,
    Figure,
    Row,
    Spread,
    Worth,
    ablation,
    confidence_rows,
    one_pass_rows,
    spatial_rows,
)

Lines: TypeAlias = list[list[str]]
"""Cells of a table, the heads first; an empty line parts blocks."""


def tables(evaluation: Evaluation, compare: bool) -> list[tuple[str, Lines]]:
    """All tables of an evaluation with their titles; with `compare`, trackers are variants to be compared with the first."""
    found = [
        ("one-pass evaluation: median [least greatest] over the seeds", figures_table(one_pass_rows(evaluation))),
        (
            f"confidence: does it know when it is wrong, that is off (overlap below {WRONG:g}) or following what is not there",
            confidence_table(confidence_rows(evaluation)),
        ),
    ]
    if robustness := spatial_rows(evaluation):
        title = "spatial robustness: mean [least greatest] over the shifted and scaled first boxes"
        found.append((title, figures_table(robustness)))
    if compare:
        title = "what each variant is worth over the sequences, against the first, seed by seed"
        found.append((title, ablation_table(ablation(evaluation))))
    return found


def recovery_tables(found: list[Recovery]) -> list[tuple[str, Lines]]:
    """The tables of the recoveries with their titles."""
    heads = ["event", "tracker", "scenes", "on it before", "said lost", f"on it within {WITHIN}", "%", "ever", "frames taken"]
    lines: Lines = [heads]
    last: object = None
    for one in summaries(found):
        if one.event != last:
            lines.append([])
        counts = map(str, (one.runs, one.held, one.noticed, one.recovered, f"{100 * one.recovered / one.runs:.0f}", one.ever))
        lines.append([one.event.name, one.tracker, *counts, "-" if math.isnan(one.took) else f"{one.took:g}"])
        last = one.event
    known: Lines = [["tracker", *(figure.title for figure in CONFIDENCE)], []]
    for tracker, values in confidences(found).items():
        known.append([tracker, *(format_spread(Spread(*[values[figure.key]] * 3), figure) for figure in CONFIDENCE)])
    return [
        ("recovery: scenes in which the tracker is on the object again, and how soon", lines),
        ("confidence over the frames of all of these scenes", known),
    ]


def figures_table(rows: Many[Row]) -> Lines:
    """A block for each sequence and one for the mean over them, a line a tracker."""
    return _blocks(rows, FIGURES, "mean of")


def confidence_table(rows: Many[Row]) -> Lines:
    """A block for each sequence and one for all of them together, a line a tracker."""
    return _blocks(rows, CONFIDENCE, "all")


def _blocks(rows: Many[Row], figures: Many[Figure], together: str) -> Lines:
    lines: Lines = [["sequence", "tracker", *(figure.title for figure in figures), "runs"]]
    last: object = ""
    for row in rows:
        name = row.sequence or f"{together} {row.sequences}"
        if row.sequence != last:
            lines.append([])
        cells = [format_spread(row.figures[figure.key], figure) for figure in figures]
        lines.append([name, row.tracker, *cells, str(row.repeats)])
        last = row.sequence
    return lines


def ablation_table(worths: Many[Worth]) -> Lines:
    """A line a variant: its own figures, and how far they are from the first variant's."""
    lines = [["variant", *(title for figure in ABLATED for title in (figure.title, "change"))], []]
    for worth in worths:
        cells = []
        for figure in ABLATED:
            gain = worth.gains[figure.key] if worth.gains is not None else None
            cells += [format_spread(worth.figures[figure.key], figure), format_spread(gain, figure, sign="+") if gain else "-"]
        lines.append([worth.tracker, *cells])
    return lines


def format_spread(value: Spread, figure: Figure, sign: str = "") -> str:
    """`middle [low high]`, or the middle alone where there is no spread."""
    if math.isnan(value.middle):
        return "-"
    middle, low, high = (f"{number:{sign}.{figure.digits}f}" for number in (value.middle, value.low, value.high))
    return middle if low == high else f"{middle} [{low} {high}]"


def align(lines: Many[Many[str]]) -> str:
    """Columns as wide as their widest cell: words to the left, figures by their first number; an empty line stays empty."""
    columns = max(map(len, lines))
    heads = [max((len(_head(line[column])) for line in lines[1:] if len(line) > column), default=0) for column in range(columns)]
    padded = [
        [
            cell.rjust(len(cell) + heads[column] - len(_head(cell))) if _head(cell) and index else cell
            for column, cell in enumerate(line)
        ]
        for index, line in enumerate(lines)
    ]
    widths = [max(len(line[column]) for line in padded if len(line) > column) for column in range(columns)]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=False)).rstrip() for line in padded)


def markdown(lines: Many[Many[str]]) -> str:
    """The same as a table of Markdown, which has no blocks."""
    heads, *rows = (line for line in lines if line)
    ruled = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in ruled)


def _head(cell: str) -> str:
    """The number that a cell begins with, up to its range; nothing of a word."""
    first = cell.split(" ", 1)[0]
    return first if first[:1] in "+-0123456789" and first[:1] else ""
