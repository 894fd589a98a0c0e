"""The report: one HTML file with everything in it, that asks no server for anything."""

import math
from collections.abc import Iterable
from collections.abc import Sequence as Many
from html import escape
from importlib import resources
from itertools import pairwise
from string import Template

import numpy as np

from asttrack.evaluation.bag_pictures import ModelPicture
from asttrack.evaluation.confidence import BINS, WRONG
from asttrack.evaluation.figures import colour, curves, errors_over_time, reliability_chart
from asttrack.evaluation.film import Still, jpeg_uri, png_uri, strip
from asttrack.evaluation.protocol import SPATIAL
from asttrack.evaluation.results import Evaluation
from asttrack.evaluation.sequence import Sequence
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
    tracker_reliability,
)
from asttrack.evaluation.trackers import AsttrackSpec

BAG_SHOWN = 10  # models of a sequence's bag, the last ones


def render(evaluation: Evaluation, compare: bool) -> str:
    """The page.

    Args:
        evaluation: what it shows.
        compare: whether the trackers are variants to be compared with the first.
    """
    rows = one_pass_rows(evaluation)
    overall = [row for row in rows if row.sequence is None] or rows
    sections = [
        _summary(evaluation, overall),
        _curves(evaluation),
        _confidence(evaluation),
        _spatial(evaluation),
        _ablation(evaluation) if compare and evaluation.runs else "",
        _sequences(evaluation, rows),
    ]
    hidden = [*(f"t{rank}" for rank in range(len(evaluation.trackers))), "truth"]
    return Template(_asset("report.html")).substitute(
        title=escape(_title(evaluation)),
        style=_asset("report.css") + "".join(f".off-{name} .{name} {{ display: none; }}\n" for name in hidden),
        head=_head(evaluation, overall),
        legend=_legend(evaluation),
        sections="\n".join(sections),
        conditions=_conditions(evaluation),
        script=_asset("report.js"),
    )


def _asset(name: str) -> str:
    return resources.files("asttrack.evaluation").joinpath(name).read_text(encoding="utf-8")


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _title(evaluation: Evaluation) -> str:
    return f"{_count(len(evaluation.trackers), 'tracker')} on {_count(len(evaluation.sequences), 'sequence')}"


def _head(evaluation: Evaluation, overall: list[Row]) -> str:
    frames = sum(map(len, evaluation.sequences))
    lede = f"{frames:,} frames, {_count(len(evaluation.runs), 'run')}; a tracker is given the first box, and nothing after it."
    leader = next((row for row in overall if row.tracker == evaluation.labels[0]), None)
    tiles = ""
    if leader is not None:
        error, precision = leader.figures["centre_error"].middle, leader.figures["precision"].middle
        if not math.isnan(error):
            lede += (
                f" <b>{escape(leader.tracker)}</b> is off by {error:.1f} pixels on average"
                f" and within 20 pixels of the truth in {100 * precision:.0f} % of them."
            )
        tiles = '<ul class="tiles">' + "".join(_tile(figure, leader, overall) for figure in FIGURES) + "</ul>"
    notes = "".join(f"<li>{escape(note)}</li>" for note in evaluation.notes)
    alert = f'<div class="alert" role="note"><b>Know before you read on</b><ul>{notes}</ul></div>' if notes else ""
    return (
        f'<header><p class="kicker">asttrack {escape(evaluation.conditions.asttrack)}</p><h1>{escape(_title(evaluation))}</h1>'
        f'<p class="lede">{lede}</p>{tiles}{alert}</header>'
    )


def _tile(figure: Figure, leader: Row, overall: list[Row]) -> str:
    spread = leader.figures[figure.key]
    if math.isnan(spread.middle):
        return ""
    others = [row.figures[figure.key].middle for row in overall]
    rank = 1 + sum(figure.better * (other - spread.middle) > 0 for other in others)
    place = f"{'best' if rank == 1 else f'number {rank}'} of {len(others)}" if len(others) > 1 and figure.key != "lost" else ""
    return f"<li><small>{escape(figure.title)}</small><b>{spread.middle:.{figure.digits}f}</b><small>{place}</small></li>"


