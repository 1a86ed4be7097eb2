"""An attempt played back from a bag: motion is that of the messages, the ghost is in step, and the page is bounded."""

from __future__ import annotations

import math
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cellc.mock.folder import read_folder
from cellc.tools.attempt.heard import JointSample
from cellc.tools.attempt.read import read_attempt
from cellc.tools.view.bag_motion import MOST_PICTURES, PictureBuilder
from cellc.tools.view.bag_run import bag_run
from cellc.tools.view.skeleton import Skeleton
from cellc.tools.view.standing import of_package
from tests.attempt.hand_made import MS, SUCCEEDED, HandMade, arrived, protective_stop
from tests.cells import generated
from tests.cli.run import Ran, run
from tests.view.page import Page

PICK = generated("ur5e_pick").as_posix()
HOSTILE = "x\x1b[2J\r\n::error::| </script><script>alert(1)</script><img src=x onerror=alert(1)>\u202e"


def turning(rate: float, begin_ms: int = 0, pan: float = 0.0) -> HandMade:
    """Return a move whose arm turns about the vertical from its acceptance on, for a second, at a rate in rad/s.

    Args:
        begin_ms: by how much the recording was started earlier.
    """
    bag = HandMade()
    for at_ms in (-begin_ms, *range(4, 1500, 4)):
        angle = pan + rate * min(max(at_ms - 150, 0), 1000) / 1000
        bag.joints(at_ms * MS, [angle, -1.5, 1.5, -1.5, -1.5, 0.0, 0.0])
    bag.begin_move()
    bag.end_move(1160 * MS, SUCCEEDED)
    return bag


def viewed(bag: Path, folder: Path, *words: str) -> tuple[Ran, Page]:
    """Return what the command says of a bag of the cell, and its page."""
    ran = run("view", PICK, "--bag", bag.as_posix(), "-o", (folder / "x.html").as_posix(), *words)
    assert (ran.code, ran.err) == (0, "")
    return ran, Page((folder / "x.html").read_text(encoding="utf-8"))


def headings(page: Page, link: str) -> list[tuple[float, float]]:
    """Return time and heading, in rad about the vertical, of a link in the first run."""
    run_, groups = page.data["runs"][0], page.data["scene"]["groups"]
    (poses,) = (track["poses"] for track in run_["tracks"] if groups[track["group"]] == link)
    found = []
    for number, at_s in enumerate(run_["times"]):
        x, y, z, w = poses[7 * number + 3 : 7 * number + 7]
        found.append((at_s, math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))))
    return found


def test_links_turn_as_the_joint_states_say(tmp_path: Path) -> None:
    _, page = viewed(turning(0.8).write(tmp_path / "bag"), tmp_path)
    found = headings(page, "arm_shoulder_link")
    _, first = found[0]
    for at_s, heading in found:
        turned = math.remainder(heading - first, math.tau)
        assert turned == pytest.approx(0.8 * min(max(at_s - 0.15, 0.0), 1.0), abs=1e-3)
    (moment,) = page.data["runs"][0]["moments"]
    assert (moment["outcome"], moment["works"]) == ("succeeded", [0.15, 1.16])
    assert page.data["runs"][0]["end_s"] == pytest.approx(1.496)


def test_both_runs_are_in_step_at_the_acceptance_of_their_first_goal(tmp_path: Path) -> None:
    other = turning(0.8).write(tmp_path / "other").as_posix()
    ran, page = viewed(turning(0.8, begin_ms=300).write(tmp_path / "bag"), tmp_path, "--against", other)
    assert "no ghost" not in ran.out
    real, ghost = page.data["runs"]
    accepted = [run_["moments"][0]["phases"] for run_ in (real, ghost)]
    begin = [next(phase["at_s"] for phase in phases if phase["name"].startswith("5 ")) for phases in accepted]
    assert (begin, real["ghost"]["shift_s"]) == ([0.45, 0.15], 0.3)
    (apart,) = real["ghost"]["apart"]
    assert apart["far_m"] < 2e-3


