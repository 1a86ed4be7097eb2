"""Logs of real programs: what their sources write, in their forms, found in the order of time over all files.

Lines are those of rcutils (`[LEVEL] [TIME] [name]: text`), of launch (`TIME [LEVEL] [name]: text`), of journalctl, and
sentences that the real ros2_control answered, in tests/oracles, or that public issues have.
"""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract.attempt import Layer
from cellc.contract.limits import in_force, limits
from cellc.tools.diagnose.log_entry import Gravity, entry_of
from cellc.tools.diagnose.logs import Searched, search
from cellc.tools.diagnose.symptoms import knowledge
from tests.cells import ROOT
from tests.cli.run import run
from tests.foreign_yaml import safe_load

T0 = 1_795_859_474
"""28 November 2026, 09:51:14 UTC, by `date -u -d @1795859474`."""
DIED = (
    "[ERROR] [controller_stopper_node-3]: process has died [pid 63445, exit code -11, cmd "
    "'/opt/ros/humble/lib/ur_robot_driver/controller_stopper_node --ros-args -r __node:=controller_stopper']."
)
"""Universal_Robots_ROS2_Driver issue 502."""
NO_REPLY = "[UR_Client_Library]: Failed to establish connection for 192.168.56.101:30001 after 5 tries"
FIFO = "[controller_manager]: Could not enable FIFO RT scheduling policy"


def logs(folder: Path, **files: str) -> Path:
    """Write files named after their keywords, with a line break at the end of each."""
    folder.mkdir(exist_ok=True)
    for name, text in files.items():
        (folder / f"{name}.log").write_text(text + "\n", encoding="utf-8")
    return folder


def told(searched: Searched) -> list[tuple[str, str]]:
    """Return layer and file of what was found, in order."""
    return [(str(each.layer), each.file) for each in searched.spoken]


def test_first_layer_is_that_of_the_first_error_over_all_files(tmp_path: Path) -> None:
    folder = logs(
        tmp_path / "log",
        launch=f"{T0}.5000000 [INFO] [launch]: All log files can be found below /root\n{T0 + 30}.2500000 {DIED}",
        ros2_control_node_27_1795859475573=(
            f"[INFO] [{T0}.100000000] [controller_manager]: starting\n"
            f"[WARN] [{T0 + 1}.100000000] {FIFO}\n"
            f"[ERROR] [{T0 + 9}.100000000] {NO_REPLY}"
        ),
        task=f"[ERROR] [{T0 + 12}.000000001] [task]: goal was rejected by server",
    )
    searched = search(folder)
    assert told(searched) == [
        ("missed cycle", "ros2_control_node_27_1795859475573.log"),
        ("connection", "ros2_control_node_27_1795859475573.log"),
        ("rejected goal", "task.log"),
        ("nodes", "launch.log"),
    ]
    assert searched.first is not None
    assert (searched.first.layer, searched.first.line) == (Layer.CONNECTION, 3)
    assert searched.first.at_ns == (T0 + 9) * 10**9 + 100_000_000


def test_warnings_name_the_layer_where_nothing_is_graver(tmp_path: Path) -> None:
    searched = search(logs(tmp_path / "log", a=f"[WARN] [{T0}.1] {FIFO}"))
    assert searched.first is not None
    assert searched.first.layer is Layer.CYCLE


def test_what_every_start_says_is_no_failure(tmp_path: Path) -> None:
    waiting = "[spawner_arm]: waiting for service /controller_manager/list_controllers to become available..."
    folder = logs(tmp_path / "log", launch=f"{T0}.1 [spawner-2] [INFO] [{T0}.09] {waiting}")
    assert search(folder).spoken == ()
    ran = run("diagnose", "--log", folder.as_posix())
    first, _, nevertheless, *_ = ran.out.splitlines()
    assert (ran.code, first) == (0, "no known symptom in 1 line of 1 file")
    assert nevertheless.startswith("if something is wrong nevertheless: ")


@pytest.mark.parametrize("case", ["too_fast_default_tolerance", "times_duplicate", "query_state_inactive"])
def test_answers_of_the_real_controller_are_found_in_a_log(tmp_path: Path, case: str) -> None:
    answered = safe_load((ROOT / f"tests/oracles/joint_trajectory/cases/{case}.yaml").read_text(encoding="utf-8"))
    said = answered["observed"]["log"]
    lines = [line.replace("] [", f"] [{T0 + at}.000000000] [", 1) for at, line in enumerate(said)]
    first = search(logs(tmp_path / "log", node="\n".join(lines))).first
    assert first is not None
    assert str(first.layer) == ("tolerance" if case.startswith("too_fast") else "rejected goal")


