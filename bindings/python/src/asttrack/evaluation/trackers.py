"""One face for the trackers that are compared: ours with any configuration, and OpenCV's."""

import ctypes
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, TypeAlias

import cv2

from asttrack.config import PRESETS, config_fields
from asttrack.errors import AstError
from asttrack.failures import DataError, MissingExtraError, UsageError
from asttrack.frames import Frame
from asttrack.result import Box, Status
from asttrack.tracker import Tracker


class Step(NamedTuple):
    """What a tracker says of a frame.

    Attributes:
        box: where the object is; of a lost one, the last box.
        ok: false when the tracker says that it has lost the object.
        score: the tracker's confidence in [0, 1]; nan where it gives none.
    """

    box: Box
    ok: bool
    score: float


class Follower(Protocol):
    """A tracker at work."""

    def init(self, frame: Frame, box: Box) -> None:
        """Starts on the object inside `box`, whole pixels, in a grey frame. Raises DataError."""

    def prepare(self, frame: Frame) -> Frame:
        """A grey frame in the form that `update` takes: not the tracker's work, and not timed."""

    def update(self, frame: Frame) -> Step:
        """Tracks one frame. Raises DataError."""


class AsttrackFollower:
    """Our tracker. `tracker` is open to be looked into."""

    def __init__(self, tracker: Tracker) -> None:
        self.tracker = tracker

    def init(self, frame: Frame, box: Box) -> None:
        """Starts."""
        try:
            self.tracker.init(frame, box)
        except AstError as error:
            raise DataError(str(error)) from error

    def prepare(self, frame: Frame) -> Frame:
        """The frame as it is."""
        return frame

    def update(self, frame: Frame) -> Step:
        """Tracks one frame."""
        try:
            result = self.tracker.update(frame)
        except AstError as error:
            raise DataError(str(error)) from error
        return Step(result.box, result.status is not Status.LOST, result.score)


class OpencvFollower:
    """A tracker of OpenCV. It keeps its last box while it says that it has lost the object."""

    def __init__(self, tracker: Any) -> None:
        self._tracker = tracker
        self._box = Box(math.nan, math.nan, math.nan, math.nan)

    def init(self, frame: Frame, box: Box) -> None:
        """Starts. The older trackers say by False, the newer ones by an exception that they cannot."""
        try:
            started = self._tracker.init(self.prepare(frame), tuple(map(int, box)))
        except cv2.error as error:
            raise _refused(error) from error
        if started is False:
            raise DataError("cannot start on this box")
        self._box = box

    def prepare(self, frame: Frame) -> Frame:
        """Three equal channels: KCF refuses one, and MOSSE reads it otherwise."""
        return cv2.cvtColor(frame, cv2.COLOR_GRAY2BGR)  # type: ignore[return-value]  # uint8 in, uint8 out; the stub says any number

    def update(self, frame: Frame) -> Step:
        """Tracks one frame."""
        try:
            ok, box = self._tracker.update(frame)
        except cv2.error as error:
            raise _refused(error) from error
        if ok:
            self._box = Box(*map(float, box))
        return Step(self._box, bool(ok), math.nan)


def _refused(error: cv2.error) -> DataError:
    return DataError(f"OpenCV: {' '.join(str(error).split())[:200]}")


@dataclass(frozen=True)
class AsttrackSpec:
    """Our tracker with a preset and changed fields.

    Attributes:
        label: its name in tables.
        preset: one of `asttrack.PRESETS`.
        changes: names and values of configuration fields.
    """

    label: str
    preset: str
    changes: tuple[tuple[str, int | float | str], ...] = ()

    @property
    def repeats(self) -> bool:
        """Whether the seed has no influence: the field `seed` among the changes fixes it."""
        return "seed" in dict(self.changes)

    def make(self, seed: int) -> AsttrackFollower:
        """A tracker that draws its random numbers from `seed`. Raises UsageError."""
        settings: dict[str, Any] = {"preset": self.preset, "seed": seed, **dict(self.changes)}
        try:
            return AsttrackFollower(Tracker(**settings))
        except (AstError, TypeError, ValueError) as error:
            raise UsageError(f"{self.label}: {error}") from error

    def check(self) -> None:
        """Raises UsageError when the configuration is not one."""
        self.make(1)