def _legend(evaluation: Evaluation) -> str:
    buttons = "".join(
        f'<button type="button" aria-pressed="true" data-tracker="t{rank}">{_swatch(rank)}{escape(label)}</button>'
        for rank, label in enumerate(evaluation.labels)
    )
    truth = '<button type="button" aria-pressed="true" data-tracker="truth"><i class="swatch truth"></i>truth</button>'
    return f'<nav class="legend" aria-label="Trackers shown"><div><span class="quiet">Show</span>{buttons}{truth}</div></nav>'


def _swatch(rank: int) -> str:
    return f'<i class="swatch" style="--c:{colour(rank)}"></i>'


def _summary(evaluation: Evaluation, overall: list[Row]) -> str:
    covered = {row.sequences for row in overall}
    heading = "Over all sequences" if len(evaluation.sequences) > 1 else f"On {evaluation.sequences[0].name}"
    hint = "The median over the seeds, and in grey their range. A click on a column sorts by it."
    if len(covered) > 1:
        hint += " Mind the column of sequences: means over different ones do not compare."
    table = _table(evaluation, overall, covered=len(covered) > 1)
    return f'<section><h2>{escape(heading)}</h2><p class="quiet">{hint}</p>{table}</section>'


def _table(evaluation: Evaluation, rows: Iterable[Row], covered: bool = False, figures: Many[Figure] = FIGURES) -> str:
    rows = list(rows)
    columns = [("tracker", 0), *((figure.title, figure.better) for figure in figures), ("runs", 0)]
    if covered:
        columns.append(("sequences", 0))
    best = {figure.key: _best(figure, rows) for figure in figures}
    lines = []
    for row in rows:
        cells = [_cell(row.figures[figure.key], figure, best[figure.key]) for figure in figures]
        cells += [f'<td data-value="{row.repeats}">{row.repeats}</td>']
        if covered:
            cells.append(f'<td data-value="{row.sequences}">{row.sequences}</td>')
        lines.append(_line(evaluation, row.tracker, cells))
    return _table_of(columns, lines)


def _table_of(columns: list[tuple[str, int]], lines: list[str]) -> str:
    heads = "".join(
        f'<th scope="col" data-better="{better}"><button type="button">{escape(title)}</button></th>' for title, better in columns
    )
    return f'<div class="scroll"><table><thead><tr>{heads}</tr></thead><tbody>{"".join(lines)}</tbody></table></div>'


def _line(evaluation: Evaluation, label: str, cells: list[str]) -> str:
    rank = evaluation.labels.index(label)
    ours = ' class="ours"' if isinstance(evaluation.trackers[rank], AsttrackSpec) else ""
    return f'<tr{ours}><th scope="row">{_swatch(rank)}{escape(label)}</th>{"".join(cells)}</tr>'


def _best(figure: Figure, rows: list[Row]) -> float | None:
    """The figure that the best row shows; None where there is nothing to be better than, or being better means nothing."""
    known = [round(row.figures[figure.key].middle, figure.digits) for row in rows if not math.isnan(row.figures[figure.key].middle)]
    if len(known) < 2 or figure.key == "lost" or not figure.better:
        return None
    return max(known) if figure.better > 0 else min(known)


def _cell(spread: Spread, figure: Figure, best: float | None, sign: str = "") -> str:
    if math.isnan(spread.middle):
        return '<td data-value="">-</td>'
    middle, low, high = (f"{number:{sign}.{figure.digits}f}" for number in (spread.middle, spread.low, spread.high))
    text = f"<b>{middle}</b>"
    if low != high:
        text += f'<span class="range">{low} to {high}</span>'
    mark = ' class="best"' if best is not None and round(spread.middle, figure.digits) == best else ""
    return f'<td data-value="{spread.middle:.6g}"{mark}>{text}</td>'


def _curves(evaluation: Evaluation) -> str:
    precision, success = curves(evaluation)
    return (
        "<section><h2>How far off, how much overlap</h2>"
        '<p class="quiet">Share of frames that pass a threshold, mean over sequences and seeds. Higher is better, everywhere.</p>'
        '<div class="pair">'
        f'<figure class="chart">{precision}<figcaption>Precision: frames whose centre is within so many pixels. The dashed line is '
        "the threshold of the tables.</figcaption></figure>"
        f'<figure class="chart">{success}<figcaption>Success: frames whose box overlaps the truth by more than so much. The area '
        "below it is the column success.</figcaption></figure></div></section>"
    )


