"""Progress on stderr, where that is a terminal."""

from collections.abc import Iterable
from typing import TypeVar

from tqdm import tqdm

Item = TypeVar("Item")


def shown(items: Iterable[Item], total: int | None, unit: str) -> Iterable[Item]:
    """Passes the items on and draws a bar."""
    return tqdm(items, total=total, unit=f" {unit}", disable=None, dynamic_ncols=True, leave=False)
