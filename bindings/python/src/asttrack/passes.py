"""Passes of one tracker over frames in memory, in a process of their own: `python -m asttrack.passes`.

The parent writes the order as one line to stdin, then a line for each pass that it wants; every line is answered by one on stdout,
all JSON. So trackers that are to be compared can take turns, each with the library and the environment of its own process.
"""

import json
import sys
import time
from typing import Any

import numpy as np

from asttrack._library import LIBRARY
from asttrack.errors import AstError
from asttrack.evaluation.metrics import Floats, overlaps
from asttrack.evaluation.trackers import AsttrackFollower, AsttrackSpec, Follower, parse_trackers
from asttrack.failures import DataError, UsageError
from asttrack.frames import Frame
from asttrack.measuring import forth_and_back, load_film
from asttrack.opencv import one_thread, quiet
from asttrack.result import Box

_PATIENCE = 4  # times as many frames as a full bag takes when every frame is trusted


class Passes:
    """One tracker and the frames that it follows the object through, again and again.

    Ours go forth and back so that their bag, once full, stays full: a step costs the most then. OpenCV's, whose cost does not grow,
    start anew at each pass.

    Args:
        order: the names and values that `race.order_of` gives.
    """

    def __init__(self, order: dict[str, Any]) -> None:
        (spec,) = parse_trackers(order["tracker"], order["preset"])
        spec.check()
        self._spec = spec
        self._ours = isinstance(spec, AsttrackSpec)
        frames, self._truth = load_film(order["sequence"], order["frames"])
        self._box = Box(*(float(round(side)) for side in self._truth[0]))
        self._first = frames[0]
        self._follower: Follower = spec.make(1)
        # Grey and, for OpenCV, colour frames at once would be four times the memory.
        self._frames: list[Frame] = [self._follower.prepare(frame) for frame in frames]
        if self._ours:
            self._follower.init(self._first, self._box)
            self._fill()

    def about(self) -> dict[str, Any]:
        """Who runs, and on what."""
        return {
            "tracker": self._spec.label,
            "ours": self._ours,
            "backend": LIBRARY.backend if self._ours else None,
            "frames": len(self._frames) - 1,
        }

    def run(self) -> dict[str, list[Any]]:
        """One pass over the frames after the first.

        Returns:
            Of each frame the milliseconds, the overlap with the truth (None where there is none), and whether the tracker says that
            it has the object.
        """
        if not self._ours:
            self._follower = self._spec.make(1)
            self._follower.init(self._first, self._box)
        spent: list[float] = []
        ok: list[bool] = []
        boxes: list[Box] = []
        for frame in self._frames[1:]:
            before = time.process_time_ns()
            step = self._follower.update(frame)
            spent.append((time.process_time_ns() - before) / 1e6)
            ok.append(step.ok)
            boxes.append(step.box)
        if self._ours:
            for frame in self._frames[-2::-1]:
                self._follower.update(frame)
        shares: Floats = overlaps(np.array(boxes, float), self._truth[1:])
        return {"ms": spent, "overlap": [None if np.isnan(share) else float(share) for share in shares], "ok": ok}

    def _fill(self) -> None:
        """Tracks forth and back until the bag is full and the first frame is the last that was seen."""
        assert isinstance(self._follower, AsttrackFollower)  # noqa: S101
        tracker = self._follower.tracker
        size = int(tracker.config["bag_size"])
        turn = 2 * (len(self._frames) - 1)
        wanted = _PATIENCE * (size * int(tracker.config["bag_interval"]) + int(tracker.config["history"]))
        for step, frame in enumerate(forth_and_back(self._frames), 1):
            self._follower.update(frame)
            if step % turn == 0 and (len(tracker.bag) == size or step >= wanted):
                return


def main() -> int:
    """Answers the order with what runs, or with `error`, and each further line with a pass."""
    one_thread()
    quiet()
    try:
        passes = Passes(json.loads(sys.stdin.readline()))
        print(json.dumps(passes.about()), flush=True)
        for _ in sys.stdin:
            print(json.dumps(passes.run()), flush=True)
    except (DataError, UsageError, AstError) as error:
        print(json.dumps({"error": str(error)}), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
