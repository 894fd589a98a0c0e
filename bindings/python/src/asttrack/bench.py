"""Speed of the library: of each stage, of builds beside each other, with the size of the problem."""

import json
import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from asttrack._library import ENVIRONMENT_VARIABLE, LIBRARY
from asttrack.evaluation.tables import align
from asttrack.failures import DataError
from asttrack.opencv import ONE_THREAD

Order = dict[str, Any]


def libraries_or_own(paths: Iterable[Path]) -> list[Path]:
    """The libraries to compare; without any, the one that is loaded. Raises DataError for what is not a file."""
    found = [path.resolve() for path in paths] or [LIBRARY.path]
    for path in found:
        if not path.is_file():
            raise DataError(f"{path}: no such file")
    return found


def measure(library: Path, order: Order) -> dict[str, Any]:
    """What a new process measures with a library. Raises DataError when it fails."""
    environment = {**os.environ, **ONE_THREAD, ENVIRONMENT_VARIABLE: str(library)}
    done = subprocess.run(
        [sys.executable, "-m", "asttrack.measuring"],
        input=json.dumps(order),
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        reason = (done.stderr.strip().splitlines() or [f"status {done.returncode}"])[-1]
        raise DataError(f"{library}: {reason}")
    outcome: dict[str, Any] = json.loads(done.stdout)
    if "error" in outcome:
        raise DataError(outcome["error"])
    return outcome


def stages_table(libraries: list[dict[str, Any]]) -> str:
    """Milliseconds of each stage, a column for each library."""
    lines = [["stage, ms (median)", *_heads(libraries)], []]
    medians = {stage: [library["stages"][stage]["median_ms"] for library in libraries] for stage in libraries[0]["stages"]}
    return align(lines + [[stage, *(f"{median:.4f}" for median in row)] for stage, row in medians.items()])


def sweeps_table(libraries: list[dict[str, Any]]) -> str:
    """Milliseconds of an update by the size of the problem, with the exponents of their growth."""
    lines = [["update by", "value", *_heads(libraries)]]
    for index, sweep in enumerate(libraries[0]["sweeps"]):
        lines.append([])
        for row, point in enumerate(sweep["points"]):
            cells = (f"{library['sweeps'][index]['points'][row]['median_ms']:.4f}" for library in libraries)
            lines.append([sweep["name"], str(point["value"]), *cells])
        lines.append([sweep["name"], "exponent", *(f"{library['sweeps'][index]['exponent']:.2f}" for library in libraries)])
    return align(lines)


def _heads(libraries: list[dict[str, Any]]) -> list[str]:
    return [f"{library['backend']} {library['version']}" for library in libraries]