def test_journals_are_read_in_both_forms_and_their_zone_by_a_line_that_has_both_times(tmp_path: Path) -> None:
    folder = logs(
        tmp_path / "log",
        # The host is an hour ahead of UTC: 10:51:14 is 09:51:14.
        short=(
            f"Nov 28 10:51:14 bench ros2[1]: [INFO] [{T0}.500000000] [task]: ready\n"
            "Nov 28 10:51:20 bench ros2[1]: RTPS_TRANSPORT_SHM Error"
        ),
        json=json.dumps({"__REALTIME_TIMESTAMP": f"{T0 + 3}000000", "PRIORITY": "3", "MESSAGE": "Connection refused"}),
        octets=json.dumps(
            {"__REALTIME_TIMESTAMP": f"{T0 + 9}000000", "PRIORITY": "6", "MESSAGE": list(b"\xffSegmentation fault")}
        ),
    )
    searched = search(folder)
    assert [(each.file, each.at_ns) for each in searched.spoken] == [
        ("json.log", (T0 + 3) * 10**9),
        ("short.log", (T0 + 6) * 10**9),
        ("octets.log", (T0 + 9) * 10**9),
    ]
    assert searched.notes == ()


def test_times_without_a_zone_are_named(tmp_path: Path) -> None:
    folder = logs(
        tmp_path / "log",
        dds="2026-11-28 09:51:16.047 [RTPS_TRANSPORT_SHM Error] Failed init_port fastrtps_port12421",
        iso="2026-11-28T11:51:15+0200 bench kernel: Segmentation fault",
        bare="Segmentation fault",
    )
    searched = search(folder)
    assert [(each.file, each.at_ns) for each in searched.spoken] == [
        ("iso.log", (T0 + 1) * 10**9),
        ("dds.log", (T0 + 2) * 10**9 + 47_000_000),
    ]
    assert searched.spoken[0].count == 2
    assert [note.partition(":")[0] for note in searched.notes] == ["dds.log"]
    assert "state no zone" in searched.notes[0]


@pytest.mark.parametrize(
    ("line", "ns", "gravity"),
    [
        ("[ERROR] [1795859474.123456789] [a]: x", T0 * 10**9 + 123_456_789, Gravity.ERROR),
        ("\x1b[33m[WARN] [1795859474.5] [a]: x\x1b[0m", T0 * 10**9 + 500_000_000, Gravity.WARNING),
        ("1795859474.1234567 [FATAL] [a]: x", T0 * 10**9 + 123_456_700, Gravity.ERROR),
        ("1795859474.1 [a-1] terminate called", T0 * 10**9 + 100_000_000, Gravity.UNSAID),
        ("[1795859474123456789] [INFO] x", T0 * 10**9 + 123_456_789, Gravity.MINOR),
        ("[2026-11-28 09:51:14.047] [libfranka] [error] x", T0 * 10**9 + 47_000_000, Gravity.ERROR),
        ("2026-11-28T09:51:14Z host a: x", T0 * 10**9, Gravity.UNSAID),
        ("2026-13-45 09:51:14 x", None, Gravity.UNSAID),
        ('{"__REALTIME_TIMESTAMP": 5, "MESSAGE": "x"}', None, Gravity.UNSAID),
        ("x", None, Gravity.UNSAID),
    ],
)
def test_time_and_gravity_of_a_line(line: str, ns: int | None, gravity: Gravity) -> None:
    entry = entry_of(line)
    assert (None if entry.stamp is None else entry.stamp.ns, entry.gravity) == (ns, gravity)


