"""`cellc mock --live`: who connects as Foxglove does sees what the bag has, and can change nothing."""

from __future__ import annotations

import re
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from mcap.reader import make_reader

from cellc.contract.extras import MissingExtraError
from cellc.contract.printing import Stream
from cellc.contract.signals import Stopped
from cellc.mock import MockCell
from cellc.mock.command.options import Live, RehearsalOptions
from cellc.mock.command.rehearsals import run_rehearsals
from cellc.mock.errors import MockError
from cellc.mock.evidence.images.photographer import Photographer
from tests.mock.conftest import Written
from tests.mock.live.viewer import Viewer

pytest.importorskip("foxglove")

if TYPE_CHECKING:
    from cellc.mock.command.live import LiveView

LOG = "/cellc/log"


class Watched:
    """A view on a free port, with who connects as soon as it says where it listens."""

    def __init__(self, view: LiveView) -> None:
        self.view = view
        self.viewers: list[Viewer] = []
        self.port = 0

    def connect(self, *topics: str) -> Viewer:
        """Connect one more."""
        self.viewers.append(Viewer(self.port, topics))
        return self.viewers[-1]

    def hear(self, line: str, to: Stream) -> None:
        """Take a line that the user is told."""
        found = re.fullmatch(r"live at ws://127\.0\.0\.1:(\d+): it begins when Foxglove opens that", line)
        assert found is not None
        assert to is Stream.ERR
        self.port = int(found[1])
        self.connect()


@contextmanager
def _watched(monkeypatch: pytest.MonkeyPatch, speed: float) -> Iterator[Watched]:
    from cellc.mock.command import live

    with live.live_view("127.0.0.1:0", speed) as view:
        watched = Watched(view)
        monkeypatch.setattr(live, "show", watched.hear)
        yield watched
    for viewer in watched.viewers:
        viewer.end()


def test_who_watches_receives_the_bag_message_by_message_and_is_offered_nothing_else(
    cell: MockCell, written: Written, monkeypatch: pytest.MonkeyPatch
) -> None:
    with _watched(monkeypatch, 1000.0) as watched:
        assert watched.view.run(cell, "stale_camera", 0) == written.results["stale_camera"]
    (viewer,) = watched.viewers
    expected: dict[str, list[tuple[int, bytes]]] = {}
    with written.bag("stale_camera").open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            assert schema is not None
            expected.setdefault(channel.topic, []).append((message.log_time, message.data))
            advertised = viewer.channels[channel.topic]
            assert (advertised["encoding"], advertised["schemaName"]) == ("cdr", schema.name)
            assert advertised["schema"].encode() == schema.data
    log = viewer.received.pop(LOG)
    images = [topic for topic in viewer.received if topic.startswith("/camera/")]  # drawn as they are shown
    assert {"/camera/color/image_raw", "/camera/depth/camera_info"} <= set(images)
    assert {topic: got for topic, got in viewer.received.items() if topic not in images} == expected
    assert viewer.server["capabilities"] == []
    words = [data.decode("utf-8", "replace") for _, data in log]
    # The camera freezes 2 s after the start, which the bring-up puts at 0.55 s; 200 ms later its data is too old.
    (fault,) = [stamp_ns for (stamp_ns, _), said in zip(log, words, strict=True) if "fault: freeze of camera" in said]
    assert fault == 2_550_000_000
    assert "end: stale_state" in words[-1]
    assert log[-1][0] == fault + 200_000_000


def test_who_comes_late_receives_what_is_latched_and_each_rehearsal_is_a_session(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    with _watched(monkeypatch, 1000.0) as watched:
        watched.view.run(cell, "canceled", 0)
        watched.view.run(cell, "canceled", 0)
        late = watched.connect("/robot_description", "/tf_static", "/tf")
    assert watched.viewers[0].sessions == 2
    assert {topic: len(messages) for topic, messages in late.received.items()} == {
        "/robot_description": 1,
        "/tf_static": 1,
    }


def test_images_are_drawn_for_who_looks_at_them_alone(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[str] = []
    monkeypatch.setattr(Photographer, "message", lambda _, topic, shot: drawn.append(f"{topic} {shot}"))
    with _watched(monkeypatch, 1000.0) as watched:
        monkeypatch.setattr(Watched, "connect", lambda self: self.viewers.append(Viewer(self.port, ("/tf",))))
        watched.view.run(cell, "canceled", 0)
    assert not drawn


def test_a_run_is_shown_in_the_time_that_it_took_divided_by_the_speed(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cellc.mock.command import live

    now = 0.0

    def pass_by(seconds: float) -> None:
        nonlocal now
        now += 0.0 if seconds == live._QUIET_S else seconds

    monkeypatch.setattr(live, "monotonic", lambda: now)
    monkeypatch.setattr(live, "sleep", pass_by)
    with _watched(monkeypatch, 4.0) as watched:
        result = watched.view.run(cell, "stale_camera", 0)
        shown_s = now
    # What is shown begins with the bring-up, at 0, and ends with the last attempt.
    assert shown_s == pytest.approx(result.attempts[-1].ended_ns / 1e9 / 4.0)


def test_server_stays_until_ctrl_c_and_waiting_is_no_time_of_execution(
    built_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """An hour passes until somebody connects; who still watches at the end keeps the picture until Ctrl-C."""
    from cellc.mock.command import live

    now, asleep, viewers = 0.0, 0, list[Viewer]()

    def pass_by(seconds: float) -> None:
        nonlocal now, asleep
        now += max(seconds, 0.0)
        asleep += seconds == live._LAST_S
        if asleep == 3:
            assert viewers[0].server["capabilities"] == []
            raise Stopped(signal.SIGINT)

    def connect(line: str, to: Stream) -> None:
        nonlocal now
        found = re.search(r":(\d+):", line)
        if found is not None:
            now += 3600.0
            viewers.append(Viewer(int(found[1]), ()))

    monkeypatch.setattr(live, "sleep", pass_by)
    monkeypatch.setattr(live, "monotonic", lambda: now)
    monkeypatch.setattr(live, "perf_counter", lambda: now)
    monkeypatch.setattr("cellc.mock.command.rehearsals.perf_counter", lambda: now)
    monkeypatch.setattr(live, "show", connect)
    options = RehearsalOptions(str(built_folder), rehearsals=("canceled",), live=Live("127.0.0.1:0", 1000.0))
    assert run_rehearsals(options) == 0
    assert asleep >= 3
    assert "simulated in 0.00 s" in capsys.readouterr().out
    viewers[0].end()


@pytest.mark.parametrize("address", ["8765", "127.0.0.1:", "127.0.0.1:99999", ":8765", "127.0.0.1:x"])
def test_address_that_is_none_is_told(address: str) -> None:
    from cellc.mock.command.live import live_view

    with pytest.raises(MockError, match="`--listen` must be HOST:PORT, got"), live_view(address, 1.0):
        pass


def test_missing_sdk_is_told_with_what_to_install(built_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "cellc.mock.command.live", raising=False)
    monkeypatch.setitem(sys.modules, "foxglove", None)
    told = re.escape("-m pip install 'foxglove-sdk>=0.30' 'mcap>=1.1'`")
    with pytest.raises(MissingExtraError, match=told):
        run_rehearsals(RehearsalOptions(str(built_folder), rehearsals=("canceled",), live=Live("127.0.0.1:0", 1.0)))
