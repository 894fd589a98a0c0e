"""The C command, for tests that compare with it or have it render a scene."""

import os
import subprocess
from pathlib import Path

import pytest

from header import REPOSITORY


def find() -> Path:
    """The command `asttrack` of AST_COMMAND, or that of the build directory; without one the test is skipped."""
    path = Path(os.environ.get("AST_COMMAND", REPOSITORY / "build" / "asttrack")).resolve()
    if not path.is_file():
        pytest.skip(f"{path} is not there (make builds it, AST_COMMAND names another place)")
    return path


def run(*words: object) -> str:
    """What it prints."""
    done = subprocess.run([find(), *map(str, words)], capture_output=True, text=True, check=False, timeout=400)
    assert done.returncode == 0, done.stderr
    return done.stdout


def render(directory: Path, *options: object) -> Path:
    """A scene that it renders."""
    run("synth", directory, *options)
    return directory
