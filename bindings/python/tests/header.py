"""The C header that the binding mirrors, and a compiler to ask about it."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]
INCLUDE = REPOSITORY / "include"


def header_text() -> str:
    """asttrack.h without its comments."""
    text = (INCLUDE / "asttrack.h").read_text(encoding="utf-8")
    return re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)


def compiler() -> str:
    """The C compiler's command; the test is skipped where there is none."""
    command = os.environ.get("CC", "cc")
    found = shutil.which(command)
    if found is None:
        pytest.skip(f"no C compiler {command!r} to read the header with")
    return found


def compile_shared(source: str, folder: Path) -> Path:
    """A shared object of C source text."""
    code, library = folder / "stub.c", folder / "stub.so"
    code.write_text(source, encoding="utf-8")
    subprocess.run([compiler(), "-shared", "-fPIC", f"-I{INCLUDE}", "-o", library, code], check=True)
    return library


def run_program(source: str, folder: Path) -> str:
    """What a C program prints."""
    code, program = folder / "program.c", folder / "program"
    code.write_text(source, encoding="utf-8")
    subprocess.run([compiler(), "-std=c99", f"-I{INCLUDE}", "-o", program, code], check=True)
    return subprocess.run([program], check=True, capture_output=True, text=True).stdout
