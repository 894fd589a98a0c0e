"""The report, in a real browser: its script runs, its tables sort, its pictures load, and it asks for nothing."""

import html
import json
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np
import pytest

import small_sequence
from asttrack.evaluation.report import render
from asttrack.evaluation.results import Evaluation
from asttrack.evaluation.sequence import read_sequence
from asttrack.scene import Scene

BROWSERS: Final = ("chromium", "chromium-browser", "google-chrome")
FLAGS: Final = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",  # a container's /dev/shm is small
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    # Whatever it might ask for, it gets no answer.
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--enable-logging=stderr",
)
TRACKERS: Final = "asttrack:tiny:particles=30,asttrack:tiny,mosse"
# Put at the end of the page: does what a reader does, and writes what there is to see into the page.
PROBE: Final = """
<script>
window.addEventListener("load", () => {
    const table = document.querySelector("table");
    const head = [...table.tHead.rows[0].cells].find((cell) => cell.textContent.startsWith("centre error"));
    const column = () => [...table.tBodies[0].rows].map((row) => row.cells[head.cellIndex].dataset.value);
    const names = () => [...table.tBodies[0].rows].map((row) => row.cells[0].textContent);
    const seen = { before: column(), names: names() };
    head.querySelector("button").click();
    seen.once = [head.getAttribute("aria-sort"), column()];
    head.querySelector("button").click();
    seen.twice = [head.getAttribute("aria-sort"), column()];
    table.tHead.rows[0].cells[0].querySelector("button").click();
    seen.byName = names();
    seen.oneSorted = table.querySelectorAll("[aria-sort]").length;
    const line = document.querySelector(".chart svg .t0");
    const box = document.querySelector(".still rect.t0");
    const shown = () => [line, box].map((one) => getComputedStyle(one).display !== "none");
    seen.shown = [shown()];
    const chip = document.querySelector(".legend button");
    chip.click();
    seen.shown.push(shown(), chip.getAttribute("aria-pressed"));
    chip.click();
    seen.shown.push(shown());
    seen.images = [...document.images].map((image) => image.complete && image.naturalWidth > 0);
    seen.requests = performance.getEntriesByType("resource").map((entry) => entry.name).filter((name) => !name.startsWith("data:"));
    seen.wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
    const text = getComputedStyle(document.body);
    seen.colours = [text.color, text.backgroundColor];
    const probe = document.createElement("pre");
    probe.id = "probe";
    probe.textContent = JSON.stringify(seen);
    document.body.append(probe);
});
</script>
"""


@pytest.fixture(scope="module")
def evaluation(tmp_path_factory: pytest.TempPathFactory) -> Evaluation:
    directory = tmp_path_factory.mktemp("report")
    one = small_sequence.write(directory / "one")
    Scene(frames=30, width=200, height=120, size=(24, 30), seed=4).write(directory / "<two> & more")
    two = read_sequence(directory / "<two> & more")
    return small_sequence.evaluated([one, two], TRACKERS, seeds=2, spatial=True)


@pytest.fixture(scope="module")
def page(evaluation: Evaluation) -> str:
    return render(evaluation, compare=True)


class Parts(HTMLParser):
    """Checks that elements are closed in order, and keeps what matters of them."""

    VOID: Final = {"meta", "link", "img", "br", "rect", "path", "use", "circle", "input"}

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.links: list[str] = []
        self.identities: list[str] = []
        self.texts: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("src", "href", "xlink:href") and value is not None:
                self.links.append(value)
            if name == "id" and value is not None:
                self.identities.append(value)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if not self.open or self.open[-1] not in ("style", "script"):
            self.texts.append(data)


def test_the_page_is_whole_and_asks_for_nothing(page: str) -> None:
    parts = Parts()
    parts.feed(page)
    parts.close()
    assert parts.open == []
    assert all(link.startswith(("data:", "#")) for link in parts.links)
    assert len(parts.identities) == len(set(parts.identities))
    assert {link[1:] for link in parts.links if link.startswith("#")} <= set(parts.identities)
    assert "@import" not in page
    assert not re.search(r"url\((?!#)", page)


