"""Which library is loaded."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import asttrack
from header import compile_shared

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


DECOY = """
#include <stdio.h>
#include <stdlib.h>
__attribute__((constructor)) static void loaded(void) { puts("a decoy was loaded"); abort(); }
const char *ast_version(void) { return "0.1.0"; }
"""
MAPPED = """
import os, re, asttrack
asttrack.Tracker("tiny")
with open(f"/proc/{os.getpid()}/maps") as maps:
    print(*sorted({line.split()[-1] for line in maps if "libasttrack" in line}), sep="\\n")
"""


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="no /proc to see what is loaded")
def test_a_library_of_the_same_name_elsewhere_is_not_loaded(own_library: Path, tmp_path: Path) -> None:
    """Not from the working directory, not from the loader's path, not from beside the program, under any usual name."""
    decoy = compile_shared(DECOY, tmp_path)
    for name in ("libasttrack.so", "libasttrack.so.0", "libasttrack.so.0.1.0"):
        shutil.copy(decoy, tmp_path / name)
    program = tmp_path / "program.py"
    program.write_text(MAPPED)
    searched = {"LD_LIBRARY_PATH": str(tmp_path), "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}"}
    environment = {name: value for name, value in os.environ.items() if name != "ASTTRACK_LIBRARY"} | searched
    run = subprocess.run([sys.executable, str(program)], env=environment, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.split() == [str(own_library)]
