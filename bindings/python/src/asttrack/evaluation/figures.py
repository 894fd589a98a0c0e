"""Charts as SVG to put into a page: they take its text colour, so that they are readable in light and in dark."""

import io
import re
from collections.abc import Iterator
from collections.abc import Sequence as Many
from contextlib import contextmanager
from html import escape
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from asttrack.evaluation.metrics import OVERLAPS, RADII, RADIUS, Floats, precision_curve, success_curve
from asttrack.evaluation.results import Evaluation, mean_curve
from asttrack.evaluation.summary import tracker_reliability

PALETTE = (
    "#e4572e",
    "#3a86ff",
    "#2a9d6f",
    "#b15de0",
    "#d99a00",
    "#00a6b8",
    "#d6438a",
    "#8a7f6d",
    "#6f9940",
    "#7f8cff",
    "#c26a3a",
    "#5f9ea0",
)
"""A colour for each tracker, in their order, legible on white and on black; more trackers begin again."""
_INK = "#010203"  # stands for the page's text colour until the SVG is finished
_FLOOR = 0.5  # pixels: below it, errors are drawn at it, as the scale is logarithmic


def colour(rank: int) -> str:
    """The colour of the tracker at a place of the list."""
    return PALETTE[rank % len(PALETTE)]


def curves(evaluation: Evaluation) -> tuple[str, str]:
    """Precision and success curves, each the mean over sequences and seeds."""
    precision, success = [], []
    for label in evaluation.labels:
        runs = evaluation.one_pass(label)
        precision.append(mean_curve([precision_curve(m.errors[1:]) for m in runs]))
        success.append(mean_curve([success_curve(m.shares[1:]) for m in runs]))
    return (
        _curve_chart("precision", RADII, precision, "centre error threshold, pixels", "share of frames within", RADIUS),
        _curve_chart("success", OVERLAPS, success, "overlap threshold", "share of frames above", None),
    )


def _curve_chart(name: str, x: Floats, lines: Many[Floats | None], across: str, upwards: str, mark: float | None) -> str:
    with _style(name):
        figure = Figure(figsize=(5.4, 3.7), layout="constrained")
        axes = figure.add_subplot()
        if mark is not None:
            axes.axvline(mark, color=_INK, alpha=0.5, linewidth=0.8, linestyle=(0, (4, 3)))
        for rank, line in enumerate(lines):
            if line is not None:
                _line(axes, rank, x, line, 1.8)
        axes.set(xlim=(x[0], x[-1]), ylim=(0, 1.01), xlabel=across, ylabel=upwards)
        return _svg(figure, f"{upwards}, by {across}")


def reliability_chart(evaluation: Evaluation) -> str:
    """Share of right frames by score, of the trackers that give one; empty when none does."""
    found = [(rank, tracker_reliability(evaluation, label)) for rank, label in enumerate(evaluation.labels)]
    scored = [(rank, line) for rank, line in found if line.frames.any()]
    if not scored:
        return ""
    with _style("reliability"):
        figure = Figure(figsize=(5.4, 3.7), layout="constrained")
        axes = figure.add_subplot()
        axes.plot([0, 1], [0, 1], color=_INK, alpha=0.5, linewidth=0.8, linestyle=(0, (4, 3)))
        for rank, line in reversed(scored):
            some = line.frames > 0
            _line(axes, rank, line.score[some], line.right[some], 1.8)
            area = 6 + 150 * line.frames[some] / line.frames.sum()
            dots = axes.scatter(line.score[some], line.right[some], s=area, color=colour(rank), linewidths=0, zorder=4)
            dots.set_gid(f"tracker-{rank}")
        axes.set(xlim=(0, 1), ylim=(0, 1.01), xlabel="score", ylabel="share of right frames")
        return _svg(figure, "share of right frames, by score")


def errors_over_time(evaluation: Evaluation, sequence: str) -> str:
    """Centre error by frame of each tracker's first run; below it, where trackers give one, their confidence."""
    runs = [(rank, m) for rank, label in enumerate(evaluation.labels) if (m := evaluation.first(label, sequence)) is not None]
    with _style(f"errors of {sequence}"):
        scored = [(rank, m) for rank, m in runs if not np.isnan(m.run.score[1:]).all()]
        figure = Figure(figsize=(10.8, 3.6 if scored else 2.7), layout="constrained")
        panels = figure.subplots(2 if scored else 1, 1, sharex=True, squeeze=False, height_ratios=[3, 1] if scored else [1])[:, 0]
        axes = panels[0]
        axes.axhline(RADIUS, color=_INK, alpha=0.5, linewidth=0.8, linestyle=(0, (4, 3)))
        for rank, measured in reversed(runs):
            frames = np.arange(1, len(measured.errors) + 1)
            known = ~np.isnan(measured.errors)
            _line(axes, rank, frames[known], np.maximum(measured.errors[known], _FLOOR), 1.3)
        axes.set_yscale("log")
        top = 1.2 * max([2 * RADIUS, *(float(np.nanmax(m.errors)) for _, m in runs)])
        ticks = [tick for tick in (1, 3, 10, 30, 100, 300, 1000, 3000) if tick < top]
        axes.set_yticks(ticks, list(map(str, ticks)), minor=False)
        axes.set_yticks([], minor=True)
        axes.set(ylim=(_FLOOR, top), ylabel="centre error, pixels")
        for rank, measured in reversed(scored):
            _line(panels[1], rank, np.arange(1, len(measured.errors) + 1), measured.run.score, 1.1)
        if scored:
            panels[1].set(ylim=(0, 1.02), ylabel="confidence", yticks=[0, 0.5, 1])
        panels[-1].set(xlim=(1, max((len(m.errors) for _, m in runs), default=2)), xlabel="frame")
        return _svg(figure, f"centre error of each tracker over the frames of {sequence}")


def _line(axes: Axes, rank: int, x: Floats | np.ndarray[tuple[int], np.dtype[np.int_]], y: Floats, width: float) -> None:
    """A tracker's line; the first tracker's is the thickest and on top."""
    (line,) = axes.plot(x, y, color=colour(rank), linewidth=width * (1.5 if rank == 0 else 1), zorder=4 if rank == 0 else 3)
    line.set_gid(f"tracker-{rank}")


@contextmanager
def _style(name: str) -> Iterator[None]:
    ink = ("text.color", "axes.edgecolor", "axes.labelcolor", "xtick.color", "ytick.color", "grid.color")
    settings: dict[Any, Any] = {
        **dict.fromkeys(ink, _INK),
        "axes.grid": True,
        "axes.spines.right": False,
        "axes.spines.top": False,
        "font.size": 9,
        "grid.alpha": 0.15,
        "svg.fonttype": "none",
        # Names inside the SVG come from it: charts of one page must not share them.
        "svg.hashsalt": name,
    }
    with mpl.rc_context(settings):
        yield


def _svg(figure: Figure, description: str) -> str:
    stream = io.StringIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    figure.savefig(stream, format="svg", transparent=True, metadata=nothing)
    text = stream.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r'(<svg\b[^>]*?) width="[^"]*"', r"\1", text, count=1)
    text = re.sub(r'(<svg\b[^>]*?) height="[^"]*"', r"\1", text, count=1)
    text = text.replace("<svg", f'<svg role="img" aria-label="{escape(description)}"', 1).replace(_INK, "currentColor")
    text = re.sub(r' id="tracker-(\d+)"', r' class="t\1"', text)
    used = set(re.findall(r'#([^)"]+)[)"]', text))
    return re.sub(r' id="([^"]*)"', lambda match: match[0] if match[1] in used else "", text)
