"""Trackers on the same frames in turns: how fast each is, for how long it has the object, and how many times faster ours are."""

import json
import os
import statistics
import subprocess
import sys
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from asttrack._library import ENVIRONMENT_VARIABLE
from asttrack.evaluation.tables import align
from asttrack.failures import DataError
from asttrack.opencv import ONE_THREAD

LOST_OVERLAP = 0.2
"""A tracker whose box overlaps the truth by no more than this has lost the object, from that frame on."""
RIVALS: tuple[tuple[str, bool], ...] = (("csrt", False), ("kcf", True))
"""Who ours are compared with, and whether only while the rival has the object: KCF gets fast when it has lost it."""
_LEAST_FRAMES = 5  # that a rival must have held the object for, to be compared with

Order = dict[str, Any]
Progress = Callable[[Iterable[Any], int], Iterable[Any]]


@dataclass
class Runner:
    """A tracker of the race, and its passes so far.

    Attributes:
        name: in tables.
        ours: one of this package's.
        backend: of the library, for ours.
        frames: timed in a pass.
        ms: milliseconds of each frame, a list a pass.
        overlap: with the truth in each frame (None where there is none), a list a pass.
        ok: what the tracker says itself, a list a pass.
    """

    name: str
    ours: bool
    backend: str | None
    frames: int
    ms: list[list[float]] = field(default_factory=list)
    overlap: list[list[float | None]] = field(default_factory=list)
    ok: list[list[bool]] = field(default_factory=list)

    def add(self, passed: dict[str, list[Any]]) -> None:
        """Takes a pass in."""
        self.ms.append(passed["ms"])
        self.overlap.append(passed["overlap"])
        self.ok.append(passed["ok"])

    def held(self) -> int:
        """Frames from the start until the object is lost for the first time, the least of the passes."""
        return min(map(held, self.overlap))

    def mean_ms(self, frames: int) -> list[float]:
        """Mean milliseconds of a frame over so many first frames, of each pass."""
        return [statistics.fmean(spent[:frames]) for spent in self.ms]


def held(overlap: list[float | None]) -> int:
    """Frames before the first whose overlap is known and at most LOST_OVERLAP."""
    return next((index for index, share in enumerate(overlap) if share is not None and share <= LOST_OVERLAP), len(overlap))


def spread(samples: list[float]) -> dict[str, float]:
    """The median with its ends."""
    return {"least": min(samples), "median": statistics.median(samples), "greatest": max(samples)}


def ratio(ours: Runner, rival: Runner, *, while_held: bool) -> dict[str, Any] | None:
    """How many times longer a rival takes, pass by pass; None where there is too little to compare."""
    frames = min(ours.frames, rival.held() if while_held else rival.frames)
    if frames < _LEAST_FRAMES:
        return None
    pairs = zip(rival.mean_ms(frames), ours.mean_ms(frames), strict=True)
    return {**spread([theirs / own for theirs, own in pairs]), "frames": frames}


def figures(runners: list[Runner]) -> list[dict[str, Any]]:
    """What a race found, the fastest first."""
    rivals = {runner.name: runner for runner in runners}
    found = []
    for runner in runners:
        ms = spread(runner.mean_ms(runner.frames))
        ratios = {
            name: ratio(runner, rivals[name], while_held=while_held)
            for name, while_held in RIVALS
            if runner.ours and name in rivals
        }
        found.append(
            {
                "tracker": runner.name,
                "backend": runner.backend,
                "ms": ms,
                "frames_per_second": 1000 / ms["median"],
                "frames": runner.frames,
                "held": runner.held(),
                "said_lost": max(said.count(False) for said in runner.ok),
                "passes": len(runner.ms),
                "ratios": ratios,
            }
        )
    return sorted(found, key=lambda figure: float(figure["ms"]["median"]))


def table(race: dict[str, Any]) -> str:
    """A race as text."""
    lines = [_HEADS, [], *(_cells(figure) for figure in race["trackers"])]
    title = f"{race['sequence']}: {race['frames']} frames, in turns, one thread each; x: times the rival's frames a second"
    return f"{title}\n{align(lines)}"


_HEADS = ["tracker", "ms a frame", "frames/s", "has the object for", "x csrt", "x kcf"]


