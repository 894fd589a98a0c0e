"""From runs to tables and files: middles, spreads, means over sequences, comparisons of variants."""

import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from asttrack.evaluation.ablation import read_variants
from asttrack.evaluation.conditions import conditions
from asttrack.evaluation.protocol import ONE_PASS, SPATIAL, Run
from asttrack.evaluation.results import Evaluation, measure
from asttrack.evaluation.sequence import Sequence
from asttrack.evaluation.store import write_results
from asttrack.evaluation.summary import FIGURES, ablation, one_pass_rows, spatial_rows
from asttrack.evaluation.tables import ablation_table, align, figures_table, markdown
from asttrack.evaluation.trackers import AsttrackSpec, parse_trackers
from asttrack.failures import DataError
from header import REPOSITORY

FRAMES = 5
TRUTH = np.tile([100.0, 100, 20, 20], (FRAMES, 1))


def sequence(name: str) -> Sequence:
    return Sequence(name, Path(name), tuple(Path(f"{name}/{number}") for number in range(FRAMES)), TRUTH)


def made(errors: dict[tuple[str, str, int, str], float], trackers: str, names: str) -> Evaluation:
    """An evaluation whose runs are off by so many pixels, to the right, in every frame but the first."""
    sequences = {name: sequence(name) for name in names.split(",")}
    evaluation = Evaluation(list(sequences.values()), parse_trackers(trackers, "tiny"), conditions(2), planned=len(errors))
    for (name, tracker, seed, start), error in errors.items():
        boxes = TRUTH.copy()
        boxes[1:, 0] += error
        ok = np.array([True] * (FRAMES - 1) + [error < 50])
        run = Run(name, tracker, seed, start, boxes, ok, np.full(FRAMES, np.nan), seconds=0.01 * seed)
        evaluation.runs.append(measure(run, sequences[name]))
    evaluation.settle()
    return evaluation


def one_pass(*runs: tuple[str, str, int, float]) -> dict[tuple[str, str, int, str], float]:
    return {(name, tracker, seed, ONE_PASS.name): error for name, tracker, seed, error in runs}


def test_a_row_has_the_median_and_the_range_over_the_seeds() -> None:
    runs = one_pass(("s", "asttrack", 1, 10), ("s", "asttrack", 2, 100), ("s", "asttrack", 3, 18))
    (row,) = one_pass_rows(made(runs, "asttrack", "s"))
    error, precision, lost, rate = (row.figures[key] for key in ("centre_error", "precision", "lost", "rate"))
    assert (error.middle, error.low, error.high) == (18, 10, 100)
    assert (precision.middle, precision.low, precision.high) == (1, 0, 1)
    assert (lost.middle, lost.low, lost.high) == (0, 0, 1)
    assert rate.middle == pytest.approx(4 / 0.02)
    assert (row.sequence, row.repeats, row.sequences) == ("s", 3, 1)


def test_the_mean_over_sequences_is_taken_seed_by_seed() -> None:
    runs = one_pass(("s", "asttrack", 1, 10), ("s", "asttrack", 2, 30), ("t", "asttrack", 1, 2), ("t", "asttrack", 2, 4))
    *_, row = one_pass_rows(made(runs, "asttrack", "s,t"))
    error = row.figures["centre_error"]
    assert (error.middle, error.low, error.high) == ((6 + 17) / 2, 6, 17)
    assert row.figures["rate"].low == pytest.approx(8 / 0.04)
    assert (row.sequence, row.repeats, row.sequences) == (None, 2, 2)


def test_a_mean_counts_the_seeds_that_finished_every_sequence_only() -> None:
    runs = one_pass(("s", "asttrack", 1, 10), ("s", "asttrack", 2, 30), ("t", "asttrack", 1, 2), ("s", "csrt", 1, 1))
    rows = {(row.sequence, row.tracker): row for row in one_pass_rows(made(runs, "asttrack,csrt", "s,t"))}
    assert rows[None, "asttrack"].repeats == 1
    assert rows[None, "asttrack"].figures["centre_error"].middle == 6
    assert rows[None, "csrt"].sequences == 1
    assert ("t", "csrt") not in rows