def test_how_far_apart_both_are_is_a_chord(tmp_path: Path) -> None:
    other = turning(0.8, pan=0.2).write(tmp_path / "other").as_posix()
    _, page = viewed(turning(0.8).write(tmp_path / "bag"), tmp_path, "--against", other)
    real, groups = page.data["runs"][0], page.data["scene"]["groups"]
    (apart,) = real["ghost"]["apart"]
    # The link that is named stands at some distance from the axis of the first joint, which is that of the base.
    base = groups.index("arm_shoulder_link")
    (poses,) = (track["poses"] for track in real["tracks"] if groups[track["group"]] == apart["name"])
    (axis,) = (track["poses"] for track in real["tracks"] if track["group"] == base)
    radius = math.hypot(poses[0] - axis[0], poses[1] - axis[1])
    assert apart["far_m"] == pytest.approx(2 * radius * math.sin(0.1), abs=1e-3)
    assert radius > 0.3
    assert f"Farthest apart: {apart['far_m'] * 1e3:.0f} mm at " in page.text


def sample(at_ns: int, *positions: float) -> JointSample:
    """Return a state of the joints a and b."""
    return JointSample(at_ns, ("a", "b"), np.array(positions))


def test_pictures_of_a_long_bag_are_bounded_and_exact() -> None:
    builder = PictureBuilder(("a", "b"))
    for at_ms in range(0, 3_600_000, 50):
        builder.take(at_ms * MS, sample(at_ms, math.sin(at_ms / 7000), 0.25))
    pictures = builder.pictures()
    assert MOST_PICTURES / 3 < len(pictures.times_ns) <= MOST_PICTURES
    assert pictures.step_ns == 40 * MS * 2 ** round(math.log2(pictures.step_ns / (40 * MS)))
    assert pictures.step_ns * MOST_PICTURES >= 3600 * 10**9
    for at_ns, row in zip(pictures.times_ns, pictures.positions, strict=True):
        assert row == pytest.approx([math.sin(at_ns / MS / 7000), 0.25])


def test_a_joint_at_rest_costs_nothing_and_where_it_begins_to_move_is_kept() -> None:
    builder = PictureBuilder(("a", "b"))
    for at_ms in range(0, 100_000, 10):
        noise = 4e-5 * (at_ms % 3 - 1)  # of an encoder
        builder.take(at_ms * MS, sample(at_ms, noise + 0.5 * max(0.0, at_ms / 1000 - 99), 0.25))
    times = [at_ns / 1e9 for at_ns in builder.pictures().times_ns]
    assert len(times) < 35
    # The last picture at rest is at most two slots before the motion, so that nothing glides until then.
    assert times[0] < 0.05
    assert 98.9 < times[1] <= 99.04


@pytest.mark.parametrize("position", [math.nan, math.inf, -1e300])
def test_what_is_no_position_is_not_drawn(position: float) -> None:
    builder = PictureBuilder(("a", "b"))
    builder.take(0, sample(0, 0.5, 0.25))
    builder.take(100 * MS, sample(100, position, 0.5))
    builder.take(10**18, sample(10**18, 1.0, 1.0))  # of a clock that jumped by years
    assert builder.pictures().positions.tolist() == [[0.5, 0.25], [0.5, 0.5]]


def test_the_page_says_what_the_comparison_says(tmp_path: Path) -> None:
    bag, other = protective_stop().write(tmp_path / "bag"), arrived().write(tmp_path / "other")
    words = ("--against", other.as_posix())
    _, page = viewed(bag, tmp_path, *words)
    told = run("attempt", bag.as_posix(), "--package", PICK, *words).out.splitlines()
    parted = [line.partition("   ")[2] for line in told if line.startswith("parted ")]
    assert parted
    for line in parted:
        assert line in page.text
    marks = page.data["runs"][0]["ghost"]["marks"]
    assert [mark["name"] for mark in marks] == ["step 1: outcome, time"]
    assert "layer stop" in page.text
    assert "Joint states are drawn 25 times a second" in page.text


