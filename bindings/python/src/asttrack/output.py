"""Files that appear whole or not at all: written under a temporary name beside the target, then renamed over it."""

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from asttrack.failures import DataError, unusable


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Gives the name to write to; it becomes `target` when the block ends well and is removed when it does not.

    The name ends as the target's does, because video writers choose their format by it. Symbolic links are followed; a device or a
    pipe is written in place, since a rename would replace it.

    Raises:
        DataError: the file cannot be written.
    """
    try:
        final = target.resolve()
        if final.is_dir():
            raise DataError(f"{target}: is a directory")
        if final.exists() and not final.is_file():
            yield final
            return
        temporary = final.with_name(f".{final.stem[:100]}-{secrets.token_hex(4)}{final.suffix}")
        try:
            # Made here rather than by the writer: a directory that takes no files is found before the work.
            os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
            yield temporary
            _settle(temporary)
            temporary.replace(final)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise unusable(target, error) from error


def write_text(target: Path, text: str) -> None:
    """Replaces a file by `text` in UTF-8. Raises DataError."""
    write_bytes(target, text.encode())


def write_bytes(target: Path, content: bytes) -> None:
    """Replaces a file by `content`. Raises DataError."""
    with replacing(target) as path:
        path.write_bytes(content)


def make_directory(directory: Path) -> None:
    """Makes a directory for results and tries it, so that hours of work do not end at a door that is locked. Raises DataError."""
    try:
        directory.mkdir(parents=True, exist_ok=True)
        probe = directory / f".{secrets.token_hex(4)}"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise unusable(directory, error) from error


def _settle(path: Path) -> None:
    """Waits until the bytes are on the disk: only then is the rename a promise."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