def test_spatial_rows_have_the_mean_over_the_starts() -> None:
    runs = {("s", "csrt", 1, start.name): float(number) for number, start in enumerate(SPATIAL)}
    evaluation = made({**runs, ("s", "csrt", 1, ONE_PASS.name): 40.0}, "csrt", "s")
    (row,) = spatial_rows(evaluation)
    error = row.figures["centre_error"]
    assert (error.middle, error.low, error.high) == (5.5, 0, 11)
    assert row.repeats == 12
    assert one_pass_rows(evaluation)[0].figures["centre_error"].middle == 40
    assert spatial_rows(made(one_pass(("s", "csrt", 1, 1)), "csrt", "s")) == []


def test_an_ablation_compares_seed_by_seed_with_the_first() -> None:
    runs = one_pass(
        ("s", "asttrack", 1, 10), ("s", "asttrack", 2, 40), ("s", "asttrack:tiny", 1, 13), ("s", "asttrack:tiny", 2, 42)
    )
    first, second = ablation(made(runs, "asttrack,asttrack:tiny", "s"))
    assert first.gains is None
    assert second.gains is not None
    gain = second.gains["centre_error"]
    assert (gain.middle, gain.low, gain.high) == (2.5, 2, 3)
    text = align(ablation_table([first, second]))
    alone = ablation(made({**runs, ("s", "csrt", 1, ONE_PASS.name): 5.0}, "asttrack,csrt,asttrack:tiny", "s"))[1].gains
    assert alone is not None
    # One run, as it draws no random numbers, stands against every seed.
    assert (alone["centre_error"].low, alone["centre_error"].high) == (-35, -5)
    assert "+2.5 [+2.0 +3.0]" in text
    assert text.splitlines()[0].split()[:2] == ["variant", "centre"]


def test_a_table_has_a_block_a_sequence_and_the_mean() -> None:
    runs = one_pass(("s", "asttrack", 1, 10), ("s", "asttrack", 2, 30), ("t", "asttrack", 1, 2), ("t", "asttrack", 2, 4))
    lines = figures_table(one_pass_rows(made(runs, "asttrack", "s,t")))
    text = align(lines)
    assert [line.split("  ")[0] for line in text.splitlines()] == ["sequence", "", "s", "", "t", "", "mean of 2"]
    assert "20.0 [10.0 30.0]" in text
    assert "0.50 [0.00 1.00]" in text
    heads, rule, *rows = markdown(lines).splitlines()
    assert [len(line.split(" | ")) for line in (heads, rule, *rows)] == [len(lines[0])] * 5
    assert rows[0].startswith("| s | asttrack | 20.0 [10.0 30.0] | ")


def test_columns_are_aligned() -> None:
    lines = align([["name", "ms"], [], ["a", "1.25"], ["longer", "-20.5 [1 2]"], ["b", "-"]]).splitlines()
    assert lines == ["name    ms", "", "a        1.25", "longer  -20.5 [1 2]", "b           -"]


