"""Progress: what a terminal shows of it, and when."""

import io
import sys
from collections.abc import Iterator

import pytest

from asttrack.progress import shown


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_each_item_is_shown_before_the_next_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    waiting: list[str] = []

    def items() -> Iterator[int]:
        for item in range(3):
            waiting.append(terminal.getvalue())
            yield item

    assert list(shown(items(), 3, "run")) == [0, 1, 2]
    assert all(f"{done}/3" in text for done, text in enumerate(waiting))


def test_nothing_is_shown_elsewhere(capsys: pytest.CaptureFixture[str]) -> None:
    assert list(shown(range(3), 3, "run")) == [0, 1, 2]
    assert capsys.readouterr() == ("", "")
