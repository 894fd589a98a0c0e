"""Rows as text for a terminal."""

import math
from collections.abc import Sequence as Many

from asttrack.evaluation.summary import FIGURES, Figure, Row, Spread, Worth


def figures_table(rows: Many[Row]) -> str:
    """A block for each sequence and one for the mean over them, a line a tracker."""
    lines = [["sequence", "tracker", *(figure.title for figure in FIGURES), "runs"]]
    last: object = ""
    for row in rows:
        name = row.sequence or f"mean of {row.sequences}"
        if row.sequence != last:
            lines.append([])
        cells = [format_spread(row.figures[figure.key], figure) for figure in FIGURES]
        lines.append([name, row.tracker, *cells, str(row.repeats)])
        last = row.sequence
    return align(lines)


def ablation_table(worths: Many[Worth]) -> str:
    """A line a variant: its own figures, and how far they are from the first variant's."""
    shown = [figure for figure in FIGURES if figure.key != "lost"]
    lines = [["variant", *(title for figure in shown for title in (figure.title, "change"))], []]
    for worth in worths:
        cells = []
        for figure in shown:
            gain = worth.gains[figure.key] if worth.gains is not None else None
            cells += [format_spread(worth.figures[figure.key], figure), format_spread(gain, figure, sign="+") if gain else "-"]
        lines.append([worth.tracker, *cells])
    return align(lines)


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


def _head(cell: str) -> str:
    """The number that a cell begins with, up to its range; nothing of a word."""
    first = cell.split(" ", 1)[0]
    return first if first[:1] in "+-0123456789" and first[:1] else ""
