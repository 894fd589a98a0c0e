"""The order of numbered files, 9 before 10: the same as the C command's (examples/sequence.c)."""

import os
import re

_PIECE = re.compile(rb"[0-9]+|[^0-9]")


def natural_key(name: str) -> tuple[tuple[int, bytes], ...]:
    """What to sort names of files by: runs of digits compare as numbers of any length, all else byte by byte.

    The extension is left out, and so are leading zeros: `7.pgm` and `07.jpg` have the same key.
    """
    whole = os.fsencode(name)
    stem = whole.rpartition(b".")[0] or whole
    return tuple(map(_piece_key, _PIECE.findall(stem)))


def _piece_key(piece: bytes) -> tuple[int, bytes]:
    """Every number lies where the digits do among the bytes; of two numbers the longer is the larger."""
    if not piece.isdigit():
        return piece[0], b""
    digits = piece.lstrip(b"0")
    return ord("0"), len(digits).to_bytes(4, "big") + digits
