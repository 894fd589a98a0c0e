"""The command's figures are the evaluation's: one convention of what counts, in C and in Python."""

import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import c_command


def evaluated(directory: Path, out: Path, options: list[str]) -> dict[str, str]:
    """The line of results.csv, from the library that was built with the command."""
    library = c_command.find().parent / "libasttrack.so"
    if not library.exists():
        pytest.skip(f"{library} is not there (make builds it)")
    subprocess.run(
        [sys.executable, "-m", "asttrack", "eval", directory, *options, "--out", out],
        env={**os.environ, "ASTTRACK_LIBRARY": str(library)},
        capture_output=True,
        check=True,
        timeout=400,
    )
    with (out / "results.csv").open() as stream:
        (line,) = csv.DictReader(stream)
    return line


@pytest.mark.parametrize("preset", ["robust", "tiny"])
def test_command_and_evaluation_give_the_same_figures(tmp_path: Path, preset: str) -> None:
    scene = c_command.render(tmp_path / "scene", "--frames", 60, "--size", "160x120", "--seed", 4)
    truth = scene / "groundtruth.txt"
    lines = truth.read_text().splitlines()
    # The evaluation rounds the first box, so it is whole here; a hole of each kind; some truth far off, for figures below 1.
    lines[0] = ",".join(f"{float(side):.0f}" for side in lines[0].split(","))
    lines[5], lines[6] = "nan,nan,nan,nan", "0,0,0,0"
    for frame in range(20, 29):
        x, rest = lines[frame].split(",", 1)
        lines[frame] = f"{float(x) + 24:.2f},{rest}"
    truth.write_text("\n".join(lines) + "\n")

    said = c_command.run("track", scene, "--preset", preset)
    told = {key: float(value) for key, value in re.findall(r" (cle|precision20|success|lost)=(\S+)", said)}
    line = evaluated(scene, tmp_path / "out", ["--preset", preset, "--seeds", "1"])
    assert int(line["compared"]) == 60 - 1 - 2
    assert float(line["precision"]) < 1
    # As many digits as the command prints.
    for key, column, digits in (("cle", "centre_error", 1), ("precision20", "precision", 3), ("success", "success", 3)):
        assert told[key] == pytest.approx(float(line[column]), abs=0.51 * 0.1**digits), (said, line)
    assert told["lost"] == int(line["lost"])
