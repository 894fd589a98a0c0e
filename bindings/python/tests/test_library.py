"""Which library is loaded."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import asttrack

WHERE = "import asttrack; print(asttrack.library.path)"


def python(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Runs code in a new interpreter with the environment changed."""
    changed = {name: value for name, value in os.environ.items() if name != "ASTTRACK_LIBRARY"} | environment
    return subprocess.run([sys.executable, "-c", code], env=changed, capture_output=True, text=True, check=False)


@pytest.fixture
def own_library() -> Path:
    return Path(python(WHERE).stdout.strip())


def test_the_packages_own_library_is_the_default(own_library: Path) -> None:
    assert own_library.name == "libasttrack.so"
    assert own_library.parent.name == "asttrack"


def test_an_empty_variable_is_no_choice(own_library: Path) -> None:
    assert Path(python(WHERE, ASTTRACK_LIBRARY="").stdout.strip()) == own_library


def test_the_variable_names_another_library(own_library: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.so"
    shutil.copy(own_library, other)
    assert Path(python(WHERE, ASTTRACK_LIBRARY=str(other)).stdout.strip()) == other


@pytest.mark.parametrize("name", ["/nowhere/libasttrack.so", "libm.so.6", "/"])
def test_a_missing_file_is_named_and_system_paths_are_not_searched(name: str) -> None:
    run = python(WHERE, ASTTRACK_LIBRARY=name)
    assert run.returncode == 1
    assert run.stderr.splitlines()[-1] == f"ImportError: asttrack: ASTTRACK_LIBRARY={name}: there is no such file"


def test_it_says_what_it_is() -> None:
    assert asttrack.library.version.split(".")[:2] == asttrack.__version__.split(".")[:2]
    assert asttrack.library.backend in ("builtin", "lapacke")
    assert str(asttrack.library.path) in repr(asttrack.library)