@dataclass(frozen=True)
class OpencvSpec:
    """A tracker of OpenCV, with its default parameters.

    Attributes:
        label: its name in tables and on the command line.
        maker: the function of cv2 that makes one.
        repeats: whether it draws no random numbers.
    """

    label: str
    maker: str
    repeats: bool

    def make(self, seed: int) -> OpencvFollower:
        """A tracker whose random numbers come from `seed`, when made in a process that has made none before.

        MIL draws from OpenCV's generator, TLD from the C library's; both keep further state that only a new process resets.
        """
        cv2.setRNGSeed(seed)
        ctypes.CDLL(None).srand(seed)
        return OpencvFollower(self._find()())

    def check(self) -> None:
        """Raises MissingExtraError when the installed OpenCV has no such tracker."""
        self._find()

    def _find(self) -> Callable[[], Any]:
        place: Any = cv2
        for name in self.maker.split("."):
            place = getattr(place, name, None)
        if place is None:
            raise MissingExtraError(f"{self.label}: this OpenCV {cv2.__version__} has no such tracker", "peers")
        found: Callable[[], Any] = place
        return found


TrackerSpec: TypeAlias = AsttrackSpec | OpencvSpec

PEERS = {
    spec.label: spec
    for spec in (
        OpencvSpec("csrt", "TrackerCSRT_create", repeats=True),
        OpencvSpec("kcf", "TrackerKCF_create", repeats=True),
        OpencvSpec("mil", "TrackerMIL_create", repeats=False),
        OpencvSpec("tld", "legacy.TrackerTLD_create", repeats=False),
        OpencvSpec("boosting", "legacy.TrackerBoosting_create", repeats=True),
        OpencvSpec("medianflow", "legacy.TrackerMedianFlow_create", repeats=True),
        OpencvSpec("mosse", "legacy.TrackerMOSSE_create", repeats=True),
    )
}


def parse_trackers(text: str, preset: str) -> list[TrackerSpec]:
    """The trackers of a list `asttrack:paper:alpha=3,particles=200,csrt`.

    Commas part trackers and the fields of one: `name=value` without a colon belongs to the tracker before it.

    Args:
        text: the list.
        preset: of our trackers that name none.

    Raises:
        UsageError: an unknown tracker, preset or field, an illegal value, or the same tracker twice.
    """
    items: list[str] = []
    for item in filter(None, map(str.strip, text.split(","))):
        if items and re.match(r"\w+=", item):
            items[-1] += f",{item}"
        else:
            items.append(item)
    if not items:
        raise UsageError("no trackers given")
    specs = [_parse_tracker(item, preset) for item in items]
    labels = [spec.label for spec in specs]
    for label in labels:
        if labels.count(label) > 1:
            raise UsageError(f"{label}: given twice")
    return specs


def _parse_tracker(item: str, preset: str) -> TrackerSpec:
    name, *parts = item.split(":")
    if name in PEERS and not parts:
        return PEERS[name]
    if name != "asttrack":
        raise UsageError(f"{item}: unknown tracker: there are asttrack[:preset][:field=value,...], {', '.join(PEERS)}")
    if parts and "=" not in parts[0]:
        preset = parts.pop(0)
        if preset not in PRESETS:
            raise UsageError(f"{item}: there is no preset {preset!r}: there are {', '.join(PRESETS)}")
    changes = parse_changes(parts.pop(0).split(",")) if parts else {}
    if parts:
        raise UsageError(f"{item}: more than asttrack[:preset][:field=value,...]")
    return AsttrackSpec(item, preset, tuple(changes.items()))


def parse_changes(settings: Iterable[str]) -> dict[str, int | float | str]:
    """Values of configuration fields from `field=value` texts; the tracker says whether they are legal. Raises UsageError."""
    kinds = {field.name: field.kind for field in config_fields()}
    changes: dict[str, int | float | str] = {}
    for setting in settings:
        name, separator, value = setting.partition("=")
        if not separator or not value:
            raise UsageError(f"{setting}: not field=value")
        changes[name] = _value(name, value, kinds.get(name, "enum"))
    return changes


def _value(name: str, text: str, kind: str) -> int | float | str:
    try:
        return int(text, 0) if kind in ("int", "seed") else float(text) if kind == "float" else text
    except ValueError as error:
        raise UsageError(f"{name}={text}: not {'a number' if kind == 'float' else 'an integer'}") from error
