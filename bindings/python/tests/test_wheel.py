"""The wheel and the source distribution, built and installed as a user does.

Building fetches the build backend, and installing fetches numpy, from the package index (or pip's cache of it).
"""

import os
import re
import shutil
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

from header import REPOSITORY, header_text

PACKAGE = REPOSITORY / "bindings" / "python"
TRACK = """
import numpy as np, asttrack
frame = np.random.default_rng(0).integers(0, 256, (120, 160), dtype=np.uint8)
tracker = asttrack.Tracker("tiny")
tracker.init(frame, (40, 40, 30, 30))
result = tracker.update(np.roll(frame, 2, axis=1))
assert abs(result.box.x - 42) < 3 and result.status is asttrack.Status.TRACKING, result
print(asttrack.__version__, asttrack.library.version, asttrack.library.backend, asttrack.library.path)
"""
SOURCES = {
    f"core/{path.relative_to(REPOSITORY).as_posix()}"
    for path in [*(REPOSITORY / "src").glob("*.[ch]"), REPOSITORY / "include" / "asttrack.h"]
}


def run(*command: object, **options: object) -> str:
    """What a command prints; its complaints too when it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)  # type: ignore[call-overload]
    assert done.returncode == 0, f"{command[0]} failed:\n{done.stdout}\n{done.stderr}"
    return str(done.stdout)


def build_wheel(source: Path, folder: Path) -> Path:
    run(sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", folder, source)
    (wheel,) = folder.glob("*.whl")
    return wheel


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_wheel(PACKAGE, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def source_distribution(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("sdist")
    run(sys.executable, "-m", "build", "--sdist", "--outdir", folder, PACKAGE)
    (archive,) = folder.glob("*.tar.gz")
    return archive


def contents(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as archive:
        return set(archive.namelist())


def test_the_wheel_holds_the_package_and_its_library(wheel: Path) -> None:
    version = ".".join(re.findall(r"#define AST_VERSION_\w+ (\d+)", header_text()))
    assert re.fullmatch(rf"asttrack-{re.escape(version)}-py3-none-\w+\.whl", wheel.name)
    assert "any" not in wheel.name
    files = {path.relative_to(PACKAGE / "src") for path in (PACKAGE / "src").rglob("*") if path.is_file()}
    assert contents(wheel) >= {path.as_posix() for path in files if "__pycache__" not in path.parts} | {
        "asttrack/libasttrack.so",
        "asttrack/py.typed",
        f"asttrack-{version}.dist-info/licenses/LICENSE",
    }
    with zipfile.ZipFile(wheel) as archive:
        assert archive.getinfo("asttrack/libasttrack.so").file_size < 400_000


@pytest.mark.skipif(shutil.which("readelf") is None, reason="no readelf to look into the library with")
def test_the_library_needs_nothing_but_libc_and_exports_nothing_but_its_interface(wheel: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        library = archive.extract("asttrack/libasttrack.so", tmp_path)
    needed = set(re.findall(r"\(NEEDED\).*\[(.*?)\]", run("readelf", "--dynamic", library)))
    assert needed <= {"libc.so.6", "libm.so.6"}
    symbols = [line.split() for line in run("readelf", "--dyn-syms", "--wide", library).splitlines()]
    exported = {words[7] for words in symbols if len(words) > 7 and words[4] == "GLOBAL" and words[6] not in ("UND", "Ndx")}
    assert exported == set(re.findall(r"^AST_API [^(]*?(ast_\w+)\(", header_text(), re.MULTILINE))


def test_the_source_distribution_holds_the_core(source_distribution: Path) -> None:
    with tarfile.open(source_distribution) as archive:
        names = archive.getnames()
    inside = {name.partition("/")[2] for name in names}
    assert len(inside) == len(names)
    assert inside >= SOURCES | {"pyproject.toml", "CMakeLists.txt", "README.md", "LICENSE", "PKG-INFO", "src/asttrack/py.typed"}


@pytest.mark.slow
def test_the_wheel_of_the_source_distribution_is_the_same(wheel: Path, source_distribution: Path, tmp_path: Path) -> None:
    again = build_wheel(source_distribution, tmp_path)
    assert again.name == wheel.name
    assert contents(again) == contents(wheel)


@pytest.mark.slow
def test_a_fresh_environment_without_a_compiler_tracks(wheel: Path, tmp_path: Path) -> None:
    home = tmp_path / "fresh"
    venv.create(home, with_pip=True)
    python = home / "bin" / "python"
    # No compiler, no make, no CMake: nothing but the environment's own programs is to be found.
    bare = {name: value for name, value in os.environ.items() if name not in ("ASTTRACK_LIBRARY", "PYTHONPATH", "LD_LIBRARY_PATH")}
    bare["PATH"] = str(home / "bin")
    assert shutil.which("cc", path=bare["PATH"]) is None
    run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", wheel, env=bare, cwd=tmp_path)
    version, library_version, backend, path = run(python, "-c", TRACK, env=bare, cwd=tmp_path).split()
    assert version == library_version
    assert backend == "builtin"
    assert Path(path).is_relative_to(home)
    run(python, "-m", "pip", "check", env=bare, cwd=tmp_path)
