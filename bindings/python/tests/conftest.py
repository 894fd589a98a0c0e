"""What holds for all tests."""

import signal


def pytest_configure() -> None:
    """Interrupts arrive, in the tests and in the programs that they start, also where a shell started pytest with them ignored."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