def _confidence(evaluation: Evaluation) -> str:
    rows = confidence_rows(evaluation)
    overall = [row for row in rows if row.sequence is None] or rows
    if not overall:
        return ""
    chart = reliability_chart(evaluation)
    figure = (
        f'<div class="pair"><figure class="chart">{chart}<figcaption>Reliability: of the frames with such a score, how many are '
        "right. On the dashed line the score is what it says. A larger dot stands for more frames.</figcaption></figure>"
        f"{_calibration(evaluation)}</div>"
    )
    return (
        "<section><h2>Does it know when it is wrong?</h2>"
        f'<p class="quiet">A frame is wrong when the box overlaps the truth by less than {WRONG:g}, or when nothing of the object '
        "is in view. AUC: how probable it is that a right frame has a higher score than a wrong one, or is called found when the "
        "wrong one is called lost; 0.5 is chance. A loss is noticed when the tracker calls it lost before it is right again, after "
        f"so many frames.</p>{_table(evaluation, overall, figures=CONFIDENCE)}{figure if chart else ''}</section>"
    )


def _calibration(evaluation: Evaluation) -> str:
    """The reliability as a table: a line for each bin of scores, a column for each tracker that gives scores."""
    columns = [("score", 0)]
    cells: list[list[str]] = [[] for _ in BINS[1:]]
    for label in evaluation.labels:
        found = tracker_reliability(evaluation, label)
        if not found.frames.any():
            continue
        columns.append((f"right, {label}", 0))
        for line, frames, right in zip(cells, found.frames, found.right, strict=True):
            share = f"<b>{right:.2f}</b><span class='range'>of {frames:,}</span>" if frames else "-"
            line.append(f'<td data-value="{right if frames else ""}">{share}</td>')
    heads = (f'<th scope="row">{low:.1f} to {high:.1f}</th>' for low, high in pairwise(BINS))
    return _table_of(columns, [f"<tr>{head}{''.join(line)}</tr>" for head, line in zip(heads, cells, strict=True)])


def _spatial(evaluation: Evaluation) -> str:
    rows = spatial_rows(evaluation)
    overall = [row for row in rows if row.sequence is None] or rows
    if not overall:
        return ""
    return (
        "<section><h2>When the first box is a little off</h2>"
        f'<p class="quiet">{len(SPATIAL)} starts: the first box shifted by a tenth of its size to each side and corner, or scaled '
        f"by 0.8 to 1.2. The mean over them, and in grey their range.</p>{_table(evaluation, overall)}</section>"
    )


def _ablation(evaluation: Evaluation) -> str:
    base, *others = ablation(evaluation)
    columns = [("tracker", 0), *((figure.title, figure.better) for figure in ABLATED)]
    lines = [_line(evaluation, worth.tracker, _gain_cells(worth)) for worth in others]
    return (
        "<section><h2>What each part is worth</h2>"
        f'<p class="quiet">The change from <b>{escape(base.tracker)}</b> over all sequences, seed by seed: its median, and in grey '
        f"its range. A change whose range spans zero is not one.</p>{_table_of(columns, lines)}</section>"
    )


def _gain_cells(worth: Worth) -> list[str]:
    return [_cell(worth.gains[figure.key], figure, None, sign="+") for figure in ABLATED] if worth.gains is not None else []


def _sequences(evaluation: Evaluation, rows: list[Row]) -> str:
    articles = "".join(
        _article(evaluation, sequence, [row for row in rows if row.sequence == sequence.name]) for sequence in evaluation.sequences
    )
    return (
        "<section><h2>Sequence by sequence</h2>"
        f'<p class="quiet">Pictures and lines show each tracker\'s first run.</p>{articles}</section>'
    )


