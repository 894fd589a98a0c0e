"""The command as a user runs it: what it prints and writes, and the one line that it says when something is wrong."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

import small_sequence
from asttrack import __version__
from asttrack.__main__ import main
from asttrack.scene import Scene
from terminal import all_shown, open_terminal, shown_until

BOX = ",".join(f"{side:.0f}" for side in small_sequence.SCENE.box(0))
COUNT = small_sequence.SCENE.frames
FULL = 8  # KiB that a file may have where the disk is to be full


def command(*words: object, limit: int | None = None, without: str | None = None) -> subprocess.CompletedProcess[str]:
    """Runs it; with files no larger than so many KiB, or without a module."""
    start = ["-m", "asttrack"]
    if without is not None:
        code = f"import sys; sys.modules[{without!r}] = None; from asttrack.__main__ import main; sys.exit(main(sys.argv[1:]))"
        start = ["-c", code]
    whole = [sys.executable, *start, *map(str, words)]
    if limit is not None:
        whole = ["sh", "-c", f'ulimit -f {2 * limit}; exec "$0" "$@"', *whole]
    return subprocess.run(whole, capture_output=True, text=True, check=False, timeout=400)


def complaint(done: subprocess.CompletedProcess[str], code: int) -> str:
    """The one line that a failed command said."""
    assert done.returncode == code, done
    (line,) = done.stderr.splitlines()
    assert line.startswith("asttrack: ")
    return line


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("command") / "scene"
    small_sequence.write(directory)
    return directory


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("video") / "scene.avi"
    size = (small_sequence.SCENE.width, small_sequence.SCENE.height)
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 25, size)
    for index in range(COUNT):
        writer.write(cv2.cvtColor(small_sequence.SCENE.frame(index), cv2.COLOR_GRAY2BGR))
    writer.release()
    return path


# ---- The command itself ----


def test_help_names_every_sub_command() -> None:
    text = command("--help").stdout
    assert all(f"\n    {name} " in text for name in ("track", "eval", "recovery", "bench", "fleet", "gallery"))
    for name in ("track", "eval", "recovery", "bench", "fleet", "gallery"):
        assert command(name, "--help").returncode == 0
    assert command("--version").stdout == f"asttrack {__version__}\n"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "the following arguments are required: COMMAND"),
        (["follow"], "invalid choice: 'follow'"),
        (["eval"], "the following arguments are required: SEQUENCE"),
        (["eval", "x", "--seeds", "0"], "--seeds: 0: not a whole number above 0"),
        (["eval", "x", "--trackers", "struck"], "struck: unknown tracker"),
        (["eval", "x", "--trackers", "asttrack:tiny:alpha=-1"], "alpha=-1.0: the legal range is 0 .."),
        (["track", "x", "--box", "1,2,3"], "--box: 1,2,3: not four numbers"),
        (["track", "x", "--box", "1,2,3,0"], "--box: 1,2,3,0: not four numbers"),
        (["track", "x", "--box", "1,2,3,4", "--select"], "not allowed with argument"),
        (["track", "x", "--box", "1,2,3,4", "--out", "a.gif"], "a.gif: the name of a video must end in .mp4 or .avi or .mkv"),
        (["track", "x", "--particles"], "--particles: draws into the video of --out"),
        (["track", "x", "--set", "particles=many"], "particles=many: not an integer"),
        (["recovery", "--events", "fog:5"], "fog:5: not an event: occlusion:FRAMES, leave:FRAMES, cut:FRAMES"),
        (["bench", "--seconds", "0"], "--seconds: 0: not a number of seconds"),
        (["fleet", "x", "--out", "a.txt"], "a.txt: the name of a table must end in .csv or .parquet"),
        (["gallery", "x", "--frames", "9"], "--frames: at least 80"),
    ],
)
def test_bad_usage_is_one_line_and_status_2(words: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        code = main(words)
    except SystemExit as end:
        code = int(end.code or 0)
    (line,) = capsys.readouterr().err.splitlines()
    assert code == 2
    assert line.startswith("asttrack: ")
    assert message in line


@pytest.mark.parametrize(
    ("module", "words", "message"),
    [
        ("cv2", ["eval", "x"], "eval: needs OpenCV, which is not installed: pip install './bindings/python[eval]' in its sources"),
        ("cv2", ["track", "x", "--box", "1,2,3,4"], "track: needs OpenCV, which"),
        (
            "matplotlib",
            ["gallery", "x"],
            "gallery: needs matplotlib, which is not installed: pip install './bindings/python[eval]' in its sources",
        ),
        (
            "distributed",
            ["fleet", "x"],
            "fleet: needs dask.distributed, which is not installed: pip install './bindings/python[fleet]' in its sources",
        ),
    ],
)
def test_what_is_not_installed_is_named_with_its_extra(module: str, words: list[str], message: str) -> None:
    assert message in complaint(command(*words, without=module), 1)


# ---- track ----


def rows(path: Path) -> list[dict[str, str]]:
    with path.open() as stream:
        return list(csv.DictReader(stream))


def test_a_video_is_tracked_into_a_video_and_a_table(video: Path, tmp_path: Path) -> None:
    out, table = tmp_path / "out.mp4", tmp_path / "track.csv"
    done = command(
        "track", video, "--box", BOX, "--preset", "paper", "--set", "particles=200", "--out", out, "--csv", table, "--particles"
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert done.stdout.startswith(f"result name=scene.avi frames={COUNT} fps=")
    lines = rows(table)
    assert list(lines[0]) == ["frame", "x", "y", "w", "h", "scale", "score", "status"]
    assert [int(line["frame"]) for line in lines] == list(range(1, COUNT + 1))
    truth, last = small_sequence.SCENE.box(COUNT - 1), lines[-1]
    assert abs(float(last["x"]) + float(last["w"]) / 2 - truth.x - truth.w / 2) < 10
    capture = cv2.VideoCapture(str(out))
    assert capture.get(cv2.CAP_PROP_FRAME_COUNT) == COUNT
    _, frame = capture.read()
    # The box is green where the scene is grey.
    green = frame[:, :, 1].astype(int) - frame[:, :, 2]
    x, y, w, h = small_sequence.SCENE.box(0)
    assert green[round(y) - 2 : round(y) + 3, round(x + w / 2)].max() > 60
    assert green[round(y + h / 2), round(x) - 2 : round(x) + 3].max() > 60
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.mp4", "track.csv"]


def test_a_directory_starts_on_its_ground_truth_and_frames_limits_it(scene: Path, tmp_path: Path) -> None:
    table = tmp_path / "track.csv"
    done = command("track", scene, "--csv", table, "--frames", 7)
    assert done.returncode == 0, done.stderr
    lines = rows(table)
    assert len(lines) == 7
    assert [float(lines[0][side]) for side in "xywh"] == pytest.approx(small_sequence.SCENE.box(0), abs=0.01)
    assert lines[0]["status"] == "tracking"


def test_frames_of_another_size_are_made_to_fit_the_video(tmp_path: Path) -> None:
    for number, size in enumerate([(64, 48), (80, 60), (64, 48)], 1):
        texture = np.random.default_rng(number).integers(0, 256, (size[1], size[0]), np.uint8)
        cv2.imwrite(str(tmp_path / f"{number}.png"), texture)
    out = tmp_path / "out.mp4"
    assert command("track", tmp_path, "--box", "10,10,20,20", "--out", out).returncode == 0
    capture = cv2.VideoCapture(str(out))
    assert capture.get(cv2.CAP_PROP_FRAME_COUNT) == 3


@pytest.mark.parametrize(
    ("source", "options", "message"),
    [
        ("absent.avi", ["--box", BOX], "absent.avi: No such file or directory"),
        ("text.avi", ["--box", BOX], "text.avi: not a video that OpenCV reads, or damaged"),
        ("empty", ["--box", BOX], "empty: no numbered pictures in it or in its img/"),
        ("77", ["--box", BOX], "camera 77: there is no such camera, or it is in use"),
    ],
)
def test_a_source_that_cannot_be_read_is_one_line(tmp_path: Path, source: str, options: list[str], message: str) -> None:
    (tmp_path / "text.avi").write_text("not a video")
    (tmp_path / "empty").mkdir()
    place = source if source.isdigit() else tmp_path / source
    assert message in complaint(command("track", place, *options), 1)


def test_a_box_outside_is_one_line_and_none_at_all_is_usage(video: Path) -> None:
    assert "scene.avi: box 500,20,30,30 in 160 x 120 pixels: " in complaint(command("track", video, "--box", "500,20,30,30"), 1)
    assert "say where the object is with --box X,Y,W,H or --select" in complaint(command("track", video), 2)


def test_select_without_windows_says_what_to_do(video: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    done = subprocess.run(
        [sys.executable, "-m", "asttrack", "track", video, "--select"], capture_output=True, text=True, check=False, env=environment
    )
    assert "--select: this OpenCV opens no windows: give --box" in complaint(done, 1)


def test_a_damaged_frame_ends_the_track_and_keeps_what_came_before(tmp_path: Path) -> None:
    small_sequence.SCENE.write(tmp_path / "scene")
    (tmp_path / "scene" / "img" / "00010.pgm").write_bytes(b"P5")
    table, out = tmp_path / "track.csv", tmp_path / "out.avi"
    done = command("track", tmp_path / "scene", "--csv", table, "--out", out)
    assert "00010.pgm: not a picture that OpenCV reads, or damaged; the 9 frames before it are kept" in complaint(done, 1)
    assert len(rows(table)) == 9
    assert cv2.VideoCapture(str(out)).get(cv2.CAP_PROP_FRAME_COUNT) == 9


def test_a_full_disk_leaves_nothing_half_written(video: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.avi"
    out.write_text("old")
    done = command("track", video, "--box", BOX, "--out", out, limit=FULL)
    assert f"{out}: could not be written whole: is the disk full?" in complaint(done, 1)
    assert out.read_text() == "old"
    assert list(tmp_path.iterdir()) == [out]


def test_a_place_that_takes_no_file_is_found_before_the_work(video: Path, tmp_path: Path) -> None:
    done = command("track", video, "--box", BOX, "--csv", tmp_path / "absent" / "track.csv")
    assert "absent/track.csv: No such file or directory" in complaint(done, 1)
    assert done.stdout == ""


# ---- eval ----


def test_eval_prints_a_table_and_writes_everything(scene: Path, tmp_path: Path) -> None:
    variants = tmp_path / "variants.toml"
    variants.write_text(
        '[[variant]]\nname = "base"\npreset = "tiny"\n[[variant]]\nname = "half"\npreset = "tiny"\nset = { particles = 30 }\n'
    )
    out = tmp_path / "results" / "deep"
    done = command(
        "eval", scene, "--ablation", variants, "--trackers", "medianflow", "--seeds", 2, "--jobs", 2, "--sre", "--out", out
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    table, known, robustness, worth, written = (
        part for part in done.stdout.split("\n\n") if part.count("\n") > 1 or part.startswith("written")
    )
    assert [line.split()[:2] for line in table.splitlines()] == [["scene", "base"], ["scene", "half"], ["scene", "medianflow"]]
    assert [line.split()[:2] for line in known.splitlines()] == [line.split()[:2] for line in table.splitlines()]
    assert robustness.splitlines()[0].split()[-1] == "12"
    assert [line.split()[0] for line in worth.splitlines()] == ["base", "half", "medianflow"]
    assert written.startswith(f"written: {out}/results.csv")
    names = ["ablation.csv", "confidence.csv", "report.html", "results.csv", "results.json", "tables.md", "tracks.csv"]
    assert sorted(path.name for path in out.iterdir()) == names
    assert len(rows(out / "results.csv")) == 2 + 2 + 1 + 3 * 12
    assert len(rows(out / "confidence.csv")) == 2 * (2 + 2 + 1)
    base, half, peer = rows(out / "ablation.csv")
    assert (base["variant"], half["variant"], peer["variant"]) == ("base", "half", "medianflow")
    assert (base["centre_error_change"], half["precision_low"] != "") == ("", True)
    change = float(half["success_change"])
    assert float(half["success_change_low"]) <= change <= float(half["success_change_high"])
    tables = (out / "tables.md").read_text()
    assert tables.startswith("Made by `python -m asttrack eval ")
    assert tables.count("\n## ") == 4
    assert sum(line.startswith("| half | ") for line in tables.splitlines()) == 1
    assert len(rows(out / "tracks.csv")) == (2 + 2 + 1 + 3 * 12) * COUNT
    conditions = json.loads((out / "results.json").read_text())["conditions"]
    assert conditions["command"].startswith("python -m asttrack eval ")
    assert "What each part is worth" in (out / "report.html").read_text()


def test_eval_runs_what_it_can_and_tells_the_rest(scene: Path, tmp_path: Path) -> None:
    small_sequence.SCENE.write(tmp_path / "short")
    (tmp_path / "short" / "groundtruth.txt").write_text(
        (scene / "groundtruth.txt").read_text().split("\n", 9)[0] * 1 + "\n" + BOX + "\n"
    )
    small_sequence.SCENE.write(tmp_path / "damaged")
    (tmp_path / "damaged" / "img" / "00003.pgm").unlink()
    (tmp_path / "damaged" / "img" / "00003.pgm").write_text("")
    done = command("eval", scene, tmp_path / "short", tmp_path / "absent", tmp_path / "damaged", "--preset", "tiny", "--seeds", 1)
    assert done.returncode == 1
    lines = done.stderr.splitlines()
    assert len(lines) == 3
    assert "absent: no such directory" in lines[0]
    assert f"short: {COUNT} frames but 2 lines of ground truth: evaluated on the first 2" in lines[1]
    assert "00003.pgm: not a picture that OpenCV reads, or damaged" in lines[2]
    words = [line.split()[0] for line in done.stdout.splitlines() if line]
    assert [word for word in words if not word.startswith(("one-pass", "confidence"))] == [
        "sequence", "scene", "short", "mean", "sequence", "scene", "short", "all",
    ]  # fmt: skip


def test_eval_without_contrib_runs_the_other_trackers(
    scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delattr(cv2, "legacy")
    assert main(["eval", str(scene), "--trackers", "asttrack:tiny,medianflow", "--seeds", "1"]) == 1
    told = capsys.readouterr()
    assert "medianflow: this OpenCV" in told.err
    assert "pip install './bindings/python[peers]' in its sources" in told.err
    assert "asttrack:tiny" in told.out


def test_eval_of_nothing_is_an_error(tmp_path: Path) -> None:
    done = command("eval", tmp_path / "absent")
    assert done.returncode == 1
    assert done.stderr.splitlines() == [f"asttrack: {tmp_path}/absent: no such directory", "asttrack: nothing to evaluate"]


def test_eval_into_a_place_that_takes_no_file_is_found_before_the_work(scene: Path, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    done = command("eval", scene, "--preset", "tiny", "--out", tmp_path / "file" / "out")
    assert "file/out: Not a directory" in complaint(done, 1)
    assert done.stdout == ""


def test_eval_on_a_full_disk_leaves_nothing_half_written(scene: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = command("eval", scene, "--preset", "tiny", "--seeds", 8, "--out", out, limit=FULL)
    assert "tracks.csv: File too large" in complaint(done, 1)
    # What was whole is there, and no trace of the rest.
    assert [path.name for path in out.iterdir()] == ["results.csv"]
    assert len(rows(out / "results.csv")) == 8


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_eval_keeps_what_is_finished(tmp_path: Path, number: signal.Signals) -> None:
    Scene(frames=40, width=160, height=120, size=(28, 24)).write(tmp_path / "scene")
    out, planned = tmp_path / "out", 2000
    reader, terminal = open_terminal()
    process = subprocess.Popen(
        [sys.executable, "-m", "asttrack", "eval", tmp_path / "scene", "--preset", "tiny", "--seeds", str(planned), "--out", out],
        stdout=subprocess.PIPE,
        stderr=terminal,
        text=True,
        start_new_session=True,
    )
    os.close(terminal)
    shown = shown_until(reader, lambda text: re.search(rf"\b[1-9]\d*/{planned}", text) is not None)
    if number == signal.SIGINT:
        # A terminal sends it to the whole group of processes.
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    shown += all_shown(reader)
    output, _ = process.communicate(timeout=300)
    assert process.returncode == 130, shown
    finished = len(rows(out / "results.csv"))
    assert 1 <= finished < planned
    assert f"interrupted: {finished} of {planned} runs are finished and kept" in shown
    assert "Traceback" not in shown
    assert "scene" in output
    assert json.loads((out / "results.json").read_text())["notes"] == [
        f"incomplete: {planned - finished} of {planned} runs are missing"
    ]
    assert (out / "report.html").is_file()


# ---- bench and gallery ----


def test_bench_measures_stages_growth_and_peers(tmp_path: Path) -> None:
    out = tmp_path / "bench.json"
    done = command(
        "bench", "--preset", "tiny", "--seconds", 0.001, "--frames", 12, "--trackers", "asttrack:tiny,medianflow", "--out", out
    )
    assert done.returncode == 0, done.stderr
    figures = json.loads(out.read_text())
    (library,) = figures["libraries"]
    times = {name: timing["median_ms"] for name, timing in library["stages"].items()}
    assert {"update, paper, literal scoring", "update, paper, gram scoring"} <= times.keys()
    assert all(time > 0 for time in times.values())
    assert all(timing["least_ms"] <= timing["median_ms"] for timing in library["stages"].values())
    particles = library["sweeps"][0]
    assert [point["value"] for point in particles["points"]] == [75, 150, 300, 600, 1200]
    values, medians = ([point[key] for point in particles["points"]] for key in ("value", "median_ms"))
    assert particles["exponent"] == pytest.approx(np.polyfit(np.log(values), np.log(medians), 1)[0], abs=1e-3)
    (race,) = figures["races"]
    assert {tracker["tracker"] for tracker in race["trackers"]} == {"asttrack:tiny", "medianflow"}
    for text in ("stage, ms (median)", "exponent", "has the object for"):
        assert text in done.stdout


def test_bench_shows_and_keeps_earlier_figures(tmp_path: Path) -> None:
    first, second, document = tmp_path / "first.json", tmp_path / "second.json", tmp_path / "performance.md"
    document.write_text("# Speed\n\n<!-- figures: begin -->\n<!-- figures: end -->\n")
    trackers = "asttrack:tiny,medianflow,kcf"
    done = command("bench", "--only-trackers", "--passes", 2, "--frames", 8, "--trackers", trackers, "--out", first)
    assert done.returncode == 0, done.stderr
    assert not json.loads(first.read_text())["libraries"]
    again = command("bench", "--read", first, "--out", second, "--markdown", document)
    assert again.returncode == 0, again.stderr
    assert again.stdout == done.stdout
    assert json.loads(second.read_text()) == json.loads(first.read_text())
    assert "| `medianflow` |" in document.read_text()


def test_bench_refuses_what_are_no_figures(tmp_path: Path) -> None:
    path = tmp_path / "figures.json"
    path.write_text("{}")
    assert "not the figures of `bench --out`" in complaint(command("bench", "--read", path), 1)
    assert "not the figures of `make bench`" in complaint(command("bench", "--core", path), 1)
    assert "--only-trackers" in complaint(command("bench", "--only-trackers", "--trackers", ""), 2)


def test_bench_goes_on_without_a_library_that_is_none(tmp_path: Path) -> None:
    (tmp_path / "liasttrack.so").write_text("not a library")
    done = command("bench", "--library", tmp_path / "liasttrack.so", "--seconds", 0.001, "--frames", 4, "--trackers", "")
    assert "liasttrack.so" in complaint(done, 1)
    assert "absent.so: no such file" in complaint(command("bench", "--library", tmp_path / "absent.so"), 1)


def test_the_gallery_is_drawn(tmp_path: Path) -> None:
    out = tmp_path / "gallery"
    done = command("gallery", out, "--frames", 80, "--jobs", 2)
    assert done.returncode == 0, done.stderr
    page = (out / "README.md").read_text()
    for path in out.iterdir():
        if path.suffix == ".png":
            picture = cv2.imread(str(path))
            assert picture is not None
            assert picture.std() > 10
        if path.suffix == ".svg":
            assert path.read_text().startswith("<svg")
            assert "currentColor" not in path.read_text()
        assert path.name == "README.md" or f"]({path.name})" in page
    assert len(list(out.iterdir())) == 7
