"""Figures of speed as Markdown, and the C bench's file."""

import json
from pathlib import Path
from typing import Any

import pytest

from asttrack.core_bench import core_table, ratio_of, read_core, spread_text
from asttrack.failures import DataError
from asttrack.performance import BEGIN, END, markdown, put_into


def middle(value: float | None) -> dict[str, Any]:
    return {"least": value, "median": value, "greatest": value, "count": 1}


def step(name: str, backend: str, ms: float) -> dict[str, Any]:
    return {"name": name, "backend": backend, "step_ms": middle(ms), "stages_ms": {"patches": middle(ms / 2)}}


def quotient(above: str, below: str, value: float, stage: str = "step") -> dict[str, Any]:
    return {"above": above, "below": below, "stage": stage, "ratio": middle(value)}


def core_figures() -> dict[str, Any]:
    """What `make bench` writes, as far as it is read."""
    backends = ("builtin", "lapacke")
    facts = {"command": "asttrack-bench", "commit": "abc123", "backend": "lapacke", "processor": "A Processor", "cores": 2}
    facts |= {"load": None, "compiler": "gcc 12", "flags": "-O3", "date": "2026-01-01T00:00:00Z", "rounds": 15}
    steps = [step(name, backend, ms) for name, ms in (("paper, gram", 2.0), ("paper, literal", 120.0)) for backend in backends]
    ratios = [quotient(f"paper, literal, {backend}", f"paper, gram, {backend}", 60.5) for backend in backends]
    ratios.append(quotient("paper, gram, builtin", "paper, gram, lapacke", 1.25))
    roof = {
        "preset": "paper",
        "products": [{"shape": "a tile", "backend": "builtin", "gflops": 50.0}],
        "patch_us": 1.5,
        "cells_us": 0.0,
        "least_products_ms": 0.5,
        "least_patches_ms": 0.9,
        "least_ms": 1.4,
        "steps": [{"backend": backend, "step_ms": middle(2.0), "times_least": middle(1.43)} for backend in backends],
    }
    curve = {"name": "particles, paper", "size": "N", "backend": "builtin", "exponent": 1.01, "exponent_large": None}
    curve["points"] = [{"size": 100, "step_ms": middle(0.5)}]
    counted = {"name": "tiny", "preset": "tiny", "backend": "builtin", "step": 7492000.0, "patches": 4657000.0}
    return {
        "conditions": facts,
        "sequences": [{"sequence": "synth", "frames": 60, "width": 320, "height": 240, "steps": steps, "ratios": ratios}],
        "growth": [curve],
        "roofline": [roof],
        "threads": {"absent": "this library has no threads", "steps": []},
        "instructions": {"absent": None, "steps": [counted]},
    }


def race() -> dict[str, Any]:
    ours = {"tracker": "asttrack:robust", "backend": "builtin", "ms": middle(2.0), "frames_per_second": 500.0, "frames": 59}
    ours |= {"held": 59, "ratios": {"csrt": {**middle(27.0), "frames": 59}, "kcf": {**middle(2.2), "frames": 30}}}
    theirs = {
        "tracker": "csrt",
        "backend": None,
        "ms": middle(54.0),
        "frames_per_second": 18.5,
        "frames": 59,
        "held": 40,
        "ratios": {},
    }
    return {"sequence": "scene", "frames": 59, "passes": 3, "trackers": [ours, theirs]}


def whole() -> dict[str, Any]:
    return {"conditions": {"opencv": "4.13.0"}, "libraries": [], "races": [race()], "core": core_figures()}


def test_the_tables_hold_the_figures() -> None:
    text = markdown(whole())
    for figure in (
        "Commit `abc123`",
        "load unknown",
        "builtin 60.5 [60.5 60.5], lapacke 60.5 [60.5 60.5]",
        "| growth exponent in N, `paper` | at most 1.05 | builtin 1.010 |",
        "| 1 thread / 2 threads, `paper` | at least 1.7 | not measured: this library has no threads |",
        "| `robust`'s frames/s / CSRT's, scene | at least 25 | builtin 27.0 [27.0 27.0] |",
        "builtin 2.2 [2.2 2.2] (first 30)",
        "| tiny | builtin | 7.492 | 4.657 |",
        "| `csrt` | 54.000 [54.000 54.000] | 18 | 40 of 59 | - | - |",
        "1.43 [1.43 1.43]",
    ):
        assert figure in text
    for line in text.splitlines():
        assert line.startswith("|") == line.endswith("|")


def test_every_row_has_as_many_cells_as_its_head() -> None:
    cells = 0
    for line in markdown(whole()).splitlines():
        count = line.count("|")
        if count and cells:
            assert count == cells, line
        cells = count


def test_figures_without_the_c_bench_are_the_races() -> None:
    text = markdown({**whole(), "core": None})
    assert text.startswith("### Beside OpenCV 4.13.0's trackers, scene, 59 frames, 3 passes")


def test_a_document_keeps_what_is_outside_the_marks(tmp_path: Path) -> None:
    path = tmp_path / "performance.md"
    path.write_text(f"before\n\n{BEGIN}\nold\n{END}\n\nafter\n")
    put_into(path, whole())
    once = path.read_text()
    assert once.startswith(f"before\n\n{BEGIN}\n")
    assert once.endswith(f"{END}\n\nafter\n")
    assert "old" not in once
    put_into(path, whole())
    assert path.read_text() == once


@pytest.mark.parametrize("text", ["nothing here\n", f"{END}\n{BEGIN}\n"])
def test_a_document_without_marks_is_left_alone(tmp_path: Path, text: str) -> None:
    path = tmp_path / "notes.md"
    path.write_text(text)
    with pytest.raises(DataError, match=r"notes\.md: has no lines"):
        put_into(path, whole())
    assert path.read_text() == text


def test_the_documentation_has_the_marks() -> None:
    text = (Path(__file__).parents[3] / "docs" / "performance.md").read_text(encoding="utf-8")
    assert 0 < text.find(BEGIN) < text.find(END)


def test_the_c_benchs_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "bench.json"
    path.write_text(json.dumps(core_figures()))
    core = read_core(path)
    found = ratio_of(core["sequences"][0], "paper, gram, builtin", "paper, gram, lapacke")
    assert spread_text(found, 2) == "1.25 [1.25 1.25]"
    assert ratio_of(core["sequences"][0], "paper, gram, builtin", "tiny, lapacke") is None
    assert spread_text(None, 2) == spread_text(middle(None), 2) == "-"
    assert "60.5 [60.5 60.5]" in core_table(core)


@pytest.mark.parametrize(("text", "reason"), [("{", "not JSON"), ("[]", "not the figures"), ('{"conditions": {}}', "no sequences")])
def test_what_the_c_bench_has_not_written(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "bench.json"
    path.write_text(text)
    with pytest.raises(DataError, match=reason):
        read_core(path)
    with pytest.raises(DataError, match=r"absent\.json"):
        read_core(tmp_path / "absent.json")