def _cells(figure: dict[str, Any]) -> list[str]:
    ms = figure["ms"]
    return [
        figure["tracker"],
        f"{ms['median']:.3f} [{ms['least']:.3f} {ms['greatest']:.3f}]",
        f"{figure['frames_per_second']:.0f}",
        f"{figure['held']} of {figure['frames']} frames",
        *(ratio_text(figure["ratios"].get(name), figure["frames"]) for name, _ in RIVALS),
    ]


def ratio_text(found: dict[str, Any] | None, frames: int) -> str:
    """A quotient with its range, and the frames it is from where those are not all."""
    if found is None:
        return "-"
    text = f"{found['median']:.1f} [{found['least']:.1f} {found['greatest']:.1f}]"
    return text if found["frames"] == frames else f"{text} (first {found['frames']})"


def order_of(tracker: str, preset: str, sequence: Path | None, frames: int) -> Order:
    """What a process that runs passes is told."""
    return {"tracker": tracker, "preset": preset, "sequence": str(sequence) if sequence is not None else None, "frames": frames}


def run(
    entries: list[tuple[Path, str]], preset: str, sequence: Path | None, frames: int, passes: int, progress: Progress
) -> tuple[dict[str, Any] | None, list[str]]:
    """Runs a race.

    Args:
        entries: the library that a process loads, and its tracker as on the command line.
        preset: of our trackers that name none.
        sequence: the directory of the frames; None: the synthetic scene's.
        frames: at most, from the first.
        passes: that each tracker makes.
        progress: shows how far it is.

    Returns:
        The figures, or None when nobody ran, and a line for each tracker that could not.
    """
    problems: list[str] = []
    several = len({library for library, _ in entries}) > 1
    with ExitStack() as stack:
        children = [_Child(stack, library, tracker, order_of(tracker, preset, sequence, frames)) for library, tracker in entries]
        running: list[tuple[_Child, Runner]] = []
        for child in children:
            try:
                about = child.answer()
            except DataError as error:
                problems.append(str(error))
                continue
            name = f"{about['tracker']}, {about['backend']}" if several and about["ours"] else about["tracker"]
            running.append((child, Runner(name, about["ours"], about["backend"], about["frames"])))
        turns = [(number, child, runner) for number in range(passes) for child, runner in running]
        for _, child, runner in progress(turns, len(turns)):
            if child.failed:
                continue
            try:
                runner.add(child.ask())
            except DataError as error:
                problems.append(str(error))
    whole = [runner for child, runner in running if not child.failed]
    if not whole:
        return None, problems
    name = sequence.resolve().name if sequence is not None else "scene"
    return {"sequence": name, "frames": whole[0].frames, "passes": passes, "trackers": figures(whole)}, problems


class _Child:
    """A process that makes passes when asked to. It ends with the stack."""

    def __init__(self, stack: ExitStack, library: Path, tracker: str, order: Order) -> None:
        self._tracker = tracker
        self.failed = False
        self._process = stack.enter_context(
            subprocess.Popen(
                [sys.executable, "-m", "asttrack.passes"],
                env={**os.environ, **ONE_THREAD, ENVIRONMENT_VARIABLE: str(library)},
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
        )
        stack.callback(self._process.terminate)
        self._write(json.dumps(order))

    def ask(self) -> dict[str, Any]:
        """One pass. Raises DataError when the process has ended or says that it cannot."""
        self._write("pass")
        return self.answer()

    def answer(self) -> dict[str, Any]:
        """The line that the process writes next. Raises DataError."""
        assert self._process.stdout is not None  # noqa: S101
        line = self._process.stdout.readline()
        if not line:
            self.failed = True
            _, complaints = self._process.communicate()
            reason = (complaints.strip().splitlines() or [f"status {self._process.returncode}"])[-1]
            raise DataError(f"{self._tracker}: {reason}")
        answered: dict[str, Any] = json.loads(line)
        if "error" in answered:
            self.failed = True
            raise DataError(answered["error"])
        return answered

    def _write(self, line: str) -> None:
        assert self._process.stdin is not None  # noqa: S101
        try:
            self._process.stdin.write(line + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            self.failed = True  # the answer will say why
