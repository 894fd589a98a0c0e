"""What the command says on stderr."""

import sys


def say(message: str) -> None:
    """One line `asttrack: ...`. Control characters, which a file name may hold, become question marks: it stays one line."""
    print("asttrack: " + "".join(c if c.isprintable() else "?" for c in message), file=sys.stderr, flush=True)
