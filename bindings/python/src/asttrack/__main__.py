"""`python -m asttrack`: follow, evaluate, measure."""

import argparse
import os
import signal
import sys
from collections.abc import Sequence
from typing import NoReturn

from asttrack import __version__
from asttrack.command import bench, evaluate, fleet, gallery, recovery, track
from asttrack.command.speech import say
from asttrack.failures import DataError, UsageError

USAGE, DATA = 2, 1
# Modules that an installation may lack: what they are called, and the extra that brings them.
EXTRAS = {
    "cv2": ("OpenCV", "eval"),
    "matplotlib": ("matplotlib", "eval"),
    "tqdm": ("tqdm", "eval"),
    "tomli": ("tomli", "eval"),
    "dask": ("dask", "fleet"),
    "distributed": ("dask.distributed", "fleet"),
    "pyarrow": ("pyarrow", "fleet"),
}


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """One line instead of a page of usage."""
        say(f"{message} (see {self.prog} --help)")
        sys.exit(USAGE)


def parser() -> argparse.ArgumentParser:
    """The arguments of all sub-commands."""
    whole = _Parser(
        prog="python -m asttrack", description="Follow one object through a video from a single box, and measure how well."
    )
    whole.add_argument("--version", action="version", version=f"asttrack {__version__}")
    commands = whole.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for module in (track, evaluate, recovery, bench, fleet, gallery):
        module.add(commands)
    return whole


def main(words: Sequence[str] | None = None) -> int:
    """Runs a command line; 0 when all went well, 1 for data that could not be used, 2 for arguments that make no sense."""
    arguments = parser().parse_args(words)
    try:
        code: int = arguments.run(arguments)
        sys.stdout.flush()
    except UsageError as error:
        say(str(error))
        return USAGE
    except DataError as error:
        say(str(error))
        return DATA
    except ModuleNotFoundError as error:
        name, extra = EXTRAS.get((error.name or "").partition(".")[0], (None, None))
        if name is None:
            raise
        say(f"{arguments.command}: needs {name}, which is not installed: pip install './bindings/python[{extra}]' in its sources")
        return DATA
    except KeyboardInterrupt:
        say("interrupted")
        return 130
    except BrokenPipeError:
        # The reader of our output has seen enough. Python flushes stdout once more at its end: give it something to flush to.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DATA
    return code


if __name__ == "__main__":
    # Told to end is like interrupted from the keyboard: what is finished is kept.
    # A shell starts what it runs in the background with SIGINT ignored; a run of hours must be able to end and keep what it has.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGTERM, lambda _number, _frame: signal.raise_signal(signal.SIGINT))
    sys.exit(main())
