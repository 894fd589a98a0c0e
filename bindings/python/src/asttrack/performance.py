"""Figures of speed as Markdown, put into a document between two marks."""

from pathlib import Path
from typing import Any

from asttrack.core_bench import backends, ratio_of, spread_text
from asttrack.failures import DataError, unusable
from asttrack.output import write_text
from asttrack.race import RIVALS, ratio_text

BEGIN = "<!-- figures: begin -->"
END = "<!-- figures: end -->"
_ABSENT = "not measured"


def put_into(path: Path, figures: dict[str, Any]) -> None:
    """Replaces what stands between the marks of a document. Raises DataError where it has none."""
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise unusable(path, error) from error
    begin, end = text.find(BEGIN), text.find(END)
    if begin < 0 or end < begin:
        raise DataError(f"{path}: has no lines {BEGIN} and {END} to put the figures between")
    write_text(path, f"{text[: begin + len(BEGIN)]}\n\n{markdown(figures)}\n{text[end:]}")


def markdown(figures: dict[str, Any]) -> str:
    """All tables: of the C bench where its figures are among them, and of the races."""
    core: dict[str, Any] | None = figures.get("core")
    parts = []
    if core is not None:
        parts += [_conditions(core), _headlines(core, figures["races"]), *map(_steps, core["sequences"])]
        parts += [*(_stages(sequence, core) for sequence in core["sequences"]), _growth(core), _roofline(core)]
        parts += [_threads(core), _instructions(core)]
    parts += [_race(race, figures["conditions"]) for race in figures["races"]]
    return "\n".join(parts)


