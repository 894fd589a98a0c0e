"""Progress on stderr, where that is a terminal."""

from collections.abc import Iterable
from typing import TypeVar

from tqdm import tqdm

Item = TypeVar("Item")


def shown(items: Iterable[Item], total: int | None, unit: str, pause: float = 0.0) -> Iterable[Item]:
    """Passes the items on and draws a bar.

    Args:
        items: what is passed on.
        total: how many there are.
        unit: what one of them is.
        pause: seconds for which the bar is not drawn again, where items come fast. Otherwise each is shown at once: several may
            come together, and the next one hours later.
    """
    return tqdm(items, total=total, unit=f" {unit}", disable=None, dynamic_ncols=True, leave=False, mininterval=pause, miniters=1)
