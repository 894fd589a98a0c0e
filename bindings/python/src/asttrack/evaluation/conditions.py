"""Where and how figures came about: what makes them comparable, or not."""

import os
import platform
import shlex
import sys
from dataclasses import asdict, dataclass
from datetime import datetime, timezone
from pathlib import Path

import cv2
import numpy as np

from asttrack import __version__
from asttrack._library import LIBRARY


@dataclass(frozen=True)
class Conditions:
    """The circumstances of a measurement.

    Attributes:
        command: as it was given.
        date: when it began, UTC, ISO 8601.
        asttrack: version.
        backend: the library's linear algebra.
        opencv: version.
        numpy: version.
        python: version.
        processor: its name.
        cores: of the machine.
        jobs: processes at a time.
        load: processes that wanted a core in the minute before; nan where the system does not say.
    """

    command: str
    date: str
    asttrack: str
    backend: str
    opencv: str
    numpy: str
    python: str
    processor: str
    cores: int
    jobs: int
    load: float

    def as_dict(self) -> dict[str, str | int | float]:
        """All of it by name."""
        return asdict(self)


def conditions(jobs: int) -> Conditions:
    """The circumstances now."""
    return Conditions(
        command="python -m asttrack " + shlex.join(sys.argv[1:]),
        date=datetime.now(timezone.utc).isoformat(timespec="seconds"),
        asttrack=__version__,
        backend=LIBRARY.backend,
        opencv=cv2.__version__,
        numpy=np.__version__,
        python=platform.python_version(),
        processor=_processor(),
        cores=os.cpu_count() or 1,
        jobs=jobs,
        load=round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else float("nan"),
    )


def _processor() -> str:
    """Linux alone knows the processor's name where Python does not."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    named = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "")
    return named or platform.processor() or platform.machine()