def _table(heads: list[str], rows: list[list[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines) + "\n"


def _conditions(core: dict[str, Any]) -> str:
    facts = core["conditions"]
    return (
        f"Commit `{facts['commit'] or 'unknown'}`, {facts['date']}; {facts['processor']}, {facts['cores']} cores, "
        f"load {facts['load'] if facts['load'] is not None else 'unknown'} when it began; {facts['compiler']} `{facts['flags']}`; "
        f"`{facts['command']}`. Times are milliseconds, `median [least greatest]` of {facts['rounds']:.0f} rounds.\n"
    )


def _headlines(core: dict[str, Any], races: list[dict[str, Any]]) -> str:
    """What is aimed at, and what this run has: of the sequences the first, the synthetic one, with the best backend."""
    first = core["sequences"][0]
    names = backends(core)
    default = core["conditions"]["backend"]
    rows = [
        ["literal / gram, `paper`", "at least 60", _of_each(names, lambda name: spread_text(_literal(first, name), 1))],
        *([row] if (row := _builtin(first, names)) else []),
        ["step / least time of the roofline, `paper`", "at most 1.5", _roof(core, "paper")],
        ["step / least time of the roofline, `robust`", "", _roof(core, "robust")],
        ["growth exponent in N, `paper`", "at most 1.05", _exponents(core, "particles, paper")],
        ["growth exponent in N, `robust`", "at most 1.05", _exponents(core, "particles, robust")],
        ["1 thread / 2 threads, `paper`", "at least 1.7", _two_threads(core, default)],
    ]
    for race in races:
        for name, aim in (("csrt", "at least 25"), ("kcf", "at least 2")):
            rows.append([f"`robust`'s frames/s / {name.upper()}'s, {race['sequence']}", aim, _rival(race, name)])
    return _table(["figure", "aim", "this run"], rows)


def _of_each(names: list[str], text: Any) -> str:
    return ", ".join(f"{name} {text(name)}" for name in names)


def _literal(sequence: dict[str, Any], backend: str) -> dict[str, Any] | None:
    return ratio_of(sequence, f"paper, literal, {backend}", f"paper, gram, {backend}")


def _builtin(sequence: dict[str, Any], names: list[str]) -> list[str] | None:
    if len(names) < 2:
        return None
    found = {name: ratio_of(sequence, f"{name}, {names[0]}", f"{name}, {names[1]}") for name in ("paper, gram", "robust")}
    text = ", ".join(f"{name} {spread_text(spread, 2)}" for name, spread in found.items())
    return [f"{names[0]} / {names[1]}", "at most 2", text]


def _roof(core: dict[str, Any], preset: str) -> str:
    found = next((roof for roof in core["roofline"] if roof["preset"] == preset), None)
    if found is None:
        return _ABSENT
    return ", ".join(f"{step['backend']} {spread_text(step['times_least'], 2)}" for step in found["steps"])


def _exponents(core: dict[str, Any], name: str) -> str:
    return ", ".join(f"{curve['backend']} {_number(curve['exponent'], 3)}" for curve in core["growth"] if curve["name"] == name)


def _two_threads(core: dict[str, Any], backend: str) -> str:
    for step in core["threads"]["steps"]:
        if (step["preset"], step["backend"]) == ("paper", backend):
            return f"{backend} {spread_text(step['ratio'], 2)}"
    return f"{_ABSENT}: {core['threads']['absent']}"


def _rival(race: dict[str, Any], name: str) -> str:
    texts = [
        f"{tracker['backend']} {ratio_text(tracker['ratios'][name], tracker['frames'])}"
        for tracker in race["trackers"]
        if tracker["tracker"].startswith("asttrack:robust") and name in tracker["ratios"]
    ]
    return ", ".join(texts) or _ABSENT


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _steps(sequence: dict[str, Any]) -> str:
    names = list(dict.fromkeys(step["backend"] for step in sequence["steps"]))
    by = {(step["name"], step["backend"]): step for step in sequence["steps"]}
    rows = []
    for name in dict.fromkeys(step["name"] for step in sequence["steps"]):
        row = [name, *(spread_text(by[name, backend]["step_ms"], 3) for backend in names)]
        if len(names) > 1:
            row.append(spread_text(ratio_of(sequence, f"{name}, {names[0]}", f"{name}, {names[-1]}"), 2))
        rows.append(row)
    literal = ["literal / gram", *(spread_text(_literal(sequence, backend), 1) for backend in names)]
    rows.append(literal + [""] * (len(names) > 1))
    heads = ["step, ms", *names, *([f"{names[0]} / {names[-1]}"] if len(names) > 1 else [])]
    size = f"{sequence['width']:.0f} x {sequence['height']:.0f}"
    return f"### {sequence['sequence']}, {sequence['frames']:.0f} frames of {size}\n\n{_table(heads, rows)}"


def _stages(sequence: dict[str, Any], core: dict[str, Any]) -> str:
    staged = [step for step in sequence["steps"] if "stages_ms" in step]
    heads = ["stage, ms", *(f"{step['name']}, {step['backend']}" for step in staged), "literal / gram"]
    last = backends(core)[-1]
    rows = [
        [
            stage,
            *(_number(step["stages_ms"][stage]["median"], 3) for step in staged),
            _number((ratio_of(sequence, f"paper, literal, {last}", f"paper, gram, {last}", stage) or {}).get("median"), 1),
        ]
        for stage in staged[0]["stages_ms"]
    ]
    return f"Medians of the stages on {sequence['sequence']}; the last column with {last}:\n\n{_table(heads, rows)}"


def _growth(core: dict[str, Any]) -> str:
    rows = []
    for curve in core["growth"]:
        points = ", ".join(f"{point['size']:.0f}: {_number(point['step_ms']['median'], 2)}" for point in curve["points"])
        exponents = [_number(curve["exponent"], 3), _number(curve["exponent_large"], 3)]
        rows.append([curve["name"], curve["backend"], *exponents, f"{curve['size']} = {points}"])
    heads = ["growth with", "backend", "exponent", "of the large ones", "median ms at each size"]
    return f"### Growth\n\n{_table(heads, rows)}"


def _roofline(core: dict[str, Any]) -> str:
    rows = []
    for roof in core["roofline"]:
        peaks = ", ".join(f"{peak['backend']} {_number(peak['gflops'], 0)} ({peak['shape']})" for peak in roof["products"])
        samples = f"{_number(roof['patch_us'], 2)} + {_number(roof['cells_us'], 2)}"
        least = f"{_number(roof['least_products_ms'], 3)} + {_number(roof['least_patches_ms'], 3)} = {_number(roof['least_ms'], 3)}"
        rows.append([roof["preset"], peaks, samples, least, _roof(core, roof["preset"])])
    heads = ["preset", "product, Gflop/s", "samples of a candidate, us", "least time: products + patches, ms", "step / least time"]
    return f"### Roofline\n\n{_table(heads, rows)}"


def _threads(core: dict[str, Any]) -> str:
    if core["threads"]["absent"] is not None:
        return f"### Threads\n\nNot measured: {core['threads']['absent']}.\n"
    rows = [
        [
            step["preset"],
            step["backend"],
            *(spread_text(step[key], 3) for key in ("one_ms", "two_ms")),
            spread_text(step["ratio"], 2),
        ]
        for step in core["threads"]["steps"]
    ]
    return f"### Threads\n\n{_table(['preset', 'backend', '1 thread, ms', '2 threads, ms', '1 / 2'], rows)}"


def _instructions(core: dict[str, Any]) -> str:
    if core["instructions"]["absent"] is not None:
        return f"### Instructions\n\nNot counted: {core['instructions']['absent']}.\n"
    parts = [key for key, value in core["instructions"]["steps"][0].items() if not isinstance(value, str)]
    rows = [
        [step["name"], step["backend"], *(_number(step[part] / 1e6, 3) for part in parts)] for step in core["instructions"]["steps"]
    ]
    return f"### Instructions of a step, millions\n\n{_table(['preset', 'backend', *parts], rows)}"


def _race(race: dict[str, Any], facts: dict[str, Any]) -> str:
    heads = ["tracker", "ms a frame", "frames/s", "has the object for", *(f"x {name.upper()}" for name, _ in RIVALS)]
    rows = [
        [
            f"`{tracker['tracker']}`",
            spread_text(tracker["ms"], 3),
            f"{tracker['frames_per_second']:.0f}",
            f"{tracker['held']} of {tracker['frames']}",
            *(ratio_text(tracker["ratios"].get(name), tracker["frames"]) for name, _ in RIVALS),
        ]
        for tracker in race["trackers"]
    ]
    title = f"### Beside OpenCV {facts['opencv']}'s trackers, {race['sequence']}, {race['frames']} frames, {race['passes']} passes"
    return f"{title}\n\n{_table(heads, rows)}"
