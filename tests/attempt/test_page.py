"""The page of an attempt: phases, plots and figures are those of the messages, whatever the length of the bag."""

from __future__ import annotations

import re
import tracemalloc
from html.parser import HTMLParser
from pathlib import Path

import pytest

from cellc.mock.folder import read_folder
from cellc.tools.attempt.read import Drawn, read_attempt
from cellc.tools.attempt.signals import Signals
from tests.attempt.hand_made import JOINTS, MS, HandMade, arrived, attempted, protective_stop
from tests.cells import generated
from tests.cli.run import run
from tests.view.page import unheard


class Page(HTMLParser):
    """Tags, and the text of captions and of everything."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.links: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.links += [value or "" for name, value in attrs if name in ("src", "href")]

    def handle_data(self, data: str) -> None:
        self.text += data + "\n"


def page(bag: Path) -> Page:
    ran = attempted(bag, form="html")
    assert ran.err == ""
    return Page(ran.out)


@pytest.mark.parametrize("form", ["html", "markdown"])
def test_times_have_units_and_no_more_digits_than_they_are_worth(form: str, tmp_path: Path) -> None:
    bag = protective_stop()
    bag.messages = [each for each in bag.messages if each[1] != "/arm_io/safety_mode"]
    shown = attempted(bag.write(tmp_path / "stop"), form=form).out
    shown = re.sub(r"<style>[\s\S]*?</style>|<svg[\s\S]*?</svg>|style=\"[^\"]*\"|title=\"[^\"]*\"", "", shown)
    assert re.findall(r"\d\.\d{5,}|(?<![-\w])\d{8,}(?![-\w])", shown) == []
    assert "12 ms" in shown
    assert form == "markdown" or "`" not in shown


def signals(bag: Path) -> Signals:
    folder = read_folder(generated("ur5e_pick"))
    report = read_attempt([bag], folder.contract, folder.rehearsals, folder.watches, None, Drawn((), {}))
    assert report.signals is not None
    return report.signals


def test_page_has_phases_plots_and_figures_of_the_messages(tmp_path: Path) -> None:
    shown = page(arrived().write(tmp_path / "good"))
    # The elbow leaves 1.5 rad and moves at 0.5 rad/s in 159 samples 2 ms apart.
    assert "state 1.5000 … 1.6590 rad" in shown.text
    assert "largest error" not in shown.text  # no state of the controller was recorded
    assert "joint states on /joint_states" in shown.text
    assert "oldest 2 ms" in shown.text
    for title in ("Phases", "Signals", "Key figures", "Topics of the cell that were not recorded"):
        assert title in shown.text
    assert {"svg", "path"} <= shown.tags


def test_the_page_is_self_contained_and_runs_nothing(tmp_path: Path) -> None:
    bag = protective_stop()
    bag.messages = [each for each in bag.messages if each[1] != "/arm_io/safety_mode"]
    bag.says(701 * MS, "arm_trajectory", "<script>alert(1)</script>\x1b[2J\u202e")
    ran = attempted(bag.write(tmp_path / "stop"), form="html")
    shown = Page(ran.out)
    assert ran.code == 1
    assert shown.tags.isdisjoint({"script", "img", "link", "iframe", "object"})
    assert shown.links == []
    assert not re.search(r"url\(|@import|https?://", ran.out)
    assert "<script>alert(1)" in shown.text
    for mark in ("\x1b", "\u202e"):
        assert mark not in ran.out


def test_command_state_error_and_scaling_are_those_of_the_controller(tmp_path: Path) -> None:
    bag = arrived()
    for at_ns in range(0, 800 * MS, 10 * MS):
        bag.follows(at_ns, 0.5, 0.5 - (0.03 if at_ns == 400 * MS else 0.01), 0.25)
    drawn = signals(bag.write(tmp_path / "follow"))
    assert {(each.joint, each.controller, each.unit) for each in drawn.joints} == {
        (joint, "arm_trajectory", "rad") for joint in JOINTS
    }
    assert [each.worst_error for each in drawn.joints] == pytest.approx([0.03] * 6)
    assert drawn.joints[0].desired.extremes == (0.5, 0.5)
    assert drawn.joints[0].actual.extremes == pytest.approx((0.47, 0.49))
    assert [each.state.extremes for each in drawn.scaling] == [(0.25, 0.25)]


def test_one_sample_of_a_long_bag_is_drawn_and_memory_does_not_grow(tmp_path: Path) -> None:
    peaks, folder = [], read_folder(generated("ur5e_pick"))
    for seconds in (5, 60):
        bag = HandMade()
        bag.begin_move()
        for at_ns in range(0, seconds * 1000 * MS, 2 * MS):
            spike = 2.0 if at_ns == 4002 * MS else 0.0
            bag.joints(at_ns, [spike, -1.5, 1.5, -1.5, -1.5, 0.0, 0.0])
        written = bag.write(tmp_path / f"long{seconds}")
        tracemalloc.start()
        report = read_attempt([written], folder.contract, folder.rehearsals, folder.watches, None, Drawn((), {}))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert report.signals is not None
        states = {each.joint: each.state for each in report.signals.states}
        assert states[JOINTS[0]].extremes == (0.0, 2.0)
        assert len(states[JOINTS[0]].starts_ns) <= 1024
    assert peaks[1] < 2 * peaks[0] + 10_000_000


def test_ages_rise_until_the_next_message_and_to_the_end_of_the_bag(tmp_path: Path) -> None:
    bag = HandMade()
    bag.begin_move()
    for at_ns in (0, 20 * MS, 40 * MS):
        bag.joints(at_ns, [0.0] * 7)
    arrived_ns, *message = bag.messages[-1]
    bag.messages[-1] = (arrived_ns + 30 * MS, *message)  # stamped at 40 ms
    bag.safety(240 * MS, 1)
    (ages,) = signals(bag.write(tmp_path / "ages")).ages
    assert ages.worst_s == pytest.approx(0.2)
    assert ages.max_age_s == 0.1
    assert float(ages.envelope.lowest[ages.envelope.starts_ns >= 70 * MS].min()) == pytest.approx(0.03)


def test_sliding_joints_are_lengths(tmp_path: Path) -> None:
    folder = tmp_path / "evidence"
    ran = run("mock", generated("rail_arm").as_posix(), "--evidence", folder.as_posix())
    assert ran.code == 0
    bag = sorted(folder.glob("*.mcap"))[0]
    shown = run("attempt", bag.as_posix(), "--package", generated("rail_arm").as_posix(), "--format", "html").out
    assert unheard(shown) == []
    assert re.search(r"state [−0-9.]+ … [−0-9.]+ m<", shown)
    assert re.search(r"state [−0-9.]+ … [−0-9.]+ rad<", shown)
