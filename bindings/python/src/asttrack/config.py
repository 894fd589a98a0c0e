"""Configurations by field name: presets, values from keywords, and what they are called."""

import ctypes
import difflib
import operator
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, SupportsFloat, SupportsIndex, TypeAlias

import numpy as np

from asttrack import _abi
from asttrack._library import LIBRARY
from asttrack.errors import AstError, ErrorCode

ConfigValue: TypeAlias = SupportsIndex | SupportsFloat | str
"""A value that a configuration field takes: an int, a float, or the name of a choice."""

_KINDS: dict[int, Literal["int", "float", "enum", "seed"]] = {
    _abi.FIELD_INT: "int",
    _abi.FIELD_FLOAT: "float",
    _abi.FIELD_ENUM: "enum",
    _abi.FIELD_SEED: "seed",
}
_SEED_LIMIT = 2**64
_INT_LIMIT = 2**31


@dataclass(frozen=True)
class ConfigField:
    """One field of a tracker's configuration; asttrack.h says what each means.

    Attributes:
        name: as a keyword of `Tracker`.
        kind: "int", "float", "enum" (one of `choices`, by name or index) or "seed" (an int of 64 bits).
        choices: names of the values 0, 1, .. of an enum; empty otherwise.
        minimum: least legal value.
        maximum: greatest legal value, inclusive.
    """

    name: str
    kind: Literal["int", "float", "enum", "seed"]
    choices: tuple[str, ...]
    minimum: float
    maximum: float


def _field(row: _abi.ConfigField) -> ConfigField:
    kind = _KINDS[row.kind]
    choices: list[str] = []
    while kind == "enum" and row.choices[len(choices)] is not None:
        choices.append(row.choices[len(choices)].decode())
    minimum: float = 0
    maximum: float = _SEED_LIMIT - 1
    if kind != "seed":
        shown = _shortest if kind == "float" else int
        minimum, maximum = shown(row.minimum), shown(row.maximum)
    return ConfigField(row.name.decode(), kind, tuple(choices), minimum, maximum)


def _shortest(value: float) -> float:
    """0.01 rather than 0.009999999776482582: what is written shortest and gives the same C float."""
    return float(str(np.float32(value)))


FIELDS = {field.name: field for field in map(_field, LIBRARY.fields)}
PRESETS = tuple(_abi.PRESETS)


def config_fields() -> tuple[ConfigField, ...]:
    """All configuration fields, in the order of `ast_config`; read from the library that is loaded."""
    return tuple(FIELDS.values())


def make(preset: str, changes: Mapping[str, ConfigValue]) -> ctypes.Structure:
    """An `ast_config`: the preset with `changes` applied, checked by the library.

    Raises:
        ValueError: no such preset.
        TypeError: no such field, or a value of the wrong type.
        AstError: a value is illegal; `field` names it.
    """
    if preset not in _abi.PRESETS:
        raise ValueError(f"preset must be one of {', '.join(map(repr, PRESETS))}, not {preset!r}")
    config = LIBRARY.config()
    LIBRARY.check(LIBRARY.calls.ast_config_preset(ctypes.byref(config), _abi.PRESETS[preset]))
    for name, value in changes.items():
        if name not in FIELDS:
            close = difflib.get_close_matches(name, FIELDS, n=3)
            hint = f"did you mean {' or '.join(close)}?" if close else f"there are {', '.join(FIELDS)}"
            raise TypeError(f"unknown configuration field {name!r}: {hint}")
        setattr(config, name, _number(FIELDS[name], value))
    culprit = ctypes.c_char_p()
    code = LIBRARY.calls.ast_config_check(ctypes.byref(config), ctypes.byref(culprit))
    if code != 0:
        raise _refused(config, code, culprit.value)
    return config


def values(config: ctypes.Structure) -> dict[str, int | float | str]:
    """The fields of an `ast_config` by name; enums by the names of their choices."""
    return {field.name: _readable(field, getattr(config, field.name)) for field in FIELDS.values()}


def exact_values(config: ctypes.Structure) -> dict[str, int | float]:
    """The fields of an `ast_config` by name, as the numbers that are stored."""
    return {name: getattr(config, name) for name in FIELDS}


def _readable(field: ConfigField, value: int | float) -> int | float | str:
    if field.kind == "enum":
        return field.choices[int(value)]
    return _shortest(value) if field.kind == "float" else value


def _number(field: ConfigField, value: ConfigValue) -> int | float:
    """`value` as the C member takes it. Ranges are the library's affair, but for what the member cannot hold."""
    if isinstance(value, str) and field.kind == "enum":
        if value not in field.choices:
            raise AstError(ErrorCode.CONFIG, f"{field.name}={value!r}: it takes {_wanted(field)}", field.name)
        return field.choices.index(value)
    if field.kind == "float" and isinstance(value, SupportsFloat | SupportsIndex):
        try:
            return float(value)
        except OverflowError:
            raise _out_of_range(field, value) from None
    if field.kind == "float" or not isinstance(value, SupportsIndex):
        raise TypeError(f"{field.name} takes {_wanted(field)}, not {value!r} ({type(value).__name__})")
    number = operator.index(value)
    if not (0 <= number < _SEED_LIMIT if field.kind == "seed" else -_INT_LIMIT <= number < _INT_LIMIT):
        raise _out_of_range(field, number)
    return number


def _wanted(field: ConfigField) -> str:
    if field.kind == "enum":
        return f"one of {', '.join(map(repr, field.choices))} or an index into them"
    return "a number" if field.kind == "float" else "an int"


def _out_of_range(field: ConfigField, value: object) -> AstError:
    form = "g" if field.kind == "float" else "d"
    legal = f"{field.minimum:{form}} .. {field.maximum:{form}}"
    return AstError(ErrorCode.CONFIG, f"{field.name}={value}: the legal range is {legal}", field.name)


def _refused(config: ctypes.Structure, code: int, culprit: bytes | None) -> AstError:
    if code != ErrorCode.CONFIG or culprit is None:
        return AstError(code, LIBRARY.text(code))
    field = FIELDS[culprit.decode()]
    value = getattr(config, field.name)
    if not field.minimum <= value <= field.maximum:
        return _out_of_range(field, value)
    return AstError(code, f"{field.name}={_readable(field, value)}: legal by itself, but not with the other fields", field.name)
