"""A terminal for a command to show its progress on."""

import fcntl
import os
import pty
import struct
import termios
from collections.abc import Callable


def open_terminal() -> tuple[int, int]:
    """A reader of what is shown, and the terminal to give to the command (and to close then)."""
    reader, terminal = pty.openpty()
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("4H", 24, 100, 0, 0))
    return reader, terminal


def shown_until(reader: int, enough: Callable[[str], bool]) -> str:
    """What is shown, until it is enough or the command is gone."""
    text = ""
    while not enough(text):
        try:
            piece = os.read(reader, 4096)
        except OSError:  # Linux says so when the other end of a terminal is closed
            break
        if not piece:
            break
        text += piece.decode(errors="replace")
    return text


def all_shown(reader: int) -> str:
    """What is shown until the command is gone."""
    return shown_until(reader, lambda _: False)
