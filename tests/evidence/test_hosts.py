"""A cell on two computers: each observes, and a line passes only where it passes on every host responsible for it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.emit.launch.observe_checks import Seen
from cellc.contract.observation import ObservedTarget
from cellc.tools.evidence.join import responsible
from tests.cells import built
from tests.cli.run import run
from tests.evidence.attempts import observe, package, ticked

_HOSTS = ("control_pc", "planner_pc")
_TRAJECTORY = "/arm_trajectory/follow_joint_trajectory"


def _ends(name: str, side: int) -> Callable[[Seen], object]:
    """Return what takes one end of an interface away."""

    def gone(seen: Seen) -> None:
        sides = [*seen.ends[name]]
        sides[side] = sides[side][1:]
        seen.ends[name] = (sides[0], sides[1])

    return gone


def _right(seen: Seen) -> None:
    """Leave the graph as it is."""


def _observed(folder: Path, *, control: Callable[[Seen], object] = _right, planner: Any = _right) -> dict[str, Any]:
    """Return gate G3 of what both hosts observed; a host that is None did not."""
    for host, wrong in zip(_HOSTS, (control, planner), strict=True):
        if wrong is not None:
            (folder / host).mkdir()
            observe(folder / host, "fr3_hand", "G3", host=host, wrong=wrong)
    (folder / "G3-freshness.md").write_text("done\n", encoding="utf-8")
    ticked(folder, "fr3_hand")
    words = ("--package", package("fr3_hand").as_posix(), "--gate", "G3", "--format", "json")
    ran = run("evidence", folder.as_posix(), *words)
    report = json.loads(ran.out)
    assert (ran.code == 0) == report["complete"]
    gate: dict[str, Any] = report["gates"][0]
    return gate


def test_two_reports_that_pass_are_complete_together(tmp_path: Path) -> None:
    gate = _observed(tmp_path)
    assert gate["status"] == "complete"
    assert [(piece["host"], piece["status"]) for piece in gate["files"]] == [
        (None, "to be read"),
        ("control_pc", "PASSED"),
        ("planner_pc", "PASSED"),
    ]


def test_a_host_that_did_not_observe_is_missing(tmp_path: Path) -> None:
    gate = _observed(tmp_path, planner=None)
    assert (gate["status"], gate["missing"]) == ("UNKNOWN", ["observe-G3-*.json of planner_pc"])
    assert gate["findings"] == []


def test_what_fails_at_its_own_host_fails_though_the_other_sees_it_pass(tmp_path: Path) -> None:
    gate = _observed(tmp_path, control=_ends(_TRAJECTORY, 0))  # the controller runs on control_pc
    assert gate["status"] == "FAILED"
    (finding,) = gate["findings"]
    assert finding["status"] == "FAILED"
    assert finding["text"].startswith(f"{_TRAJECTORY}, server: contradicted, control_pc says FAILED, ")
    assert "/arm_trajectory is missing" in finding["text"]
    assert "planner_pc says PASSED, " in finding["text"]
    assert [piece["status"] for piece in gate["files"]] == ["to be read", "FAILED", "PASSED"]


def test_what_fails_at_the_other_host_alone_is_a_contradiction_and_not_known(tmp_path: Path) -> None:
    gate = _observed(tmp_path, planner=_ends(_TRAJECTORY, 0))
    assert gate["status"] == "UNKNOWN"
    (finding,) = gate["findings"]
    assert finding["status"] == "UNKNOWN"
    assert "contradicted, control_pc says PASSED, " in finding["text"]
    assert "planner_pc says FAILED, /arm_trajectory is missing" in finding["text"]


def test_what_fails_on_both_is_no_contradiction(tmp_path: Path) -> None:
    gate = _observed(tmp_path, control=_ends(_TRAJECTORY, 0), planner=_ends(_TRAJECTORY, 0))
    assert gate["status"] == "FAILED"
    assert "contradicted" not in json.dumps(gate)


def test_a_host_that_is_none_of_the_cell_is_refused(tmp_path: Path) -> None:
    _observed(tmp_path)
    place = tmp_path / "planner_pc/observe-G3-20261128T101500Z.json"
    record = json.loads(place.read_text(encoding="utf-8"))
    place.write_text(json.dumps({**record, "host": "laptop"}), encoding="utf-8")
    ran = run("evidence", tmp_path.as_posix(), "--package", package("fr3_hand").as_posix(), "--format", "json")
    assert json.loads(ran.out)["refused"] == [
        {
            "path": "planner_pc/observe-G3-20261128T101500Z.json",
            "why": "is of host `laptop`, expected control_pc or planner_pc",
        }
    ]


@pytest.mark.parametrize(
    ("part", "subject", "hosts"),
    [
        ("graph", f"{_TRAJECTORY}, server", ("control_pc",)),  # a controller; ../shared: it runs in its manager
        ("graph", f"{_TRAJECTORY}, clients", ("planner_pc",)),  # move_group
        ("graph", "/tf_static, QoS", _HOSTS),
        ("flow", "/joint_states", _HOSTS),  # robot_state_publisher, and move_group
        ("control", "/controller_manager, hardware", ("control_pc",)),
        ("parameters", "/move_group", ("planner_pc",)),
        ("graph", "node names", _HOSTS),
        ("tf", "frames of the description", _HOSTS),
        ("flow", "motion", _HOSTS),
    ],
)
def test_hosts_are_responsible_for_their_own_ends(part: str, subject: str, hosts: tuple[str, ...]) -> None:
    plan = ObservedTarget.model_validate(json.loads(built("fr3_hand").texts["config/observe.json"])["real"])
    assert responsible(part, subject, plan, _HOSTS) == hosts


@pytest.mark.parametrize(("part", "hosts"), [("flow", ("planner_pc",)), ("graph", _HOSTS)])
def test_what_arrives_is_judged_where_it_is_taken(part: str, hosts: tuple[str, ...]) -> None:
    ends = {"/poses": {"sources": {"/camera": ""}, "sinks": {"/task": ""}}}
    homes = {"control_pc": ["/camera"], "planner_pc": ["/task"]}
    stated = {"nodes": ["/camera", "/task"], "hosts": homes, "inside": {}, "ends": ends, "states": {}}
    plan = ObservedTarget.model_validate({**stated, "lifecycle": {}, "lifecycle_claimed": {}, "late_joints": []})
    assert responsible(part, "/poses" if part == "flow" else "/poses, QoS", plan, _HOSTS) == hosts
