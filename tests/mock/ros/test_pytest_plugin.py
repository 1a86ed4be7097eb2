"""The fixture `cellc_cell`, in sessions of pytest as the repository of a node has them, on a graph without ROS."""

from __future__ import annotations

from importlib.metadata import entry_points
from pathlib import Path

import pytest

from cellc.mock import MockCell
from cellc.mock.ros.asked import Timing
from cellc.tools.pytest_plugin import asked_with
from tests.mock.ros.task_stand_in import TaskGraph, stand_in

pytest_plugins = ["pytester"]

_PLUGIN = "cellc.tools.pytest_plugin"
_TESTS = r"""
import pytest

def test_it_activates_the_gripper(cellc_cell):
    cellc_cell.run("gripper_activated").expect()

def test_it_stops_where_the_camera_freezes(cellc_cell):
    cellc_cell.inject("freeze", "camera", step=3)
    cellc_cell.run("pick_and_place").expect("stale_state")

def test_words(cellc_cell):
    with pytest.raises(ValueError, match="fault `melt` cannot be injected: `kind`: "):
        cellc_cell.inject("melt", "camera", step=1)
    cellc_cell.inject("freeze", "camera", at_s=1000.0)  # is never reached
    ended = cellc_cell.run("gripper_activated")
    with pytest.raises(ValueError, match="`fine` is no outcome; outcomes are succeeded, "):
        ended.expect("fine")
    with pytest.raises(AssertionError, match=r"gripper_activated: succeeded .expected stale_state.*\n"):
        ended.expect("stale_state")
    with pytest.raises(AssertionError, match=r"\n *finding: .*freeze"):
        ended.expect()

def test_a_rehearsal(cellc_cell):
    cellc_cell.run("nothing")

def test_a_target(cellc_cell):
    cellc_cell.inject("freeze", "nobody", step=1)
    cellc_cell.run("pick_and_place")
"""


def _session(pytester: pytest.Pytester, tests: str, *more: str, **told: str) -> pytest.RunResult:
    """Run a session of pytest in the repository of a node."""
    options = "\n".join(f"cellc_{name} = {value}" for name, value in told.items())
    pytester.makeini(f"[pytest]\n{options}\n")
    pytester.makepyfile(tests)
    installed = any(each.value == _PLUGIN for each in entry_points(group="pytest11"))
    words = [] if installed else ["-p", _PLUGIN]
    return pytester.runpytest_inprocess(*words, "-p", "no:cacheprovider", "-p", "no:xdist", *more)


def _told(folder: Path) -> dict[str, str]:
    return {"folder": str(folder), "without": "task", "launch": "node {rehearsal}", "python": "python3"}


@pytest.fixture
def around(monkeypatch: pytest.MonkeyPatch, cell: MockCell) -> TaskGraph:
    """The graphs of all runs; what the node does wrong may be set."""
    latest = TaskGraph()

    def graph() -> TaskGraph:
        return TaskGraph(latest.wrong)

    stand_in(monkeypatch, cell, graph)
    return latest


def test_faults_are_calls_and_outcomes_assertions(
    pytester: pytest.Pytester, around: TaskGraph, built_folder: Path
) -> None:
    ended = _session(pytester, _TESTS, **_told(built_folder))
    ended.assert_outcomes(passed=3, failed=2)
    ended.stdout.fnmatch_lines(
        ["*has no rehearsal `nothing`*", "*fault `freeze` names `nobody`, which it cannot hit in this cell*"]
    )


def test_a_wrong_node_fails_with_what_it_did(pytester: pytest.Pytester, around: TaskGraph, built_folder: Path) -> None:
    around.wrong = "stale"
    ended = _session(pytester, _TESTS, "-k", "freezes", **_told(built_folder))
    ended.assert_outcomes(failed=1, deselected=4)
    ended.stdout.fnmatch_lines(
        [
            "*FAILED  pick_and_place: stale_state (expected stale_state)*",
            "*against the contract: not_stopped: `/task` let its goal of `/move_action` execute*",
        ]
    )


def test_a_folder_that_is_not_there_is_told(pytester: pytest.Pytester) -> None:
    ended = _session(pytester, _TESTS, "-k", "words", **_told(Path("nowhere")))
    ended.assert_outcomes(errors=1, deselected=4)
    ended.stdout.fnmatch_lines(["*nowhere*"])
    assert "Traceback" not in ended.stdout.str()


_CONFIGURED = {"folder": "x", "without": "task, perception", "launch": "", "python": "", "domain": ""} | {
    "pace": "",
    "patience": "",
}


def test_each_worker_has_a_domain_of_its_own() -> None:
    first, fourth = (asked_with(_CONFIGURED, worker) for worker in ("gw0", "gw3"))
    assert first.without == ("task", "perception")
    assert first.timing == Timing(None, 5.0)
    assert (first.domain, fourth.domain) == (100, 97)
    assert asked_with(_CONFIGURED | {"pace": "2", "domain": "7"}, "gw1").words()[3:7] == (
        "--pace",
        "2",
        "--domain",
        "6",
    )


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"without": ""}, "`cellc_without` must be set in the configuration of pytest: nodes under test"),
        ({"pace": "fast"}, "`cellc_pace` must be a number greater than 0, got `fast`"),
        ({"patience": "-1"}, "`cellc_patience` must be a number greater than 0, got `-1`"),
    ],
)
def test_a_wrong_configuration_is_told(changes: dict[str, str], text: str) -> None:
    with pytest.raises(pytest.fail.Exception, match=text):
        asked_with(_CONFIGURED | changes, "gw0")
