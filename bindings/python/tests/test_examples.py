"""The example programs run as their own documentation says."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from header import REPOSITORY
from short_scene import BOXES, FRAMES, HEIGHT, WIDTH

EXAMPLES = REPOSITORY / "examples" / "python"
BOX = ",".join(f"{side:.2f}" for side in BOXES[0])


def example(name: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, EXAMPLES / name, *map(str, arguments)], capture_output=True, text=True, check=False, timeout=400
    )


def centres(x: float, y: float, w: float, h: float) -> tuple[float, float]:
    return x + w / 2, y + h / 2


# ---- PGM frames ----


@pytest.mark.parametrize("options", [(), ("--box", BOX)])
def test_pgm_frames_are_followed(tmp_path: Path, options: tuple[str, ...]) -> None:
    (tmp_path / "img").mkdir()
    for number, frame in enumerate(FRAMES, 1):
        (tmp_path / "img" / f"{number:05d}.pgm").write_bytes(f"P5\n{WIDTH} {HEIGHT}\n255\n".encode() + frame.tobytes())
    (tmp_path / "groundtruth.txt").write_text(f"{BOX}\n0,0,1,1\n")
    done = example("track_pgm.py", tmp_path, *options)
    assert (done.returncode, done.stderr) == (0, "")
    heading, *lines = done.stdout.splitlines()
    assert heading == "frame,x,y,w,h,score,status"
    assert len(lines) == len(FRAMES) - 1
    name, *sides, _score, status = lines[-1].split(",")
    assert (name, status) == (f"{len(FRAMES):05d}", "TRACKING")
    assert np.allclose(centres(*map(float, sides)), centres(*BOXES[-1]), atol=8)


def test_pgm_comments_and_frames_beside_the_truth_are_read(tmp_path: Path) -> None:
    for name, frame in zip(("9", "10", "0011"), FRAMES, strict=False):
        header = f"P5\n# a comment\n{WIDTH}\n# another\n{HEIGHT} 255\n"
        (tmp_path / f"{name}.pgm").write_bytes(header.encode() + frame.tobytes())
    done = example("track_pgm.py", tmp_path, "--box", BOX)
    assert (done.returncode, done.stderr) == (0, "")
    assert [line.split(",")[0] for line in done.stdout.splitlines()] == ["frame", "10", "0011"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "no PGM frames in it"),
        (b"P2\n1 1\n255\n0", "1.pgm: not a binary 8-bit PGM file"),
        (b"P5\n1 1\n65535\n00", "1.pgm: not a binary 8-bit PGM file"),
        (b"P5\n4 4\n255\n1234", "1.pgm: truncated: 4 of 16 pixels"),
        (b"P5\n2 2\n255\n1234", "the box is not finite"),
    ],
)
def test_a_bad_pgm_is_one_line(tmp_path: Path, content: bytes | None, message: str) -> None:
    if content is not None:
        (tmp_path / "1.pgm").write_bytes(content)
    done = example("track_pgm.py", tmp_path, "--box", "5,5,2,2")
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert message in done.stderr


def test_a_missing_truth_is_named(tmp_path: Path) -> None:
    (tmp_path / "1.pgm").write_bytes(b"P5\n2 2\n255\n1234")
    done = example("track_pgm.py", tmp_path)
    assert (done.returncode, len(done.stderr.splitlines())) == (1, 1)
    assert "groundtruth.txt: no box in its first line" in done.stderr


def test_a_malformed_box_is_a_matter_of_usage(tmp_path: Path) -> None:
    assert example("track_pgm.py", tmp_path, "--box", "1,2,3").returncode == 2


# ---- Videos ----


@pytest.fixture
def video(tmp_path: Path) -> Path:
    cv2 = pytest.importorskip("cv2", reason="OpenCV is not installed: extra eval")
    path = tmp_path / "scene.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 25.0, (WIDTH, HEIGHT))
    for frame in FRAMES:
        writer.write(np.dstack([frame] * 3))
    writer.release()
    return path


def test_a_video_is_followed_and_annotated(video: Path, tmp_path: Path) -> None:
    import cv2

    out = tmp_path / "annotated.mp4"
    done = example("track_video.py", video, "--box", BOX, "--out", out)
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert len(lines) == len(FRAMES) - 1
    _number, *sides, _score, _status = lines[-1].split()
    assert np.allclose(centres(*map(float, sides)), centres(*BOXES[-1]), atol=8)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["annotated.mp4", "scene.avi"]

    capture = cv2.VideoCapture(str(out))
    pictures = 0
    while True:
        ok, picture = capture.read()
        if not ok:
            break
        pictures += 1
        coloured = np.ptp(picture.astype(int), axis=2) > 60  # the box is the only colour in a grey scene
        assert coloured.sum() > 100
    assert pictures == len(FRAMES) - 1


def test_a_video_is_followed_without_a_file_to_write(video: Path) -> None:
    done = example("track_video.py", video, "--box", BOX)
    assert (done.returncode, len(done.stdout.splitlines())) == (0, len(FRAMES) - 1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("{video}", "--box", "900,0,9,9", "--out", "{folder}/a.mp4"), "the box is not finite"),
        (("{folder}/none.avi", "--box", BOX), "none.avi: not a video or camera that OpenCV can read"),
        (("{video}", "--box", BOX, "--out", "{folder}/nowhere/a.mp4"), "nowhere/a.mp4: cannot be written"),
    ],
)
def test_bad_videos_and_places_are_named_and_leave_nothing(
    video: Path, tmp_path: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = example("track_video.py", *(word.format(video=video, folder=tmp_path) for word in arguments))
    assert done.returncode == 1
    assert message in done.stderr.splitlines()[-1]
    assert done.stderr.splitlines()[-1].startswith("track_video: ")
    assert [path.name for path in tmp_path.iterdir()] == ["scene.avi"]


def test_windows_that_opencv_lacks_are_named(video: Path) -> None:
    import cv2

    if "GUI:                           NONE" not in cv2.getBuildInformation():
        pytest.skip("this OpenCV has windows")
    done = example("track_video.py", video, "--select")
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == (
        "track_video: this OpenCV has no windows: install opencv-python instead of a headless one"
    )


def test_a_box_or_select_is_wanted(video: Path) -> None:
    assert example("track_video.py", video).returncode == 2
