"""What ends a command with one line on stderr instead of a traceback."""

from pathlib import Path


class DataError(Exception):
    """A file, a frame, a box or a place to write to that cannot be used. The message is one line naming it and the reason."""


class SourceError(DataError):
    """A source of frames that failed after its first frame: what came before is good."""


class UsageError(Exception):
    """Arguments that make no sense, whatever the data. The message is one line."""


class MissingExtraError(DataError):
    """Something optional that is not installed.

    Args:
        what: what cannot be done without it.
        extra: the extra of this package that brings it.
    """

    def __init__(self, what: str, extra: str) -> None:
        super().__init__(f"{what}: pip install './bindings/python[{extra}]' in its sources")
        self.what = what
        self.extra = extra

    def __reduce__(self) -> tuple[type["MissingExtraError"], tuple[str, str]]:
        """Pickles by its arguments: worker processes raise it, too."""
        return type(self), (self.what, self.extra)


def unusable(path: Path | str, error: OSError) -> DataError:
    """An operating system's refusal in one line."""
    return DataError(f"{path}: {error.strerror or error}")
