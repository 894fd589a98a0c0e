"""Finds libasttrack, loads it, and makes sure that it is the library that this package was written for."""

import ctypes
import os
from dataclasses import dataclass, field
from importlib import metadata, resources
from pathlib import Path
from typing import Any

from asttrack import _abi
from asttrack.errors import AstError

ENVIRONMENT_VARIABLE = "ASTTRACK_LIBRARY"
FILE_NAME = "libasttrack.so"

_FIELD_TYPES: dict[int, type[Any]] = {
    _abi.FIELD_INT: ctypes.c_int32,
    _abi.FIELD_FLOAT: ctypes.c_float,
    _abi.FIELD_ENUM: ctypes.c_int32,
    _abi.FIELD_SEED: ctypes.c_uint64,
}
# Far more than any ast_config: what a library of another version writes must not run over.
_PROBE_BYTES = 4096


@dataclass(frozen=True)
class Library:
    """A loaded and checked library.

    Attributes:
        path: the file.
        calls: its functions, with the prototypes of `_abi`. Calls release the GIL.
        config: a `ctypes.Structure` laid out as the library's `ast_config`.
        fields: the rows of the library's table of configuration fields.
    """

    path: Path
    calls: ctypes.CDLL = field(repr=False)
    config: type[ctypes.Structure] = field(repr=False)
    fields: tuple[_abi.ConfigField, ...] = field(repr=False)

    @property
    def version(self) -> str:
        """MAJOR.MINOR.PATCH of the library; its first two numbers are the package's."""
        return str(self.calls.ast_version().decode())

    @property
    def backend(self) -> str:
        """The library's linear algebra: "builtin" or "lapacke"."""
        return str(self.calls.ast_backend().decode())

    def text(self, code: int) -> str:
        """The library's own words for a return code."""
        return str(self.calls.ast_strerror(code).decode())

    def check(self, code: int) -> None:
        """Raises `AstError` when `code`, or a count returned in its place, is negative."""
        if code < 0:
            raise AstError(code, self.text(code))


def find() -> Path:
    """The library to load: the file that ASTTRACK_LIBRARY names, otherwise the one inside this package; never a system path."""
    named = os.environ.get(ENVIRONMENT_VARIABLE)
    if named:
        path = Path(named).expanduser().resolve()
        if not path.is_file():
            raise ImportError(f"asttrack: {ENVIRONMENT_VARIABLE}={named}: there is no such file")
        return path
    path = Path(str(resources.files("asttrack").joinpath(FILE_NAME)))
    if not path.is_file():
        raise ImportError(
            f"asttrack: this installation has no {FILE_NAME}: install the package with pip, "
            f"or name a library in {ENVIRONMENT_VARIABLE}"
        )
    return path


def load(path: Path, version: str) -> Library:
    """Loads the library at `path` and checks it against `version` (the package's) and the table of its own fields.

    Raises:
        ImportError: it cannot be loaded, is something else, or its interface is another one.
    """
    try:
        calls = ctypes.CDLL(str(path))
    except OSError as error:
        raise ImportError(f"asttrack: cannot load {path}: {error}") from error
    _check_version(calls, path, version)
    for name, (result, arguments) in _abi.PROTOTYPES.items():
        _require(calls, path, name)
        function = getattr(calls, name)
        function.restype = result
        function.argtypes = arguments
    fields = _fields(calls)
    return Library(path, calls, _config_type(calls, path, fields), fields)


def _require(calls: ctypes.CDLL, path: Path, name: str) -> None:
    if not hasattr(calls, name):
        raise ImportError(f"asttrack: {path} is not a libasttrack that fits this package: it has no {name}")


def _check_version(calls: ctypes.CDLL, path: Path, version: str) -> None:
    _require(calls, path, "ast_version")
    calls.ast_version.restype = ctypes.c_char_p
    theirs = calls.ast_version().decode()
    if theirs.split(".")[:2] != version.split(".")[:2]:
        raise ImportError(f"asttrack: {path} is version {theirs}, but this package is version {version}: major.minor must agree")


def _fields(calls: ctypes.CDLL) -> tuple[_abi.ConfigField, ...]:
    count = ctypes.c_int32()
    rows = calls.ast_config_fields(ctypes.byref(count))
    return tuple(rows[: count.value])


def _config_type(calls: ctypes.CDLL, path: Path, fields: tuple[_abi.ConfigField, ...]) -> type[ctypes.Structure]:
    """Lays ast_config out from the table, and compares that with the offsets in the table and the size that the library writes."""
    members: list[tuple[str, type[Any]]] = [("struct_size", ctypes.c_uint32)]
    for row in fields:
        if row.kind not in _FIELD_TYPES:
            raise ImportError(f"asttrack: {path}: configuration field {row.name.decode()} is of unknown kind {row.kind}")
        members.append((row.name.decode(), _FIELD_TYPES[row.kind]))
    config = type("Config", (ctypes.Structure,), {"_fields_": members})

    for row in fields:
        offset = getattr(config, row.name.decode()).offset
        if offset != row.offset:
            raise ImportError(
                f"asttrack: {path}: configuration field {row.name.decode()} lies at byte {row.offset}, expected at {offset}"
            )
    probe = (ctypes.c_uint32 * (_PROBE_BYTES // 4))()
    calls.ast_config_preset(probe, _abi.PRESETS["robust"])
    if probe[0] != ctypes.sizeof(config):
        raise ImportError(f"asttrack: {path}: ast_config has {probe[0]} bytes, expected {ctypes.sizeof(config)}")
    return config


VERSION = metadata.version("asttrack")
LIBRARY = load(find(), VERSION)
