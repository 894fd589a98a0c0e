"""The page of measured tables: its places are filled from what the evaluation writes, and what is not measured stays."""

import re
import subprocess
import sys
from pathlib import Path

from asttrack.evaluation.conditions import conditions
from asttrack.evaluation.store import markdown_text
from header import REPOSITORY

PAGE = """# A page

<!-- table one/tables.md: one-pass -->
old
<!-- end -->

between

<!-- table two/tables.md: confidence -->
kept
<!-- end -->
"""


def insert(page: Path, directory: Path) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, REPOSITORY / "scripts" / "insert_tables.py", page, directory]
    return subprocess.run([*map(str, words)], capture_output=True, text=True, check=False, cwd=REPOSITORY)


def test_places_are_filled_again_and_again(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    tables = [("confidence", [["head"], ["other"]]), ("one-pass evaluation", [["head", "more"], [], ["a|b", "1.5"]])]
    (tmp_path / "one" / "tables.md").write_text(markdown_text(conditions(1), ["a note"], tables))
    page = tmp_path / "page.md"
    page.write_text(PAGE)
    for _ in range(2):
        done = insert(page, tmp_path)
        assert done.returncode == 0, done.stderr
        assert done.stdout.splitlines() == [
            f"{tmp_path}/two/tables.md: not there, its table stays as it was", f"written: {page}",
        ]  # fmt: skip
    text = page.read_text()
    assert "| head | more |\n| --- | --- |\n| a\\|b | 1.5 |\n\nMade by `" in text
    assert re.search(r"Commit ([0-9a-f]+\+?|unknown)\.\n\n<!-- end -->\n\nbetween", text)
    assert "old" not in text
    assert "other" not in text
    assert "-->\nkept\n<!--" in text


def test_a_section_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "tables.md").write_text(markdown_text(conditions(1), [], [("another", [["head"]])]))
    page = tmp_path / "page.md"
    page.write_text(PAGE)
    done = insert(page, tmp_path)
    assert (done.returncode, done.stderr) == (
        1,
        f"insert_tables: {tmp_path}/one/tables.md: no section that begins with 'one-pass'\n",
    )
    assert page.read_text() == PAGE


def test_every_place_of_the_page_is_one_that_is_measured() -> None:
    text = (REPOSITORY / "docs" / "accuracy.md").read_text(encoding="utf-8")
    places = re.findall(r"^<!-- table (\w+)/(\S+): .+ -->$", text, re.MULTILINE)
    assert len(places) == text.count("<!-- end -->") == 6
    recipe = (REPOSITORY / "Makefile").read_text().split("\naccuracy-tables:")[1].split("\n\n")[0]
    measured = set(re.findall(r"measured,\w+,(\w+)\)", recipe)) | set(re.findall(r"--out \$\(BUILDDIR\)/accuracy/(\w+)", recipe))
    assert {name for name, _ in places} == measured