def _article(evaluation: Evaluation, sequence: Sequence, rows: list[Row]) -> str:
    if not rows:
        return ""
    annotated = int((~np.isnan(sequence.truth[:, 0])).sum())
    extent = f"{len(sequence)} frames" + (f", {annotated} of them annotated" if annotated < len(sequence) else "")
    stills = "".join(map(_still, strip(evaluation, sequence)))
    table = _table(evaluation, rows) if len(evaluation.sequences) > 1 else ""
    return (
        f"<article><header><h3>{escape(sequence.name)}</h3><small>{extent}</small></header>"
        f'<div class="strip">{stills}</div>'
        f'<figure class="chart">{errors_over_time(evaluation, sequence.name)}<figcaption>Centre error over the frames, on a '
        "logarithmic scale; dashed, the 20 pixels of precision.</figcaption></figure>"
        f"{_bag(evaluation, sequence)}{_spaced(table)}</article>"
    )


def _spaced(table: str) -> str:
    return f"<h4>Figures</h4>{table}" if table else ""


def _still(still: Still) -> str:
    width, height = still.size
    boxes = "".join(_rectangle(rank, box) for rank, box in reversed(still.boxes))
    caption = (
        f'<span class="worst">{escape(still.caption)}</span>, frame {still.number}' if still.caption else f"frame {still.number}"
    )
    return (
        f'<figure><div class="still"><img src="{still.picture}" alt="frame {still.number}" width="{width}" height="{height}">'
        f'<svg viewBox="-0.5 -0.5 {width} {height}" aria-hidden="true">{boxes}</svg></div>'
        f"<figcaption>{caption}</figcaption></figure>"
    )


def _rectangle(rank: int | None, box: tuple[float, ...]) -> str:
    # A box covers from half a pixel before the centre of its first pixel.
    x, y, w, h = box[0] - 0.5, box[1] - 0.5, box[2], box[3]
    look = 'class="truth"' if rank is None else f'class="t{rank}" stroke="{colour(rank)}"'
    return f'<rect {look} x="{x:.1f}" y="{y:.1f}" width="{max(w, 0):.1f}" height="{max(h, 0):.1f}"/>'


def _bag(evaluation: Evaluation, sequence: Sequence) -> str:
    """The last models that entered the bag of our first tracker."""
    ours = next((spec.label for spec in evaluation.trackers if isinstance(spec, AsttrackSpec)), None)
    first = evaluation.first(ours, sequence.name) if ours is not None else None
    if ours is None or first is None or not first.run.bag:
        return ""
    models = first.run.bag[-BAG_SHOWN:]
    drawn = any(model.basis is not None for model in models)
    names = ["seen", "mean", "basis"] if drawn else ["seen"]
    inside = ", the model&#39;s mean and its first basis vector" if drawn else ""
    heads = f'<div class="names">{"".join(f"<div>{name}</div>" for name in names)}</div>'
    return (
        f"<h4>What {escape(ours)} remembers: the last models of its bag</h4>"
        f'<div class="bag">{heads}{"".join(map(_model, models))}</div>'
        f'<p class="quiet"><small>The object as tracked when the model was made{inside}; below, its frame.</small></p>'
    )


def _model(model: ModelPicture) -> str:
    height, width = model.crop.shape
    pictures = [f'<img src="{jpeg_uri(model.crop)}" alt="object in frame {model.frame}" width="{width}" height="{height}">']
    pictures += [
        f'<img class="pixels" src="{png_uri(image)}" alt="{name} of the model of frame {model.frame}" style="width:{width}px">'
        for name, image in (("mean", model.mean), ("first basis vector", model.basis))
        if image is not None
    ]
    return f"<figure>{''.join(pictures)}<figcaption>{model.frame}</figcaption></figure>"


def _conditions(evaluation: Evaluation) -> str:
    facts = evaluation.conditions
    shown = {
        "command": f"<code>{escape(facts.command)}</code>",
        "date": escape(facts.date.replace("T", " ").replace("+00:00", " UTC")),
        "asttrack": f"{escape(facts.asttrack)}, linear algebra {escape(facts.backend)}",
        "others": f"OpenCV {escape(facts.opencv)}, numpy {escape(facts.numpy)}, Python {escape(facts.python)}",
        "machine": f"{escape(facts.processor)}, {_count(facts.cores, 'core')}",
        "beside it": f"{_count(facts.jobs, 'job')} at a time; at the start {facts.load:g} processes wanted a core",
    }
    return "".join(f"<dt>{name}</dt><dd>{text}</dd>" for name, text in shown.items())
