"""Rehearsals around a perception node that is not played: a right one changes nothing, a wrong one is named."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, RehearsalEntry
from cellc.contract.transforms import Pose
from cellc.mock import MockCell
from cellc.mock.campaign.campaign import execute
from cellc.mock.campaign.plan import CampaignRun
from cellc.mock.campaign.summary import failure_lines
from cellc.mock.cell import Watch, cell_of
from cellc.mock.errors import MockError
from cellc.mock.evidence.bag import messages
from cellc.mock.result import RehearsalResult
from cellc.mock.ros import session
from cellc.mock.ros.asked import AmongNodes, Timing
from cellc.mock.ros.bridge import GraphEnd
from cellc.mock.ros.session import concerns, rehearse_among
from tests.cells import ROOT
from tests.cli.run import run as command
from tests.mock.ros.stand_in import CAMERA, IMAGES, POSES, Graph, Node, Said, changed, right, run

_AT = Pose((0.1, 0.0, 0.4), (0.0, 0.0, 0.0, 1.0))


@pytest.mark.parametrize("name", ["pick_and_place", "stale_camera", "canceled", "gripper_activated"])
def test_a_right_node_ends_every_rehearsal_as_the_played_one(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    judged = run(cell, monkeypatch, Graph(right), name)
    played = cell.run(name)
    assert judged.result.violations == ()
    assert judged.result.passed
    assert judged.result.outcome == played.outcome
    assert [each.step for each in judged.result.attempts] == [each.step for each in played.attempts]


def test_two_runs_have_the_same_records(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    first = run(cell, monkeypatch, Graph(right)).result
    assert run(cell, monkeypatch, Graph(right)).result == first


def _poses(graph: Graph, stamp_ns: int, said: Sequence[Said], frame: str = CAMERA, pose: Pose = _AT) -> Sequence[Said]:
    return [(POSES, messages.pose_stamped(stamp_ns, frame, pose))] if said else []


_WRONG: dict[str, tuple[Node, str]] = {
    "stamp on arrival": (
        changed(lambda graph, _, said: _poses(graph, graph.clock_ns, said)),
        "stamp_of_another_time: `/object_pose` is stamped 13.000 ms after the newest image",
    ),
    "another frame": (
        changed(lambda graph, stamp, said: _poses(graph, stamp, said, frame="world")),
        "wrong_frame: `/object_pose` is in frame `world`, the contract has it in `camera_color_optical_frame`",
    ),
    "not a number": (
        changed(lambda graph, stamp, said: _poses(graph, stamp, said, pose=replace(_AT, position=(float("nan"),) * 3))),
        "invalid_pose: `/object_pose` has position (nan, nan, nan)",
    ),
    "no quaternion": (
        changed(lambda graph, stamp, said: _poses(graph, stamp, said, pose=replace(_AT, quaternion=(0.0,) * 4))),
        "invalid_pose: `/object_pose` has position (0.1, 0.0, 0.4) and quaternion (0.0, 0.0, 0.0, 0.0)",
    ),
    "old images are used": (
        changed(lambda *all_of: all_of[2], max_age_ns=10**12),
        "stale_input_used: `/object_pose` was seen in an image that was 1 s older than is allowed",
    ),
    "silence": (lambda *_: (), "too_slow: no pose from `perception` for 0.233 s of images, 10 Hz are stated"),
    "cut short": (
        changed(lambda _, stamp, said: [(POSES, said[0][1][:60])] if said else []),
        "malformed_message: `perception` sent a message that is too short",
    ),
}


@pytest.mark.parametrize("wrong", _WRONG)
def test_a_wrong_node_is_named(cell: MockCell, monkeypatch: pytest.MonkeyPatch, wrong: str) -> None:
    node, text = _WRONG[wrong]
    monkeypatch.setattr("cellc.mock.ros.perception._GRACE_S", 0.0)
    result = run(cell, monkeypatch, Graph(node)).result
    assert not result.passed
    assert any(line.startswith(text) for line in result.violations), result.violations


def test_every_image_is_answered_though_the_contract_asks_for_fewer(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph = Graph(right)
    run(cell, monkeypatch, graph)
    assert graph.published.count(IMAGES) > 300  # 30 Hz over 10.6 s, and once more at the end
    assert -2_000_000 <= graph.ahead_ns <= 0  # one cycle at most
    assert "/clock" in graph.published
    assert "/tf" in graph.published
    assert POSES not in graph.published
    assert not any(topic.startswith("/cellc/") for topic in graph.published)


_END = GraphEnd("/perception", messages.POSE_STAMPED, "reliable", "volatile")


@pytest.mark.parametrize(
    ("ends", "text"),
    [
        ({POSES: [replace(_END, reliability="best_effort")]}, "qos_of_another_profile: `/perception` is on"),
        ({POSES: [_END, replace(_END, node="/other")]}, "second_publisher: `/other` publishes `/object_pose` too"),
        ({POSES: [replace(_END, type="geometry_msgs/msg/Pose")]}, "qos_of_another_profile: `/perception` is on"),
    ],
)
def test_ends_on_the_graph_are_held_against_the_contract(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, ends: dict[str, list[GraphEnd]], text: str
) -> None:
    result = run(cell, monkeypatch, Graph(right, ends=ends)).result
    assert [line.startswith(text) for line in result.violations] == [True]


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"distro": "humble"}, "the ROS environment is `humble`, the folder is built for `jazzy`; source that"),
        (
            {"nodes": {"/perception", "/cellc_mock"}},
            "another cell is played on this domain; end `cellc mock --ros` there",
        ),
        ({"nodes": {"/perception", "/controller_manager"}}, "`/controller_manager` is on the graph already, and it is"),
        ({"ends": {"/clock": [replace(_END, node="/bag")]}}, "`/bag` publishes `/clock`, which is played here: it may"),
        ({"nodes": {"/rviz"}}, "`/perception` does not appear within 0 s on domain 100, on which there is `/rviz`"),
        ({"ends": {POSES: []}}, "`/perception` publishes no `/object_pose`, which the contract has it on"),
        ({"ends": {IMAGES: []}}, "`/perception` does not subscribe to `/camera/color/image_raw`, which the contract"),
    ],
)
def test_a_graph_that_cannot_be_used_is_refused(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, changes: dict[str, object], text: str
) -> None:
    graph = Graph(right, **changes)
    with pytest.raises(MockError) as refused:
        run(cell, monkeypatch, graph)
    assert refused.value.reason.startswith(text)
    assert IMAGES not in graph.published


def test_a_command_that_ends_is_told(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    result = run(cell, monkeypatch, Graph(right, code=1), launch="ros2 run detector").result
    text = "node_ended: `ros2 run detector` ended with exit code 1 before the rehearsal did"
    assert result.violations == (text,)
    with pytest.raises(MockError, match="exit code 1 before `/perception` appeared"):
        run(cell, monkeypatch, Graph(right, code=1, nodes=()), launch="ros2 run detector")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("nobody", "`nobody` is no node of the contract; nodes that can be left out: `perception`, `task`"),
        ("move_group", "`move_group` is played by the mock alone; nodes that can be left out: `perception`, `task`"),
    ],
)
def test_only_nodes_that_can_be_left_out_are(cell: MockCell, name: str, text: str) -> None:
    with pytest.raises(MockError) as refused:
        rehearse_among(cell, cell.entry("pick_and_place"), 0, AmongNodes((name,), "python3"))
    assert refused.value.reason == text


def test_the_clock_of_the_node_is_set_with_that_of_its_host(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    run_of = CampaignRun.undisturbed(cell.entry("pick_and_place"))
    back = FaultEntry(kind=FaultKind.JUMP_CLOCK, target="control_pc", at_s=1.0, jump_s=-0.05)
    graph, clocks = Graph(right), list[int]()
    monkeypatch.setattr(
        Graph, "clock_ns", property(lambda _: clocks[-1], lambda _, value: clocks.append(value)), raising=False
    )
    entry = run_of.entry.model_copy(update={"name": "set_back", "faults": (back,)})
    asked = cell_of(replace(cell.folder, rehearsals=(entry,)))
    result = run(asked, monkeypatch, graph, "set_back").result
    assert result.violations == ()
    assert sum(after < before for before, after in pairwise(clocks)) == 1
    assert min(clocks) >= 0


def test_a_campaign_has_the_faults_that_the_node_sees(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = [
        ("freeze", "camera", True),
        ("freeze", "arm", False),
        ("mismatch_qos", "/object_pose", True),
        ("mismatch_qos", "/joint_states", False),
        ("drop_frame", "arm_shoulder_link", True),
        ("jump_clock", "camera", True),
        ("protective_stop", "arm", False),
        ("missing_part", "object", True),
    ]
    for kind, target, expected in seen:
        fault = FaultEntry.model_validate({"kind": kind, "target": target, "at_s": 0.0})
        assert concerns(cell.contract, ("perception",), fault) is expected


def test_a_run_of_a_campaign_fails_where_the_node_breaks_its_contract(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    undisturbed = CampaignRun.undisturbed(cell.entry("pick_and_place"))
    for node, passes in ((right, True), (_WRONG["stamp on arrival"][0], False)):

        def rehearse(_: MockCell, entry: RehearsalEntry, seed: int, watch: Watch, node: Node = node) -> RehearsalResult:
            return run(cell, monkeypatch, Graph(node), watch=watch).result

        end = execute(cell, undisturbed, 0, rehearse)
        assert end.passed is passes
        assert end.limits.peaks != ()
        told = [line for line in failure_lines(end, "again") if "against the contract: stamp_of_another_time" in line]
        assert bool(told) is not passes


@pytest.mark.parametrize(("number", "domain"), [(0, "100"), (1, "99"), (3, "97")])
def test_each_process_of_a_campaign_has_a_domain_of_its_own(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, number: int, domain: str
) -> None:
    seen: list[str] = []

    def bridge(_: str, environment: Mapping[str, str]) -> Graph:
        seen.append(environment["ROS_DOMAIN_ID"])
        raise MockError("", "no graph")

    monkeypatch.setattr(session, "Bridge", bridge)
    monkeypatch.setattr(session, "process_number", lambda: number)
    asked = AmongNodes(("perception",), "python3", Timing(None), launch="node")
    with pytest.raises(MockError, match="no graph"):
        session.rehearse_on_own_domain(asked, cell, cell.entry("pick_and_place"), 0, lambda _: None)
    assert seen == [domain]


@pytest.mark.parametrize(
    ("more", "problem"),
    [
        (("--jobs", "2"), "--jobs with --ros needs --launch"),
        (("--jobs", "4", "--launch", "node", "--domain", "2"), "--domain must be 3 or greater"),
        (("--cluster", "tcp://a:1", "--launch", "node"), "--ros cannot be combined with --cluster"),
    ],
)
def test_processes_that_can_have_no_graph_of_their_own_are_refused(more: tuple[str, ...], problem: str) -> None:
    asked = ("--ros", "--without", "perception", "--lockstep", *more)
    told = command("campaign", str(ROOT / "generated/ur5e_pick"), *asked)
    assert told.code == 2
    assert problem in told.err
