#!/usr/bin/env python3
"""Holds the tracker to what it reached: the default preset, by the command, on rendered scenes and on real sequences.

The file of bounds has a line for each: "scene:SEED", which is rendered, or a directory of --sequences, and the greatest centre error,
the least precision at 20 px and the least success. Seed 1 of the tracker must keep them. Tracking is a game of chance, and
another compiler is another throw: where seed 1 fails, seeds 2 and 3 are run too, and the median of the three counts.

With --update nothing is checked: five seeds are run, and the bounds are written anew, a little worse than the medians. A scene that
most seeds lose has medians that hold nothing: it is an error, and another scene is to be named in its place.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

CHECKED_SEEDS = (1, 2, 3)
UPDATE_SEEDS = (1, 2, 3, 4, 5)
FIGURES = {"cle": "centre error", "precision20": "precision at 20 px", "success": "success"}
# How much worse than the medians the written bounds are.
ERROR_FACTOR, ERROR_PIXELS, SHARE = 1.25, 0.5, 0.04
# Least precision of a scene whose bounds hold something.
SCENE_PRECISION = 0.8
HEADING = """\
# What scripts/check_accuracy.py holds the default preset to; `make accuracy UPDATE=1` measures and writes it anew:
# {factor} times the median centre error of {seeds} seeds plus {pixels} px, the medians of the others less {share}.
# name: centre error px at most, precision at 20 px at least, success at least
"""


class Unusable(Exception):
    """What cannot be run, in a line."""


def read_bounds(path):
    """{name: {figure: bound}} in the order of the file."""
    bounds = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        text = line.partition("#")[0].strip()
        if not text:
            continue
        match = re.fullmatch(r"(\S+)\s+([\d.]+)\s+([\d.]+)\s+([\d.]+)", text)
        if not match or match[1] in bounds:
            raise Unusable(f"{path}:{number}: not a new name and three numbers")
        bounds[match[1]] = dict(zip(FIGURES, map(float, match.groups()[1:])))
    if not bounds:
        raise Unusable(f"{path}: no bounds in it")
    return bounds


def run(*words):
    """What a command prints."""
    done = subprocess.run([*map(str, words)], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
    if done.returncode != 0:
        raise Unusable(done.stderr.strip() or f"{words[0]}: ended with status {done.returncode}")
    return done.stdout


class Trial:
    """A sequence, where it lies, and how to track it."""

    def __init__(self, command, name, directory):
        self.command, self.name, self.directory = command, name, directory

    def track(self, seed):
        """The figures of one seed."""
        if self.name.startswith("scene:") and not self.directory.is_dir():
            run(self.command, "synth", self.directory, "--seed", self.name.partition(":")[2])
        said = run(self.command, "track", self.directory, "--seed", seed)
        found = dict(re.findall(r" (\w+)=(\S+)", said.strip().splitlines()[-1]))
        return {figure: float(found[figure]) for figure in FIGURES}

    def medians(self, seeds):
        """The medians over the seeds."""
        runs = [self.track(seed) for seed in seeds]
        return {figure: statistics.median(run[figure] for run in runs) for figure in FIGURES}

    def checked(self, bounds):
        """The figures that count, and the seeds that they come from."""
        first = self.track(CHECKED_SEEDS[0])
        if not failures(first, bounds):
            return first, CHECKED_SEEDS[:1]
        runs = [first, *(self.track(seed) for seed in CHECKED_SEEDS[1:])]
        return {figure: statistics.median(run[figure] for run in runs) for figure in FIGURES}, CHECKED_SEEDS


def failures(figures, bounds):
    """A text for each figure that is out of its bound; nan is."""
    found = []
    for figure, title in FIGURES.items():
        value, bound = figures[figure], bounds[figure]
        if figure == "cle" and not value <= bound:
            found.append(f"{title} {value:.1f} px is above {bound:g}")
        if figure != "cle" and not value >= bound:
            found.append(f"{title} {value:.3f} is below {bound:g}")
    return found


def check(trials, bounds, pool):
    """Prints a line a trial; whether all keep their bounds."""
    good = True
    outcomes = pool.map(lambda trial: trial.checked(bounds[trial.name]), trials)
    for trial, (figures, seeds) in zip(trials, outcomes):
        found = failures(figures, bounds[trial.name])
        text = f"{figures['cle']:5.1f} px  {figures['precision20']:.3f}  {figures['success']:.3f}"
        ran = "seed 1" if len(seeds) == 1 else f"median of seeds {', '.join(map(str, seeds))}"
        print(f"{'FAIL' if found else 'ok  '} {trial.name:16s} {text}  ({ran})", flush=True)
        for reason in found:
            print(f"FAIL {trial.name}: {reason}")
        good = good and not found
    return good


def update(path, trials, pool):
    """Writes the bounds anew."""
    lines, lost = [], []
    for trial, figures in zip(trials, pool.map(lambda trial: trial.medians(UPDATE_SEEDS), trials)):
        error, shares = figures["cle"], [max(0.0, figures[figure] - SHARE) for figure in list(FIGURES)[1:]]
        text = f"{ERROR_FACTOR * error + ERROR_PIXELS:5.1f}  {shares[0]:.2f}  {shares[1]:.2f}"
        lines.append(f"{trial.name:16s} {text}  # {error:.1f} {figures['precision20']:.3f} {figures['success']:.3f}\n")
        print(lines[-1], end="", flush=True)
        if trial.name.startswith("scene:") and not figures["precision20"] >= SCENE_PRECISION:
            lost.append(trial.name)
    if lost:
        raise Unusable(f"{path}: not written: most seeds lose {', '.join(lost)}, whose bounds would hold nothing: name other scenes")
    heading = HEADING.format(factor=ERROR_FACTOR, seeds=len(UPDATE_SEEDS), pixels=ERROR_PIXELS, share=SHARE)
    beside = path.with_name(path.name + ".new")
    beside.write_text(heading + "".join(lines))
    beside.replace(path)


def main():
    """0 when all bounds are kept, 1 when not or when something cannot be run."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--command", type=pathlib.Path, required=True, help="the command asttrack")
    parser.add_argument("--bounds", type=pathlib.Path, required=True, help="the file of bounds")
    parser.add_argument("--sequences", type=pathlib.Path, help="where real sequences lie; without it they are left out")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes at a time")
    parser.add_argument("--update", action="store_true", help="measure, and write the bounds anew")
    arguments = parser.parse_args()
    bounds = read_bounds(arguments.bounds)
    command = arguments.command.resolve()
    with tempfile.TemporaryDirectory() as scenes, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        trials = [Trial(command, name, pathlib.Path(scenes, name.replace(":", "-"))) for name in bounds if name.startswith("scene:")]
        real = [name for name in bounds if not name.startswith("scene:")]
        left_out = None
        if arguments.sequences is None or not arguments.sequences.is_dir():
            left_out = f"{arguments.sequences or 'no --sequences'}: not there"
        elif "JPEG: yes" not in run(command, "--version"):
            left_out = f"{command}: built without JPEG"
        else:
            trials += [Trial(command, name, arguments.sequences / name) for name in real]
        if arguments.update:
            if left_out:
                raise Unusable(f"{left_out}: all of the bounds are written from one run, or none")
            update(arguments.bounds, trials, pool)
            return 0
        good = check(trials, bounds, pool)
    if left_out:
        print(f"left out, as {left_out}: {', '.join(real)}")
    return 0 if good else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Unusable, OSError) as error:
        print(f"check_accuracy: {error}", file=sys.stderr)
        sys.exit(1)
