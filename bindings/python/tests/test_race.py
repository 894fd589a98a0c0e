"""The race of trackers: its arithmetic, and the processes that run it."""

from collections.abc import Sequence
from pathlib import Path

import pytest

import small_sequence
from asttrack._library import LIBRARY
from asttrack.race import LOST_OVERLAP, Runner, figures, held, ratio, ratio_text, run, spread, table


def runner(name: str, ms: list[list[float]], overlap: Sequence[float | None], *, ours: bool = False) -> Runner:
    """A runner whose passes differ in time only."""
    shares: list[float | None] = list(overlap)
    made = Runner(name, ours, "builtin" if ours else None, len(shares))
    for spent in ms:
        made.add({"ms": spent, "overlap": shares, "ok": [True] * len(shares)})
    return made


def test_the_object_is_lost_at_the_first_known_overlap_that_is_too_small() -> None:
    assert held([0.9, 0.5, 0.3]) == 3
    assert held([0.9, None, LOST_OVERLAP, 0.9]) == 2
    assert held([None, None]) == 2
    assert held([0.0, 0.9]) == 0
    assert held([LOST_OVERLAP + 1e-6]) == 1


def test_one_lost_pass_is_enough() -> None:
    made = runner("mil", [[1.0] * 4], [0.9] * 4)
    made.add({"ms": [1.0] * 4, "overlap": [0.9, 0.9, 0.1, 0.9], "ok": [True] * 4})
    assert made.held() == 2


def test_a_ratio_pairs_the_passes() -> None:
    """The machine is half as fast in the second pass: it must not show."""
    ours = runner("asttrack", [[1.0] * 8, [2.0] * 8], [0.9] * 8, ours=True)
    rival = runner("csrt", [[30.0] * 8, [60.0] * 8], [0.9] * 8)
    assert ratio(ours, rival, while_held=False) == {"least": 30, "median": 30, "greatest": 30, "frames": 8}


def test_a_rival_that_gets_fast_when_it_has_lost_the_object_is_compared_before() -> None:
    ours = runner("asttrack", [[1.0] * 5 + [3.0] * 5], [0.9] * 10, ours=True)
    rival = runner("kcf", [[4.0] * 5 + [0.1] * 5], [0.9] * 5 + [0.0] * 5)
    found = ratio(ours, rival, while_held=True)
    assert found == {"least": 4, "median": 4, "greatest": 4, "frames": 5}
    assert ratio_text(found, 10) == "4.0 [4.0 4.0] (first 5)"
    assert ratio_text(ratio(ours, rival, while_held=False), 10) == "1.0 [1.0 1.0]"


def test_a_rival_that_loses_the_object_at_once_is_not_compared() -> None:
    ours = runner("asttrack", [[1.0] * 10], [0.9] * 10, ours=True)
    rival = runner("kcf", [[4.0] * 10], [0.9, 0.9, 0.0] + [0.9] * 7)
    assert ratio(ours, rival, while_held=True) is None
    assert ratio_text(None, 10) == "-"


def test_the_spread_is_over_the_passes() -> None:
    assert spread([3.0, 1.0, 2.0]) == {"least": 1, "median": 2, "greatest": 3}


def test_figures_are_ranked_and_only_ours_have_ratios() -> None:
    runners = [
        runner("csrt", [[50.0] * 6], [0.9] * 6),
        runner("asttrack:robust", [[2.0] * 6], [0.9] * 6, ours=True),
        runner("kcf", [[5.0] * 6], [0.9] * 6),
    ]
    found = figures(runners)
    assert [figure["tracker"] for figure in found] == ["asttrack:robust", "kcf", "csrt"]
    assert {name: quotient["median"] for name, quotient in found[0]["ratios"].items()} == {"csrt": 25, "kcf": 2.5}
    assert found[0]["frames_per_second"] == pytest.approx(500)
    assert not found[1]["ratios"]
    text = table({"sequence": "scene", "frames": 6, "passes": 1, "trackers": found})
    assert "asttrack:robust" in text
    assert "25.0 [25.0 25.0]" in text


def test_trackers_take_turns_and_a_problem_stops_nobody(tmp_path: Path) -> None:
    sequence = small_sequence.write(tmp_path / "scene").directory
    absent = tmp_path / "absent.so"
    turns: list[str] = []

    def seen(items: list[tuple[int, object, Runner]], total: int) -> list[tuple[int, object, Runner]]:
        assert total == 6
        turns.extend(member.name for _, _, member in items)
        return items

    entries = [(LIBRARY.path, "asttrack:tiny"), (LIBRARY.path, "medianflow"), (LIBRARY.path, "kcf"), (absent, "asttrack:tiny")]
    found, problems = run(entries, "tiny", sequence, 12, 2, seen)  # type: ignore[arg-type]
    assert found is not None
    assert turns == [f"asttrack:tiny, {LIBRARY.backend}", "medianflow", "kcf"] * 2
    assert len(problems) == 1
    assert "absent.so" in problems[0]
    by_name = {figure["tracker"]: figure for figure in found["trackers"]}
    ours = by_name[f"asttrack:tiny, {LIBRARY.backend}"]
    assert ours["frames"] == 11
    assert ours["held"] == 11
    assert set(ours["ratios"]) == {"kcf"}
    for figure in found["trackers"]:
        assert figure["passes"] == 2
        assert 0 < figure["ms"]["least"] <= figure["ms"]["median"] <= figure["ms"]["greatest"]


def test_nobody_runs(tmp_path: Path) -> None:
    found, problems = run([(LIBRARY.path, "asttrack:tiny")], "tiny", tmp_path / "nowhere", 12, 1, lambda items, _: items)
    assert found is None
    assert len(problems) == 1
    assert "nowhere" in problems[0]
