"""The figures that `make bench` writes: the C library's own, measured without Python."""

from pathlib import Path
from typing import Any

from asttrack.evaluation.tables import align
from asttrack.json_file import read_figures

_PARTS = ("conditions", "sequences", "growth", "roofline", "threads", "instructions")


def read_core(path: Path) -> dict[str, Any]:
    """Reads them. Raises DataError for what `make bench` has not written."""
    return read_figures(path, _PARTS, "make bench")


def spread_text(spread: dict[str, Any] | None, digits: int) -> str:
    """`median [least greatest]`; a dash where there is nothing."""
    if spread is None or spread["median"] is None:
        return "-"
    middle, low, high = (f"{spread[end]:.{digits}f}" for end in ("median", "least", "greatest"))
    return f"{middle} [{low} {high}]"


def backends(core: dict[str, Any]) -> list[str]:
    """The linear algebras that were measured, in their order."""
    return list(dict.fromkeys(step["backend"] for sequence in core["sequences"] for step in sequence["steps"]))


def ratio_of(sequence: dict[str, Any], above: str, below: str, stage: str = "step") -> dict[str, Any] | None:
    """The quotient of two of a sequence's steps, or of their stages."""
    for ratio in sequence["ratios"]:
        if (ratio["above"], ratio["below"], ratio["stage"]) == (above, below, stage):
            spread: dict[str, Any] = ratio["ratio"]
            return spread
    return None


def core_table(core: dict[str, Any]) -> str:
    """The heart of them as text; `make bench` itself prints all."""
    lines = [["make bench: sequence", "step", "backend", "ms", "literal / gram"], []]
    for sequence in core["sequences"]:
        for step in sequence["steps"]:
            literal = ratio_of(sequence, f"paper, literal, {step['backend']}", f"{step['name']}, {step['backend']}")
            cells = [spread_text(step["step_ms"], 3), spread_text(literal, 1)]
            lines.append([sequence["sequence"], step["name"], step["backend"], *cells])
    return align(lines)
