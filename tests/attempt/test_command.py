"""``cellc attempt`` by the command line: forms of output, files, exit codes, usage."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tracemalloc
from pathlib import Path

import pytest

from cellc.mock.folder import read_folder
from cellc.tools.attempt.read import read_attempt
from tests.attempt.hand_made import MS, SUCCEEDED, HandMade, arrived, moving, protective_stop
from tests.cells import generated
from tests.cli.run import run

PACKAGE = ("--package", generated("ur5e_pick").as_posix())


@pytest.fixture(name="bag", scope="module")
def bag_fixture(tmp_path_factory: pytest.TempPathFactory) -> str:
    return arrived().write(tmp_path_factory.mktemp("bags") / "good").as_posix()


def test_text_names_outcome_steps_and_figures(bag: str) -> None:
    ran = run("attempt", bag, *PACKAGE)
    assert ran.code == 0
    lines = ran.out.splitlines()
    assert lines[1] == "outcome  succeeded"
    assert "    steps 3 at 0.150, 4 at 0.150, 5 at 0.150, 6 at 0.152, 7 at 0.162, 8 at 0.500" in lines
    assert "plan to execute  12 ms, target 500 ms" in lines


def test_every_field_of_the_contract_is_on_the_page_and_in_the_record(bag: str) -> None:
    fields = json.loads((generated("ur5e_pick") / "contract.json").read_text(encoding="utf-8"))["attempt_fields"]
    record = json.loads(run("attempt", bag, *PACKAGE, "--format", "json").out)["attempts"][0]
    page = run("attempt", bag, *PACKAGE, "--format", "markdown").out
    assert len(fields) >= 15
    for name in fields:
        for part in re.split(r" or |/", name):
            assert part.strip() in record or part.strip() in page, name


def test_files_are_written_and_those_of_others_are_left(bag: str, tmp_path: Path) -> None:
    output = tmp_path / "attempts"
    for _ in range(2):
        assert run("attempt", bag, *PACKAGE, "-o", output.as_posix()).code == 0
    assert sorted(each.name for each in output.iterdir()) == [
        "good.attempt.html",
        "good.attempt.json",
        "good.attempt.md",
    ]
    written = (output / "good.attempt.json").read_text(encoding="utf-8")
    assert written == run("attempt", bag, *PACKAGE, "--format", "json").out
    for suffix, notes in (("md", "my notes"), ("html", "<!doctype html>\nmy page"), ("json", '{\n  "format": 1}')):
        place = output / f"good.attempt.{suffix}"
        own = place.read_bytes()
        place.write_text(notes, encoding="utf-8")
        ran = run("attempt", bag, *PACKAGE, "-o", output.as_posix())
        assert (ran.code, "is no file of this command" in ran.err) == (2, True)
        assert place.read_text(encoding="utf-8") == notes
        place.write_bytes(own)


def test_a_failed_attempt_is_exit_code_1_and_wrong_words_are_2(bag: str, tmp_path: Path) -> None:
    stop = protective_stop().write(tmp_path / "stop").as_posix()
    assert run("attempt", stop, *PACKAGE).code == 1
    assert run("attempt", bag, "--package", (tmp_path / "none").as_posix()).code == 2
    wrong = run("attempt", bag, *PACKAGE, "--task", "nothing")
    assert wrong.code == 2
    assert "the package has no rehearsal `nothing`; it has `pick_and_place`" in wrong.err
    without = run("attempt", bag)
    assert (without.code, "does not name its cell; name the generated folder with --package" in without.err) == (
        2,
        True,
    )
    assert run("attempt").code == 2


def test_help_has_examples() -> None:
    assert "cellc attempt bags/1 --package generated/bench --task pick" in run("attempt", "--help").out


def test_other_commands_import_no_reader_of_bags() -> None:
    code = (
        "import sys; from cellc.tools.cli.main import run; run(['attempt', '--help']); print('rosbags' in sys.modules)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "False"


def _long(seconds: int, tmp_path: Path) -> Path:
    """Return a bag of a move that takes so long, with a joint state each 2 ms."""
    bag, end_ms = HandMade(), seconds * 1000
    for _ in moving(bag, end_ms * MS, lambda at_ns: 0.0005):
        pass
    bag.begin_move()
    bag.end_move((end_ms - 10) * MS, SUCCEEDED)
    return bag.write(tmp_path / f"long{seconds}")


def test_memory_does_not_grow_with_the_length_of_a_bag(tmp_path: Path) -> None:
    folder = read_folder(generated("ur5e_pick"))
    peaks = []
    for seconds in (5, 60):
        bag = _long(seconds, tmp_path)
        tracemalloc.start()
        report = read_attempt([bag], folder.contract, folder.rehearsals, folder.watches, None)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert report.messages == seconds * 500 + 5
    assert peaks[1] < 2 * peaks[0] + 10_000_000