def test_hostile_files_are_named_and_bounded(tmp_path: Path) -> None:
    folder = logs(
        tmp_path / "log", good=f"[ERROR] [{T0}.1] [task]: Connection refused \x1b]0;owned\x07\u202e\r::error::x"
    )
    (folder / "binary.log").write_bytes(b"\x7fELF\0\0" + bytes(1000))
    os.mkfifo(folder / "pipe.log")
    (folder / "latest").symlink_to(folder, target_is_directory=True)
    (folder / "link.log").symlink_to("/dev/zero")
    (folder / "long.log").write_bytes(b"x" * 5_000_000 + b"\nSegmentation fault\n")
    with in_force(replace(limits(), log_bytes=5_000_000)):
        searched = search(folder)
    assert told(searched) == [("connection", "good.log")]
    assert searched.notes[0] == "binary.log: is binary, and not read"
    assert searched.notes[1].startswith("long.log: only the first 4999")
    assert searched.notes[2] == "pipe.log: is not read: `--limit log-bytes=N` raises it"
    ran = run("diagnose", "--log", folder.as_posix())
    assert ran.code == 1
    for mark in ("\x1b", "\x07", "\u202e", "\r"):
        assert mark not in ran.out
    assert "pipe.log: cannot be read: not a regular file" in ran.out


def test_a_file_of_ten_gigabytes_is_read_up_to_the_limit(tmp_path: Path) -> None:
    place = tmp_path / "huge.log"
    place.write_text(f"[ERROR] [{T0}.1] [task]: Connection refused\n" * 1000, encoding="utf-8")
    os.truncate(place, 10 * 2**30)  # the rest is a hole
    with in_force(replace(limits(), log_bytes=1_000_000)):
        searched = search(place)
    assert searched.spoken[0].count == 1000
    assert searched.notes == (
        f"{place.as_posix()}: only the first 1000000 of its 10737418240 bytes are read; "
        "`--limit log-bytes=N` raises it",
    )


def test_what_is_no_log_and_words_beside_a_log_are_usage_errors(tmp_path: Path) -> None:
    for words, said in (
        (("--log", (tmp_path / "none").as_posix()), "no such file or folder"),
        (("--log", tmp_path.as_posix()), "holds no log that can be read"),
        (("--log", tmp_path.as_posix(), "arm", "sags"), "--log takes no symptom beside it, got `arm sags`"),
    ):
        ran = run("diagnose", *words)
        assert (ran.code, said in ran.err) == (2, True), ran.err


def test_names_of_a_cell_are_in_the_steps(tmp_path: Path) -> None:
    folder = logs(tmp_path / "log", a=f"[ERROR] [{T0}.1] [task]: goal was rejected by server")
    ran = run("diagnose", "--log", folder.as_posix(), (ROOT / "cells/ur5e_pick/cell.yaml").as_posix())
    assert ran.code == 1
    assert "/arm_trajectory/follow_joint_trajectory" in ran.out


def test_every_text_of_a_source_shows_a_layer() -> None:
    shown = [symptom.shown_by(text) for layer in knowledge() for symptom in layer.symptoms for text in symptom.logged]
    assert len(shown) > 300
    assert None not in shown
    assert Layer.NONE not in shown


def test_error_that_no_symptom_has_is_told_and_classified_by_its_words(tmp_path: Path) -> None:
    folder = logs(
        tmp_path / "log",
        a=f"[ERROR] [{T0 + 5}.1] [task]: late\n[WARN] [{T0}.1] [task]: odd",
        b=f"[INFO] [{T0}.1] [x]: fine\n[ERROR] [{T0 + 2}.5] [arm_driver]: overload of motor 3, torque is off",
    )
    unread = search(folder).unread
    assert unread is not None
    assert (unread.file, unread.line, unread.count) == ("b.log", 2, 2)
    assert unread.at_ns == (T0 + 2) * 10**9 + 500_000_000
    ran = run("diagnose", "--log", folder.as_posix())
    assert ran.code == 1
    assert "2 errors that no symptom has; the first:\n" in ran.out
    assert "vendor mode: a motor reports overload or goes limp\n" in ran.out


def test_known_error_names_the_layer_and_an_unknown_one_is_only_counted(tmp_path: Path) -> None:
    folder = logs(tmp_path / "log", a=f"[ERROR] [{T0}.1] [task]: octopus\n[ERROR] [{T0 + 9}.1] {NO_REPLY}")
    ran = run("diagnose", "--log", folder.as_posix())
    assert ran.code == 1
    assert ran.out.startswith("first layer, not sure: connection")
    assert "1 error that no symptom has; the first:\n  2026-11-28 09:51:14" in ran.out
    assert "UNKNOWN" not in ran.out
