"""The soak through Python: one tracker for many frames, and two hundred that come and go.

Memory stays, numbers stay numbers, processor time does not drift.

usage: soak.py FRAMES
"""

import ctypes
import gc
import resource
import sys
import time
from pathlib import Path

import numpy as np

import asttrack

SIDE = (48, 64)
LOOP = 100
BLOCKS = 10
CROWD = 200
PR_SET_THP_DISABLE = 41  # a page that the kernel makes huge in its own time looks like memory that grows
SETTINGS: dict[str, int] = {
    "particles": 32,
    "patch_width": 8,
    "patch_height": 8,
    "bag_size": 4,
    "bag_interval": 3,
    "view": 48,
    "view_object": 12,
    "gradient_cells": 4,
    "background": 16,
    "background_refresh": 2,
}


def make_film() -> tuple[list[np.ndarray], list[tuple[float, float, float, float]]]:
    """A textured square that goes round before a textured ground, and its boxes."""
    noise = np.random.default_rng(1)
    ground = noise.integers(40, 120, SIDE).astype(np.uint8)
    target = noise.integers(100, 255, (12, 14)).astype(np.uint8)
    frames, boxes = [], []
    for f in range(LOOP):
        x = round(25 + 14 * np.sin(2 * np.pi * f / LOOP))
        y = round(18 + 10 * np.cos(2 * np.pi * f / LOOP))
        frame = ground.copy()
        frame[y : y + 12, x : x + 14] = target
        frames.append(frame)
        boxes.append((float(x), float(y), 14.0, 12.0))
    return frames, boxes


def resident_kib() -> int:
    """Resident memory of this process, without pages of files, which come and go."""
    _, resident, shared, *_ = map(int, Path("/proc/self/statm").read_text().split())
    return (resident - shared) * (resource.getpagesize() // 1024)


def require(holds: bool, promise: str) -> None:
    """Ends the program where a promise is broken."""
    if not holds:
        sys.exit(f"broken: {promise}")


def soak(frames: int, film: list[np.ndarray], boxes: list[tuple[float, float, float, float]]) -> None:
    """One tracker, in blocks."""
    tracker = asttrack.Tracker("robust", **SETTINGS)
    tracker.init(film[0], boxes[0])
    print(f"Python {sys.version.split()[0]}, robust preset's parts, {tracker.memory_size} bytes, {asttrack.library.backend}")
    print(f"{'frames':>10} {'us per frame':>14} {'blocks':>12} {'resident, KiB':>14}")
    resident, allocated, seconds = [], [], []
    for block in range(BLOCKS):
        begun = time.process_time()
        for f in range(block * (frames // BLOCKS), (block + 1) * (frames // BLOCKS)):
            result = tracker.update(film[f % LOOP])
            if f % 100 == 0:
                weight = tracker.particles.weight
                require(bool(np.isfinite(weight).all()) and abs(float(weight.sum()) - 1) < 1e-4, "weights whose sum is 1")
                require(0 <= result.score <= 1 and np.isfinite(result.box).all(), "a score and a box of numbers")
        seconds.append(time.process_time() - begun)
        del result, weight
        gc.collect()
        allocated.append(sys.getallocatedblocks())
        resident.append(resident_kib())
        done, each = (block + 1) * (frames // BLOCKS), 1e6 * seconds[-1] / (frames // BLOCKS)
        print(f"{done:>10} {each:>14.2f} {allocated[-1]:>12} {resident[-1]:>14}", flush=True)
    print(f"time of the last block / of the first: {seconds[-1] / seconds[0]:.3f}\n")
    # The table itself takes four a row.
    require(allocated[-1] - allocated[1] < 100, "Python's own memory is flat")
    require(resident[-1] - resident[1] <= 1024, "resident memory is flat")


def crowd(frames: int, film: list[np.ndarray], boxes: list[tuple[float, float, float, float]]) -> None:
    """Two hundred trackers over one video, started and stopped at random."""
    chance = np.random.default_rng(1)
    members: list[asttrack.Tracker | None] = [None] * CROWD
    starts = steps = most = 0
    for f in range(frames):
        for m, member in enumerate(members):
            turn = chance.random()
            if member is None and turn < 0.2:
                member = asttrack.Tracker("robust", seed=f * CROWD + m, **SETTINGS)
                member.init(film[f % LOOP], boxes[f % LOOP])
                members[m] = member
                starts += 1
            elif member is not None and turn < 0.02:
                if turn < 0.01:
                    member.close()
                members[m] = None
            elif member is not None:
                require(bool(np.isfinite(member.update(film[f % LOOP]).box).all()), "a box of numbers in the crowd")
                steps += 1
        most = max(most, sum(member is not None for member in members))
    print(f"crowd of {CROWD}: {frames} frames, {starts} trackers, at most {most} at once, {steps} steps")
    print(f"resident: {resident_kib()} KiB")
    require(starts > CROWD and most > CROWD // 2, "a crowd")


def main() -> None:
    """Reads the number of frames and runs both."""
    if len(sys.argv) != 2 or not sys.argv[1].isdigit() or int(sys.argv[1]) < 1000:
        print("usage: soak.py FRAMES (at least 1000)", file=sys.stderr)
        sys.exit(2)
    frames = int(sys.argv[1])
    ctypes.CDLL(None).prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0)
    film, boxes = make_film()
    soak(frames, film, boxes)
    crowd(min(max(frames // 1000, 100), 500), film, boxes)


if __name__ == "__main__":
    main()
