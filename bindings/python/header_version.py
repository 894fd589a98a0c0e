"""Build time only: gives the package the version that the C header states, the one place where it is written."""

import re
from collections.abc import Mapping
from pathlib import Path

HERE = Path(__file__).resolve().parent


def dynamic_metadata(_settings: Mapping[str, object], _project: Mapping[str, object]) -> dict[str, str]:
    """Hook of the build backend: the project's fields that this provider fills."""
    # A source distribution is known by its PKG-INFO and carries the core below core/; in a clone the core lies two levels up.
    core = HERE / "core" if (HERE / "PKG-INFO").exists() else HERE.parents[1]
    header = core / "include" / "asttrack.h"
    text = header.read_text(encoding="utf-8")
    numbers = []
    for part in ("MAJOR", "MINOR", "PATCH"):
        found = re.search(rf"^#define AST_VERSION_{part} (\d+)$", text, re.MULTILINE)
        if found is None:
            raise ValueError(f"{header} does not define AST_VERSION_{part}")
        numbers.append(found[1])
    return {"version": ".".join(numbers)}