def test_without_a_rehearsal_there_is_no_ghost_and_a_line_says_so(tmp_path: Path) -> None:
    ran, page = viewed(arrived().write(tmp_path / "bag"), tmp_path)
    assert ran.out.splitlines()[1:] == ["no ghost: no rehearsal is known; name one with --task or --against"]
    assert "No ghost: no rehearsal is known" in page.text
    assert len(page.data["runs"]) == 1
    assert "ghost" not in [attributes.get("data-layer") for _, attributes in page.elements]


@pytest.fixture(name="rehearsed", scope="module")
def rehearsed_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the evidence of a rehearsal that failed."""
    folder = tmp_path_factory.mktemp("rehearsed") / "evidence"
    ran = run("mock", PICK, "--rehearsal", "no_part", "--evidence", folder.as_posix())
    assert ran.code == 0, ran.err
    return folder


def test_a_bag_of_the_mock_is_beside_its_own_rehearsal_and_apart_nowhere(rehearsed: Path, tmp_path: Path) -> None:
    ran, page = viewed(rehearsed / "no_part.mcap", tmp_path)
    (_, of_page) = page.data["runs"]
    assert ran.out.count("\n") == 1
    assert of_page["name"] == "no_part"
    ghost = page.data["runs"][0]["ghost"]
    # The bag begins as the cell comes up, the rehearsal with its first step.
    assert (ghost["shift_s"], ghost["marks"]) == (page.data["runs"][0]["moments"][0]["from_s"], [])
    assert all(each["far_m"] < 1e-3 for each in ghost["apart"])
    assert "They part nowhere" in page.text
    # The same bytes again.
    first = (tmp_path / "x.html").read_bytes()
    viewed(rehearsed / "no_part.mcap", tmp_path)
    assert (tmp_path / "x.html").read_bytes() == first


def test_records_are_compared_with_and_are_no_ghost(rehearsed: Path, tmp_path: Path) -> None:
    records = rehearsed / "no_part.records.jsonl"
    ran, page = viewed(rehearsed / "no_part.mcap", tmp_path, "--against", records.as_posix())
    assert ran.out.splitlines()[1:] == [f"no ghost: {records.as_posix()} has no joint states"]
    assert "They part nowhere" in page.text


def test_a_step_without_an_instant_keeps_its_place(tmp_path: Path) -> None:
    folder = read_folder(generated("ur5e_pick"))
    paths = [arrived().write(tmp_path / "bag")]
    report = read_attempt(paths, folder.contract, folder.rehearsals, folder.watches, None)
    (made, end), standing = report.attempts, of_package(folder)
    unseen = replace(made, step="wait", started_ns=None, ended_ns=None, trace=())
    asked = replace(report, attempts=(made, unseen, made, end))
    run_ = bag_run("x", asked, PictureBuilder(()).pictures(), Skeleton(standing))
    spans = [(moment.name, moment.from_s, moment.until_s) for moment in run_.moments]
    # By hand: planned 100 ms after the begin, the planner ended at 505 ms.
    move = (made.step, 0.1, 0.505)
    assert spans == [move, ("wait", 0.505, 0.505), move]


def test_a_cut_off_bag_is_played_as_far_as_it_goes(rehearsed: Path, tmp_path: Path) -> None:
    cut = tmp_path / "no_part.mcap"
    data = (rehearsed / "no_part.mcap").read_bytes()
    cut.write_bytes(data[: len(data) * 7 // 10])
    _, page = viewed(cut, tmp_path)
    assert "was cut off" in page.text
    real, whole = page.data["runs"]
    assert 1.0 < real["end_s"] < whole["end_s"]


def test_the_name_of_the_page_and_the_package_are_those_of_the_cell(
    rehearsed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copytree(PICK, tmp_path / "generated/ur5e_pick")
    for _ in range(2):
        ran = run("view", "--bag", (rehearsed / "no_part.mcap").as_posix())
        assert (ran.code, ran.out.partition(",")[0]) == (0, "wrote ur5e_pick.bag.html")
    (tmp_path / "ur5e_pick.bag.html").write_text("<!doctype html>\nmy page", encoding="utf-8")
    assert run("view", "--bag", (rehearsed / "no_part.mcap").as_posix()).code == 2


def _wrong(folder: Path) -> dict[str, tuple[str, ...]]:
    """Return wrong calls, by what is said of them."""
    bag = arrived().write(folder / "bag").as_posix()
    return {
        "does not name its cell; name the generated folder as CELL": ("--bag", bag),
        "is no bag of fr3_hand: ": (generated("fr3_hand").as_posix(), "--bag", bag),
        "Missing argument 'CELL'": (),
        "--task needs --bag": (PICK, "--task", "no_part"),
        "--rehearsal takes no --bag beside it": (PICK, "--bag", bag, "--rehearsal", "no_part"),
        "the package has no rehearsal `nope`": (PICK, "--bag", bag, "--task", "nope"),
        "`nope` must be a bag, a file of records or a rehearsal": (PICK, "--bag", bag, "--against", "nope"),
        "no such file or folder; name a bag": (PICK, "--bag", "nope.mcap"),
    }


def test_what_cannot_be_played_is_told_in_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = _wrong(tmp_path)
    monkeypatch.chdir(tmp_path)
    for said, words in calls.items():
        ran = run("view", *words)
        assert ran.code == 2, said
        assert sum(said in line for line in ran.err.splitlines()) == 1, ran.err
    assert [path.name for path in tmp_path.iterdir()] == ["bag"]


def test_texts_of_a_bag_are_data(tmp_path: Path) -> None:
    bag = protective_stop()
    bag.messages = [each for each in bag.messages if each[1] != "/arm_io/safety_mode"]
    bag.says(701 * MS, "arm_trajectory", HOSTILE)
    plain = viewed(arrived().write(tmp_path / "plain"), tmp_path)[1]
    ran, page = viewed(bag.write(tmp_path / "hostile"), tmp_path)
    assert page.scripts[1:] == plain.scripts[1:]
    assert not [tag for tag, attributes in page.elements if tag == "img" and "onerror" in attributes]
    assert "alert(1)" in page.data["runs"][0]["reason"]
    assert not set("\x1b\r\u202e") & set(ran.out)
    assert not set("\x1b\r\u202e") & set("".join(page.shown))


def _drawn_by_a_browser(file: Path) -> tuple[list[str], Page]:
    graphics = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
    seen = ("--enable-logging=stderr", "--virtual-time-budget=2000", "--dump-dom")
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", *graphics, *seen, file.as_uri()],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    return [line for line in done.stderr.splitlines() if "CONSOLE" in line], Page(done.stdout)


@pytest.mark.skipif(shutil.which("chromium") is None, reason="no chromium on this machine")
def test_a_browser_shows_both_sides_at_the_begin(tmp_path: Path) -> None:
    other = turning(0.8, pan=0.2).write(tmp_path / "other").as_posix()
    viewed(turning(0.8).write(tmp_path / "bag"), tmp_path, "--against", other)
    console, page = _drawn_by_a_browser(tmp_path / "x.html")
    assert console == []
    assert "mm apart at " in page.text
    assert f"ghost: {other}" in page.text


def found_in(page: Page, name: str) -> list[dict[str, Any]]:
    """Return the attributes of the elements with a class."""
    return [attributes for _, attributes in page.elements if attributes.get("class") == name]


def test_every_step_has_a_button_that_shows_it(tmp_path: Path) -> None:
    _, page = viewed(arrived().write(tmp_path / "bag"), tmp_path)
    (button,) = found_in(page, "play")
    assert button["data-run"] == "0"
    assert float(button["data-at"]) == pytest.approx(0.1)