def test_names_are_shown_as_they_are(page: str) -> None:
    parts = Parts()
    parts.feed(page)
    text = " ".join(parts.texts)
    assert "<two> & more" in text
    assert "<two>" not in page
    for label in TRACKERS.split(","):
        assert label in text
    for heading in (
        "Over all sequences",
        "Does it know when it is wrong?",
        "When the first box is a little off",
        "What each part is worth",
        "How this was measured",
    ):
        assert heading in text


def test_what_a_reader_must_know_comes_first(evaluation: Evaluation) -> None:
    told = Evaluation(
        evaluation.sequences,
        evaluation.trackers,
        evaluation.conditions,
        evaluation.runs,
        ["two: <a> reason"],
        evaluation.planned + 1,
    )
    page = render(told, compare=False)
    assert page.index("two: &lt;a&gt; reason") < page.index("Over all sequences")
    assert f"incomplete: 1 of {evaluation.planned + 1} runs are missing" in page
    assert "What each part is worth" not in page
    assert "Know before you read on" not in render(evaluation, compare=False)


def browser() -> str:
    for name in BROWSERS:
        found = shutil.which(name)
        if found is not None:
            return found
    pytest.skip(f"no browser to look at the report with: none of {', '.join(BROWSERS)} is installed")


def visit(page: Path, directory: Path, *options: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        [browser(), *FLAGS, f"--user-data-dir={directory / 'profile'}", *options, page.as_uri()],
        capture_output=True,
        text=True,
        check=False,
        timeout=400,
    )
    assert done.returncode == 0, done.stderr
    complaints = [line for line in done.stderr.splitlines() if ":CONSOLE" in line]
    assert complaints == []
    return done


def probed(text: str, directory: Path, *options: str) -> dict[str, Any]:
    path = directory / "report.html"
    path.write_text(text.replace("</body>", f"{PROBE}</body>"), encoding="utf-8")
    dom = visit(path, directory, "--virtual-time-budget=5000", "--dump-dom", *options).stdout
    found = re.search(r'<pre id="probe">(.*?)</pre>', dom, re.DOTALL)
    assert found is not None, dom[-2000:]
    seen: dict[str, Any] = json.loads(html.unescape(found[1]))
    return seen


def test_in_a_browser_it_sorts_hides_and_loads(page: str, evaluation: Evaluation, tmp_path: Path) -> None:
    seen = probed(page, tmp_path, "--window-size=1300,900")
    values = [float(value) for value in seen["before"]]
    assert len(values) == len(evaluation.trackers)
    assert values != sorted(values)
    assert seen["once"] == ["ascending", [f"{value:.6g}" for value in sorted(values)]]
    assert seen["twice"] == ["descending", [f"{value:.6g}" for value in sorted(values, reverse=True)]]
    assert sorted(seen["byName"]) == sorted(seen["names"]) == sorted(evaluation.labels)
    assert seen["byName"] == sorted(seen["names"], key=str.lower)
    assert seen["oneSorted"] == 1
    assert seen["shown"] == [[True, True], [False, False], "false", [True, True]]
    # Film strips of two sequences, and pictures of their bags.
    assert len(seen["images"]) >= 2 * 7 + 6
    assert all(seen["images"])
    assert seen["requests"] == []
    assert not seen["wide"]


@pytest.mark.parametrize("width", [390, 800])
def test_it_fits_narrow_windows(page: str, tmp_path: Path, width: int) -> None:
    assert not probed(page, tmp_path, f"--window-size={width},900")["wide"]


def brightness(colour: str) -> float:
    red, green, blue = (int(part) for part in re.findall(r"\d+", colour)[:3])
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def test_it_is_readable_in_light_and_in_dark(page: str, tmp_path: Path) -> None:
    means = []
    for number, options in enumerate(((), ("--force-dark-mode",))):
        place = tmp_path / str(number)
        place.mkdir()
        text, ground = map(brightness, probed(page, place, *options)["colours"])
        assert (ground - text > 150) if number == 0 else (text - ground > 150)
        picture = place / "report.png"
        visit(place / "report.html", place, f"--screenshot={picture}", "--window-size=1300,1400", *options)
        seen = cv2.imread(str(picture))
        assert seen is not None
        assert seen.shape == (1400, 1300, 3)
        means.append(float(np.median(seen)))
    assert means[0] > 200
    assert means[1] < 60