def test_files_hold_every_run_every_frame_and_every_row(tmp_path: Path) -> None:
    runs = one_pass(("s", "asttrack", 1, 10), ("s", "asttrack", 2, 30), ("t", "asttrack", 1, 2), ("t", "asttrack", 2, 4))
    evaluation = made({**runs, ("s", "asttrack", 1, SPATIAL[0].name): 9.0}, "asttrack", "s,t")
    evaluation.failures.append("t: some reason")
    paths = write_results(evaluation, tmp_path, compare=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(path.name for path in paths)

    with (tmp_path / "results.csv").open() as stream:
        lines = list(csv.DictReader(stream))
    assert [(line["sequence"], line["start"], line["seed"], line["centre_error"]) for line in lines] == [
        ("s", "one pass", "1", "10.0"),
        ("s", "one pass", "2", "30.0"),
        ("s", "left", "1", "9.0"),
        ("t", "one pass", "1", "2.0"),
        ("t", "one pass", "2", "4.0"),
    ]
    with (tmp_path / "tracks.csv").open() as stream:
        frames = list(csv.DictReader(stream))
    assert len(frames) == 5 * FRAMES
    assert frames[1] == {
        "sequence": "s", "tracker": "asttrack", "start": "one pass", "seed": "1", "frame": "2", "x": "110.0", "y": "100.0",
        "w": "20.0", "h": "20.0", "ok": "1", "score": "", "centre_error": "10.0", "overlap": "0.3333",
    }  # fmt: skip
    whole = json.loads((tmp_path / "results.json").read_text())
    assert whole["notes"] == ["t: some reason"]
    assert [row["sequence"] for row in whole["one_pass"]] == ["s", "t", None]
    assert whole["one_pass"][0]["figures"]["centre_error"] == {"middle": 20, "low": 10, "high": 30}
    assert len(whole["spatial"]) == 2
    assert whole["ablation"][0]["gains"] is None
    assert whole["trackers"][0]["config"]["particles"] == AsttrackSpec("", "tiny").make(1).tracker.config["particles"]
    assert whole["conditions"]["jobs"] == 2
    assert len(whole["curves"]["trackers"]["asttrack"]["precision"]) == len(whole["curves"]["radius"])


def test_figures_that_there_are_not_are_null(tmp_path: Path) -> None:
    evaluation = made(one_pass(("s", "csrt", 1, 1)), "csrt", "s")
    truth = np.full((FRAMES, 4), math.nan)
    truth[0] = TRUTH[0]
    bare = replace(evaluation.sequences[0], truth=truth)
    evaluation.sequences = [bare]
    evaluation.runs = [measure(evaluation.runs[0].run, bare)]
    write_results(evaluation, tmp_path, compare=False)
    whole = json.loads((tmp_path / "results.json").read_text())
    assert whole["runs"][0]["centre_error"] is None
    assert whole["sequences"][0]["annotated"] == 1
    assert ",csrt,one pass,1,5,0,,,,400.0,0" in (tmp_path / "results.csv").read_text()
    assert {figure.key for figure in FIGURES} <= set(whole["one_pass"][0]["figures"])


# ---- Lists of variants ----


def test_variants_are_read(tmp_path: Path) -> None:
    path = tmp_path / "variants.toml"
    path.write_text(
        '[[variant]]\nname = "base"\n'
        '[[variant]]\nname = "half"\npreset = "paper"\nset = { particles = 300, alpha = 0.5, basis = "raw" }\n'
    )
    assert read_variants(path) == [
        AsttrackSpec("base", "robust"),
        AsttrackSpec("half", "paper", (("particles", 300), ("alpha", 0.5), ("basis", "raw"))),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("variant", "variants.toml: "),
        ("", "holds other things than two or more"),
        ('[[variant]]\nname = "one"', "holds other things than two or more"),
        ('title = "x"\n[[variant]]\nname = "a"\n[[variant]]\nname = "b"', "holds other things"),
        ('[[variant]]\nname = "a"\n[[variant]]\nname = "a"', "two variants are called 'a'"),
        ('[[variant]]\nname = "a"\n[[variant]]\nset = {}', "variant 2: has no name"),
        ('[[variant]]\nname = "a"\n[[variant]]\nname = "b"\nseed = 1', r"variant 2 \(b\): unknown key 'seed'"),
        ('[[variant]]\nname = "a"\n[[variant]]\nname = "b"\npreset = "best"', "there is no preset 'best'"),
        ('[[variant]]\nname = "a"\n[[variant]]\nname = "b"\nset = { alpha = true }', "set is not a table"),
    ],
)
def test_a_list_of_variants_that_is_none_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "variants.toml"
    path.write_text(text)
    with pytest.raises(DataError, match=message):
        read_variants(path)
    with pytest.raises(DataError, match="No such file"):
        read_variants(tmp_path / "absent.toml")


def test_the_ablation_of_the_documentation_is_legal_and_each_variant_differs() -> None:
    variants = read_variants(REPOSITORY / "docs" / "ablation.toml")
    configurations = [variant.make(1).tracker.config for variant in variants]
    assert all(one != other for place, one in enumerate(configurations) for other in configurations[:place])


def test_the_list_in_the_documentation_is_one(tmp_path: Path) -> None:
    text = (REPOSITORY / "docs" / "evaluation.md").read_text(encoding="utf-8")
    path = tmp_path / "variants.toml"
    path.write_text(text.split("```toml\n")[1].split("```")[0])
    variants = read_variants(path)
    assert len(variants) == 2
    for variant in variants:
        variant.check()
