"""Bags that are cut off, damaged or empty: what is readable is read, the rest is named, and nothing is a traceback."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin

from tests.attempt.hand_made import BEGIN_NS, MS, arrived, attempted, protective_stop
from tests.cells import generated
from tests.cli.run import run


def file_of(folder: Path) -> Path:
    """Return the file of a bag."""
    return next(each for each in folder.iterdir() if each.suffix in (".mcap", ".db3"))


@pytest.fixture(name="mocked", scope="module")
def mocked_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a bag of the mock: a grip that failed 4.4 s after the begin."""
    folder = tmp_path_factory.mktemp("mocked") / "evidence"
    ran = run("mock", generated("ur5e_pick").as_posix(), "--rehearsal", "no_part", "--evidence", folder.as_posix())
    assert ran.code == 0, ran.err
    return folder / "no_part.mcap"


@pytest.mark.parametrize("share", [0.35, 0.7, 0.95])
def test_a_cut_off_bag_of_the_mock_gives_the_steps_before_the_cut(mocked: Path, tmp_path: Path, share: float) -> None:
    whole = json.loads(attempted(mocked).out)
    cut = tmp_path / "no_part.mcap"
    data = mocked.read_bytes()
    cut.write_bytes(data[: int(len(data) * share)])
    ran = attempted(cut)
    report = json.loads(ran.out)
    assert (ran.code, report["outcome"]) == (1, "UNKNOWN")
    assert any("was cut off" in note for note in report["notes"])
    done = [each for each in report["attempts"][:-1] if each["outcome"] == "succeeded"]
    assert done
    for ours, theirs in zip(done[:-1], whole["attempts"], strict=False):
        assert ours == theirs
    assert report["end_ns"] < whole["end_ns"]


def test_the_mock_writes_in_the_order_of_time(mocked: Path) -> None:
    from mcap.reader import make_reader

    with mocked.open("rb") as file:
        times = [message.log_time for _, _, message in make_reader(file).iter_messages(log_time_order=False)]
    assert times == sorted(times)
    assert len(times) > 1000


def test_a_bag_of_another_package_is_refused_by_what_it_states(mocked: Path) -> None:
    ran = run("attempt", mocked.as_posix(), "--package", generated("minimal").as_posix())
    assert ran.code == 2
    assert "is no bag of this package: its cell must be minimal, got ur5e_pick" in ran.err


@pytest.mark.parametrize("plugin", StoragePlugin, ids=lambda plugin: str(plugin.name).lower())
def test_damaged_bytes_are_no_traceback(tmp_path: Path, plugin: StoragePlugin) -> None:
    file = file_of(protective_stop().write(tmp_path / "bag", plugin))
    data = file.read_bytes()
    chance = random.Random(7)
    for number in range(25):
        wrong = bytearray(data[: chance.randrange(len(data))] if number % 2 else data)
        for _ in range(chance.randrange(1, 60)):
            wrong[chance.randrange(len(wrong))] = chance.randrange(256)
        damaged = tmp_path / f"damaged{file.suffix}"
        damaged.write_bytes(wrong)
        ran = attempted(damaged, form="text")
        assert ran.code in (1, 2), ran.out + ran.err
        assert "bug of cellc" not in ran.err
        assert ran.out or ran.err.startswith("error: ")


def test_what_is_no_bag_is_named(tmp_path: Path) -> None:
    (tmp_path / "empty.mcap").write_bytes(b"")
    (tmp_path / "text.mcap").write_text("no bag", encoding="utf-8")
    (tmp_path / "text.db3").write_text("no bag", encoding="utf-8")
    (tmp_path / "folder").mkdir()
    (tmp_path / "bag.txt").write_text("no bag", encoding="utf-8")
    for name, said in (
        ("empty.mcap", "empty.mcap: cannot be read"),
        ("text.mcap", "text.mcap: cannot be read"),
        ("text.db3", "text.db3: cannot be read"),
        ("folder", "holds no file .mcap or .db3"),
        ("bag.txt", "must be a folder of rosbag2, or a file .mcap or .db3"),
        ("none.mcap", "no such file or folder"),
    ):
        ran = attempted(tmp_path / name)
        assert ran.code == 2
        assert said in ran.err


def test_a_message_of_wrong_length_is_counted_and_left_out(tmp_path: Path) -> None:
    bag = arrived()
    folder = bag.write(tmp_path / "bag", StoragePlugin.SQLITE3)
    import sqlite3

    with sqlite3.connect(file_of(folder)) as base:
        topic = base.execute("SELECT id FROM topics WHERE name = '/joint_states'").fetchone()[0]
        base.execute(
            "UPDATE messages SET data = x'00010000ff' WHERE topic_id = ? AND timestamp > ?",
            (topic, BEGIN_NS + 700 * MS),
        )
    report = json.loads(attempted(folder).out)
    assert report["outcome"] == "succeeded"
    assert "49 messages of `/joint_states` cannot be decoded" in report["notes"]
