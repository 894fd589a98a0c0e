"""The check that holds the tracker to its figures: it passes where they are kept, and names what is not."""

import subprocess
import sys
from pathlib import Path

import pytest

import c_command
from header import REPOSITORY


def check(tmp_path: Path, bounds: str, *options: object) -> subprocess.CompletedProcess[str]:
    path = tmp_path / "bounds.txt"
    path.write_text(bounds)
    script = REPOSITORY / "scripts" / "check_accuracy.py"
    words = [sys.executable, script, "--command", c_command.find(), "--bounds", path, "--jobs", 2, *options]
    return subprocess.run([*map(str, words)], capture_output=True, text=True, check=False, timeout=300)


@pytest.fixture(scope="module")
def sequences(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("sequences")
    c_command.render(directory / "small", "--frames", 40, "--size", "160x120")
    return directory


def test_what_keeps_its_bounds_passes(sequences: Path, tmp_path: Path) -> None:
    done = check(tmp_path, "# a comment\nsmall 8 0.9 0.5 # and another\n", "--sequences", sequences)
    assert done.returncode == 0, done.stdout
    assert done.stdout.startswith("ok   small ")
    assert "(seed 1)" in done.stdout


def test_a_failure_names_sequence_figure_and_bound_and_is_no_single_throw(sequences: Path, tmp_path: Path) -> None:
    done = check(tmp_path, "small 0.01 0.9 0.999\n", "--sequences", sequences)
    assert done.returncode == 1
    line, error, success = done.stdout.splitlines()
    assert line.startswith("FAIL small ")
    assert "(median of seeds 1, 2, 3)" in line
    assert error.startswith("FAIL small: centre error ")
    assert error.endswith(" px is above 0.01")
    assert success.startswith("FAIL small: success 0.")
    assert success.endswith(" is below 0.999")


def test_sequences_that_are_not_there_are_told(tmp_path: Path) -> None:
    place = tmp_path / "absent"
    done = check(tmp_path, "surfer 8 0.9 0.5\ngirl 9 0.9 0.5\n", "--sequences", place)
    assert (done.returncode, done.stdout) == (0, f"left out, as {place}: not there: surfer, girl\n")


def test_an_update_writes_bounds_that_are_kept(sequences: Path, tmp_path: Path) -> None:
    assert check(tmp_path, "small 0.01 1 1\n", "--sequences", sequences, "--update").returncode == 0
    written = (tmp_path / "bounds.txt").read_text()
    assert written.count("\nsmall ") == 1
    assert check(tmp_path, written, "--sequences", sequences).returncode == 0


def test_a_scene_that_most_seeds_lose_gives_no_bounds(tmp_path: Path) -> None:
    # In the place of the command: every track is a bad one.
    stand_in = tmp_path / "asttrack"
    line = "result name=a frames=9 cle=90 precision20=0.4 success=0.3 fps=1 lost=0"
    stand_in.write_text(f'#!/bin/sh\n[ "$1" = synth ] && mkdir "$2"\n[ "$1" = --version ] && echo "JPEG: yes"\necho "{line}"\n')
    stand_in.chmod(0o755)
    done = check(tmp_path, "scene:3 8 0.9 0.5\n", "--command", stand_in, "--sequences", tmp_path, "--update")
    assert done.returncode == 1
    assert "most seeds lose scene:3" in done.stderr
    assert (tmp_path / "bounds.txt").read_text() == "scene:3 8 0.9 0.5\n"


@pytest.mark.parametrize(
    ("bounds", "message"),
    [
        ("", "bounds.txt: no bounds in it"),
        ("small 1 1\n", "bounds.txt:1: not a new name and three numbers"),
        ("a 1 1 1\na 1 1 1\n", "bounds.txt:2: not a new name and three numbers"),
        ("none 1 1 1\n", "none: "),
    ],
)
def test_what_cannot_be_checked_is_one_line(sequences: Path, tmp_path: Path, bounds: str, message: str) -> None:
    done = check(tmp_path, bounds, "--sequences", sequences)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith("check_accuracy: ")
    assert message in line


def test_the_bounds_of_the_project_are_read_and_cover_the_eight(tmp_path: Path) -> None:
    text = (REPOSITORY / "tests" / "accuracy_bounds.txt").read_text()
    done = check(tmp_path, "\n".join(line for line in text.splitlines() if not line.startswith("scene:")))
    assert done.returncode == 0, done.stderr
    assert done.stdout == (
        "left out, as no --sequences: not there: "
        "surfer, coke_can, girl, tiger1, tiger2, coupon_book, occluded_face, occluded_face2\n"
    )
