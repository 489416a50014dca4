"""The HTML report stands alone, and a browser shows it."""

import re
import shutil
import subprocess
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image

from discjump.envs.tasks import SKI
from discjump_training.courses import HELD_OUT
from discjump_training.curves import Curves
from discjump_training.judge import Conditions, Entrant, Keep, evaluation, find, from_function, judge
from discjump_training.judge.page import render
from discjump_training.picture import SPEEDS

from .conftest import ahead

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
HEADINGS = ["Scores", "Pair by pair", "Failures", "Time to beacon, s by start distance, m", "Episodes"]
NAMES = ("tacker", "skier", "<b>ahead & on</b>")
CURVE = "steps,validation_seconds\n0,60\n1000000,25.5\n2000000,17.2\n"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    conditions = Conditions(HELD_OUT, 12, threads=1)
    entered = [Entrant(name, (find(name, HELD_OUT),)) for name in NAMES[:2]]
    # A name that would break the page were it not escaped.
    entered.append(Entrant(NAMES[2], (from_function(ahead, NAMES[2]),)))
    made = evaluation(
        conditions, judge(entered, conditions, Keep(failures=folder / "failures", paths=(0, 1)))
    )
    (folder / "curve.csv").write_text(CURVE)
    path = folder / "evaluation.html"
    path.write_text(render(made, Curves(SKI, {"runs/mine": [folder / "curve.csv"]}, {"skier": 22.0})))
    return path


class Reader(HTMLParser):
    """Collects what the page would fetch, its tags, and its headings."""

    def __init__(self):
        super().__init__()
        self.fetched: list[str] = []
        self.tags: list[str] = []
        self.headings: list[str] = []
        self.text = ""

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in ("a", "svg", "use"):
            wanted = [
                value for name, value in attrs if name in ("src", "href", "srcset", "data", "xlink:href")
            ]
            self.fetched += [value for value in wanted if value and not value.startswith(("data:", "#"))]

    def handle_data(self, data):
        self.text += data
        if self.tags and self.tags[-1] == "h2" and data.strip():
            self.headings.append(data.strip())


def test_it_stands_alone(page):
    text = page.read_text()
    reader = Reader()
    reader.feed(text)
    assert reader.fetched == []
    assert "script" not in reader.tags
    assert not re.search(r"url\((?!#)|@import", text)
    assert len(text) < 3_000_000
    assert reader.headings == HEADINGS
    assert NAMES[2] in reader.text
    assert text.count("<img ") == 2
    assert text.count("<svg ") == 1 + 1 + 2


def test_figures_stand_in_it_as_in_the_tables(page):
    from discjump_training.judge import tables

    conditions = Conditions(HELD_OUT, 12, threads=1)
    made = evaluation(conditions, judge([Entrant("skier", (find("skier", HELD_OUT),))], conditions))
    reader = Reader()
    reader.feed(page.read_text())
    for cell in tables.policies(made).rows[0][2:]:
        for part in cell.replace("[", "").replace("]", "").replace(",", "").split():
            assert part in reader.text


def test_what_there_is_not_has_no_heading():
    conditions = Conditions(HELD_OUT, 3, threads=1)
    entered = [Entrant("skier", (find("skier", HELD_OUT),))]
    text = render(evaluation(conditions, judge(entered, conditions)))
    for absent in ("Learning curve", "Pair by pair", "Episodes</h2>", "Partial"):
        assert absent not in text
    assert "Partial" in render(evaluation(conditions, judge(entered, conditions), partial=True))


def test_speeds_have_one_scale():
    assert (SPEEDS.vmin, SPEEDS.vmax) == (0.0, 50.0)


@pytest.fixture(scope="module")
def browse(tmp_path_factory):
    browser = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if browser is None:
        pytest.skip(f"no browser is installed: none of {', '.join(BROWSERS)} (apt-get install chromium)")
    profile = tmp_path_factory.mktemp("profile")

    def call(page, *arguments):
        asked = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--window-size=1280,2400",
        ]
        asked += [f"--user-data-dir={profile}", "--enable-logging=stderr", *arguments, page.as_uri()]
        return subprocess.run([browser, *asked], capture_output=True, text=True, timeout=120, check=True)

    return call


def test_a_browser_shows_it(page, browse, tmp_path):
    shot = tmp_path / "shot.png"
    seen = browse(page, "--dump-dom", f"--screenshot={shot}")
    for line in seen.stderr.splitlines():
        assert "CONSOLE" not in line, line
    reader = Reader()
    reader.feed(seen.stdout)
    assert reader.headings == HEADINGS
    with Image.open(shot) as image:
        pixels = np.asarray(image.convert("RGB"))
    assert pixels.shape[1] == 1280
    # Text and charts all the way down, and colours of the maps: no blank page, nor one that stops half-way.
    for stripe in np.array_split(pixels, 6):
        assert stripe.std() > 8.0
    assert len(np.unique(pixels.reshape(-1, 3) // 16, axis=0)) > 150


def test_the_browser_would_tell_of_errors(browse, tmp_path):
    """The check above can fail: a page that fetches what is not there, or whose script breaks, is heard."""
    broken = tmp_path / "broken.html"
    broken.write_text("<!doctype html><script>nothing.there()</script><img src='missing.png'>")
    seen = browse(broken, "--dump-dom")
    assert "CONSOLE" in seen.stderr
