"""When there is no memory: a MemoryError that says so, and a tracker that is what it was."""

import subprocess
import sys

import pytest

# What is left to the process after the imports, in bytes; each case asks for more.
LIMITED = """
import resource, numpy as np, asttrack
frame = np.random.default_rng(0).integers(0, 256, (60, 80), dtype=np.uint8)
tracker = asttrack.Tracker("tiny")
tracker.init(frame, (20, 20, 30, 20))
tracker.update(frame)
before = tracker.save()
huge = np.broadcast_to(np.uint8(7), (30000, 30000))          # takes no memory itself, its copy does
huge_colour = np.broadcast_to(np.uint8(7), (20000, 20000, 3))
with open("/proc/self/statm") as statm:
    used = int(statm.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 24 * 2**20, resource.RLIM_INFINITY))
try:
    CASE
except MemoryError as error:
    print("said:", str(error) or type(error).__name__)
else:
    print("there was memory")
assert tracker.save() == before
tracker.update(frame)
print("went on")
"""
LARGEST = (
    "asttrack.Tracker(particles=65536, bag_size=64, patch_width=64, patch_height=64, history=15, basis_size=8, "
    "view=256, gradient_cells=16, background=128, shortlist=0)"
)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the limit on a process's memory is Linux's")
@pytest.mark.parametrize(
    "case", [LARGEST, "tracker.update(huge)", "tracker.update(huge_colour)", "tracker.init(huge, (1, 1, 9, 9))"]
)
def test_lack_of_memory_is_said_and_survived(case: str) -> None:
    run = subprocess.run([sys.executable, "-c", LIMITED.replace("CASE", case)], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    said, went_on = run.stdout.splitlines()
    assert said.startswith("said: "), said
    assert "allocate" in said, said
    assert went_on == "went on"
