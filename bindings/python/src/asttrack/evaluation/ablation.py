"""Files that list variants of our tracker to compare."""

import sys
from pathlib import Path
from typing import Any

from asttrack.config import PRESETS
from asttrack.evaluation.trackers import AsttrackSpec
from asttrack.failures import DataError, unusable

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def read_variants(path: Path) -> list[AsttrackSpec]:
    """The variants of a TOML file, at least two, the one to compare with first.

        [[variant]]
        name = "robust"

        [[variant]]
        name = "geodesic only"
        preset = "robust"
        set = { alpha = 0.0 }

    Raises:
        DataError: the file, or a variant in it, is not one.
    """
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise unusable(path, error) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: {error}") from error
    tables = content.pop("variant", None)
    if content or not isinstance(tables, list) or len(tables) < 2:
        raise DataError(f"{path}: holds other things than two or more [[variant]] tables")
    specs = [_variant(table, f"{path}: variant {number}") for number, table in enumerate(tables, 1)]
    labels = [spec.label for spec in specs]
    for label in labels:
        if labels.count(label) > 1:
            raise DataError(f"{path}: two variants are called {label!r}")
    return specs


def _variant(table: Any, place: str) -> AsttrackSpec:
    if not isinstance(table, dict) or not isinstance(table.get("name"), str) or not table["name"].strip():
        raise DataError(f"{place}: has no name")
    place = f"{place} ({table['name']})"
    unknown = set(table) - {"name", "preset", "set"}
    if unknown:
        raise DataError(f"{place}: unknown key {min(unknown)!r}: there are name, preset, set")
    preset, changes = table.get("preset", "robust"), table.get("set", {})
    if preset not in PRESETS:
        raise DataError(f"{place}: there is no preset {preset!r}: there are {', '.join(PRESETS)}")
    if not isinstance(changes, dict) or not all(
        isinstance(value, int | float | str) and not isinstance(value, bool) for value in changes.values()
    ):
        raise DataError(f"{place}: set is not a table of fields with numbers or names")
    return AsttrackSpec(table["name"], preset, tuple(changes.items()))
