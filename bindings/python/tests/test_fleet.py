"""Many sequences over a Dask cluster of two worker processes, one of which is killed."""

import logging
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

import dask
import pytest
from distributed import Client, LocalCluster
from pyarrow import parquet  # type: ignore[import-untyped]

from asttrack.fleet import connected
from asttrack.scene import Scene
from terminal import all_shown, open_terminal, shown_until

COUNT: Final = 6
FRAMES: Final = 40
PARTICLES: Final = 100
PATIENCE: Final = 300.0  # seconds for what takes a moment, on however busy a machine


@pytest.fixture(scope="module")
def sequences(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("fleet")
    for number in range(COUNT):
        Scene(frames=FRAMES, width=160, height=120, size=(28, 24), seed=number + 1).write(directory / f"scene{number}")
    return directory


@pytest.fixture
def client() -> Iterator[Client]:
    patient = {f"distributed.comm.timeouts.{what}": f"{PATIENCE} s" for what in ("connect", "tcp")}
    with dask.config.set(patient):
        cluster = LocalCluster(  # type: ignore[no-untyped-call]
            n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None, silence_logs=50
        )
        with cluster, Client(cluster) as client:  # type: ignore[no-untyped-call]
            client.wait_for_workers(2, timeout=PATIENCE)
            yield client


def words(sequences: list[Path], *options: object) -> list[str]:
    settings = ["--preset", "paper", "--set", f"particles={PARTICLES}"]
    return [sys.executable, "-m", "asttrack", "fleet", *map(str, sequences), *settings, *map(str, options)]


def fleet(*arguments: object) -> subprocess.CompletedProcess[str]:
    sequences, *options = arguments
    assert isinstance(sequences, list)
    return subprocess.run(words(sequences, *options), capture_output=True, text=True, check=False, timeout=PATIENCE)


class Gates:
    """Copies of sequences with a pipe for a frame: who comes to it waits, inside the sequence, until the frame is there."""

    def __init__(self, sequences: Path, directory: Path, numbers: Iterable[int]) -> None:
        shutil.copytree(sequences, directory)
        self._frames: dict[Path, bytes] = {}
        self._writers: dict[Path, int] = {}
        for number in numbers:
            frame = directory / f"scene{number}" / "img" / f"{FRAMES // 2:05d}.pgm"
            self._frames[frame] = frame.read_bytes()
            frame.unlink()
            os.mkfifo(frame)

    def wait_for(self, count: int) -> None:
        """Until so many wait."""
        end = time.monotonic() + PATIENCE
        while len(self._writers) < count:
            assert time.monotonic() < end, f"{len(self._writers)} of {count} came to a pipe"
            for frame in self._frames.keys() - self._writers.keys():
                with suppress(OSError):  # nobody reads it yet
                    self._writers[frame] = os.open(frame, os.O_WRONLY | os.O_NONBLOCK)
            time.sleep(0.02)

    def open(self) -> None:
        """Lets go who waits; whoever comes finds a frame."""
        for frame, content in self._frames.items():
            real = frame.with_suffix(".real")
            real.write_bytes(content)
            real.replace(frame)
        for frame, writer in self._writers.items():
            with suppress(BrokenPipeError):  # the reader was killed
                os.write(writer, self._frames[frame])
            os.close(writer)


def test_a_killed_worker_changes_nothing(client: Client, sequences: Path, tmp_path: Path) -> None:
    address = client.scheduler_info()["address"]
    calm = fleet([sequences], "--scheduler", address, "--out", tmp_path / "calm.csv", "--tracks", tmp_path / "calm_tracks.csv")
    assert calm.returncode == 0, calm.stderr
    before: dict[str, int] = client.run(os.getpid)

    gates = Gates(sequences, tmp_path / "gated", range(COUNT))
    stormy: list[subprocess.CompletedProcess[str]] = []
    arguments: list[Any] = [
        [tmp_path / "gated"],
        "--scheduler",
        address,
        "--out",
        tmp_path / "stormy.csv",
        "--tracks",
        tmp_path / "stormy_tracks.csv",
    ]
    thread = threading.Thread(target=lambda: stormy.append(fleet(*arguments)))
    thread.start()
    # Both workers are inside a sequence, and others are still to come.
    gates.wait_for(2)
    victim = next(iter(before))
    os.kill(before[victim], signal.SIGKILL)
    gates.open()
    thread.join(2 * PATIENCE)
    (done,) = stormy

    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    client.wait_for_workers(2, timeout=PATIENCE)
    after: dict[str, int] = client.run(os.getpid)
    assert before[victim] not in after.values()
    assert len(set(before.values()) & set(after.values())) == 1

    table = (tmp_path / "calm.csv").read_text()
    assert [line.split(",")[0] for line in table.splitlines()[1:]] == [f"scene{number}" for number in range(COUNT)]
    assert (tmp_path / "stormy.csv").read_text() == table
    tracks = (tmp_path / "calm_tracks.csv").read_text()
    assert len(tracks.splitlines()) == 1 + COUNT * FRAMES
    assert (tmp_path / "stormy_tracks.csv").read_text() == tracks
    assert done.stdout == calm.stdout


def test_a_cluster_of_its_own_writes_parquet_and_tells_what_failed(sequences: Path, tmp_path: Path) -> None:
    chosen = [sequences / "scene0", tmp_path / "absent", sequences / "scene1"]
    done = fleet(
        chosen,
        "--set",
        "particles=60",
        "--workers",
        2,
        "--out",
        tmp_path / "table.parquet",
        "--tracks",
        tmp_path / "tracks.parquet",
    )
    assert done.returncode == 1
    assert done.stderr.splitlines() == [f"asttrack: {tmp_path}/absent: no such directory"]
    table = parquet.read_table(tmp_path / "table.parquet").to_pylist()
    assert [row["sequence"] for row in table] == ["scene0", "scene1"]
    assert all(row["frames"] == FRAMES and row["tracker"] == f"paper,particles={PARTICLES},particles=60" for row in table)
    tracks = parquet.read_table(tmp_path / "tracks.parquet").to_pylist()
    assert len(tracks) == 2 * FRAMES
    assert [tracks[FRAMES - 1][side] for side in "xywh"] == pytest.approx([table[0][f"last_{side}"] for side in "xywh"], abs=0.01)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["table.parquet", "tracks.parquet"]


def test_no_scheduler_and_no_sequence_are_one_line(sequences: Path, tmp_path: Path) -> None:
    with socket.socket() as another:
        with suppress(OSError):  # taken by a real cluster, the port that Dask likes is as little free
            another.bind(("127.0.0.1", 8787))
            another.listen()
        done = fleet([tmp_path / "absent"], "--workers", 1)
    assert done.returncode == 1
    assert done.stderr.splitlines() == [f"asttrack: {tmp_path}/absent: no such directory", "asttrack: no sequence was tracked"]
    bad = fleet([sequences], "--scheduler", "nonsense://127.0.0.1:1")
    assert bad.returncode == 1
    assert bad.stderr.startswith("asttrack: nonsense://127.0.0.1:1: no Dask scheduler answers: ")
    assert len(bad.stderr.splitlines()) == 1


def test_a_connection_leaves_the_loggers_of_the_process_alone(client: Client) -> None:
    def levels() -> dict[str, int]:
        known = [name for name in logging.root.manager.loggerDict if name.split(".")[0] in ("distributed", "tornado", "asyncio")]
        return {name: logging.getLogger(name).level for name in known}

    def changed(since: dict[str, int]) -> dict[str, int]:
        return {name: level for name, level in levels().items() if since.get(name, level) != level}

    before = levels()
    assert {"distributed", "distributed.client", "asyncio"} <= set(before)
    with connected(client.scheduler_info()["address"], 1):
        assert changed(before) == {}
    assert changed(before) == {}


@pytest.mark.parametrize("own", [False, True])
def test_an_interrupt_keeps_what_is_finished(client: Client, sequences: Path, tmp_path: Path, own: bool) -> None:
    cluster = ["--workers", 1] if own else ["--scheduler", client.scheduler_info()["address"]]
    gates = Gates(sequences, tmp_path / "gated", [COUNT - 1])  # the last one is never finished
    reader, terminal = open_terminal()
    process = subprocess.Popen(
        words([tmp_path / "gated"], *cluster, "--out", tmp_path / "table.csv"),
        stdout=subprocess.DEVNULL,
        stderr=terminal,
        start_new_session=True,
    )
    os.close(terminal)
    shown = shown_until(reader, lambda text: re.search(rf"\b[1-9]/{COUNT}", text) is not None)
    # A terminal sends it to the whole group of processes: workers of its own cluster must not mind.
    os.killpg(process.pid, signal.SIGINT)
    shown += all_shown(reader)
    assert process.wait(PATIENCE) == 130, shown
    gates.open()
    assert "Traceback" not in shown
    finished = len((tmp_path / "table.csv").read_text().splitlines()) - 1
    assert 1 <= finished < COUNT
    assert f"interrupted: {finished} of {COUNT} sequences are finished and kept" in shown
