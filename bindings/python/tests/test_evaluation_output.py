"""Outputs appear whole or not at all."""

import os
import stat
from pathlib import Path

import pytest

from asttrack.failures import DataError
from asttrack.output import make_directory, replacing, write_text


def test_a_file_is_replaced_with_the_rights_that_new_files_have(tmp_path: Path) -> None:
    target, fresh = tmp_path / "table.csv", tmp_path / "fresh"
    target.write_text("old")
    write_text(target, "new é\n")
    fresh.touch()
    assert target.read_text(encoding="utf-8") == "new é\n"
    assert stat.S_IMODE(target.stat().st_mode) == stat.S_IMODE(fresh.stat().st_mode)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fresh", "table.csv"]


@pytest.mark.parametrize("failure", [OSError(28, "No space left on device"), KeyboardInterrupt(), ValueError("other")])
def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path, failure: BaseException) -> None:
    target = tmp_path / "video.mp4"
    target.write_text("old")

    def fail() -> None:
        with replacing(target) as path:
            assert path.parent == tmp_path
            assert path.suffix == ".mp4"
            path.write_text("half")
            raise failure

    with pytest.raises(DataError if isinstance(failure, OSError) else type(failure)) as told:
        fail()
    if isinstance(failure, OSError):
        assert str(told.value) == f"{target}: No space left on device"
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_a_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    link = tmp_path / "link.csv"
    link.symlink_to(tmp_path / "real" / "table.csv")
    write_text(link, "text")
    assert link.is_symlink()
    assert (tmp_path / "real" / "table.csv").read_text() == "text"


def test_a_pipe_is_written_in_place(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_text(pipe, "text")
        assert os.read(reader, 100) == b"text"
    finally:
        os.close(reader)
    assert pipe.is_fifo()


def test_places_that_take_no_file_are_told(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(DataError, match="is a directory"):
        write_text(tmp_path, "text")
    with pytest.raises(DataError, match=r"absent/table\.csv: No such file or directory"):
        write_text(tmp_path / "absent" / "table.csv", "text")
    with pytest.raises(DataError, match="file/out: Not a directory"):
        make_directory(tmp_path / "file" / "out")
    make_directory(tmp_path / "new" / "out")
    assert list((tmp_path / "new" / "out").iterdir()) == []
