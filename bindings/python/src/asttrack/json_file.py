"""Figures kept as JSON, read again."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from asttrack.failures import DataError, unusable


def read_figures(path: Path, parts: Iterable[str], writer: str) -> dict[str, Any]:
    """The object in a file, which must have these parts; `writer` is the command whose file it should be.

    Raises DataError for any other file.
    """
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise unusable(path, error) from error
    except ValueError as error:
        raise DataError(f"{path}: not JSON") from error
    missing = [part for part in parts if not isinstance(found, dict) or part not in found]
    if missing:
        raise DataError(f"{path}: not the figures of `{writer}`: no {', '.join(missing)}")
    figures: dict[str, Any] = found
    return figures
