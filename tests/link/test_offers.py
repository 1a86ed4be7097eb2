"""The quality of service of an end is what the spec states, else what the catalog knows of it, else the default.

The rule is one for devices, controllers and the programs that cellc starts, and whether or not the spec speaks of the
topic. Profiles are those of the authors, resolved by hand for Fast DDS, which the cell runs on: `system_default` is
reliable, transient local and one sample deep where it writes, and best effort where it reads.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Endpoint, Interface, NodeSource
from cellc.compiler.link import endpoints
from cellc.compiler.spec.interfaces import QosSpec
from cellc.contract.diagnostics import Span, YamlPath
from tests.cells import CORPUS, EVERY_CELL, diagnose, linked, spec_of, spec_text, there
from tests.cells import written as in_folder

_WITHOUT_AN_ENTRY = {
    "node of the spec": "its author chose the profile, and the spec says it or takes the default",
    "adapter": "a program of the user on the library of the vendor",
}
"""Ends of topics that keep the default, and why; every other one has an entry in the catalog."""


_PLAIN = QosSpec()


def _specs() -> list[Path]:
    return [*map(spec_of, EVERY_CELL), *sorted((CORPUS / "valid").glob("*.yaml"))]


def _kind(cell: Cell, full_name: str, node: str) -> str:
    if any(one.full_name == full_name and one.source is NodeSource.SPEC for one in cell.nodes):
        return "node of the spec"
    return "adapter" if any(one.name == node and one.architecture == "direct_sdk" for one in cell.devices) else node


@pytest.mark.parametrize("spec", _specs(), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_every_end_of_a_topic_has_an_entry_in_the_catalog_or_a_reason(
    spec: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    unknown: list[tuple[str, Endpoint]] = []
    end_of = endpoints.EndName.end

    def end(
        self: endpoints.EndName,
        interface: str,
        path: YamlPath,
        span: Span,
        written: QosSpec = _PLAIN,
        *,
        serves: bool,
    ) -> Endpoint:
        made = end_of(self, interface, path, span, written, serves=serves)
        if (interface, serves) not in self.offers:
            unknown.append((interface, made))
        return made

    monkeypatch.setattr(endpoints.EndName, "end", end)
    cell = linked(spec)
    topics = {interface.name for interface in cell.interfaces if interface.kind.value == "topic"}
    kinds = {(_kind(cell, made.full_name, made.node), name) for name, made in unknown if name in topics}
    assert {(kind, name) for kind, name in kinds if kind not in _WITHOUT_AN_ENTRY} == set()


def _cell(folder: Path, interfaces: str, controllers: str = "") -> Path:
    """Return ur5e_pick with more interfaces and other parameters of its broadcaster."""
    text = spec_text("ur5e_pick").replace("\ninterfaces:\n", f"\ninterfaces:\n{interfaces}")
    text = text.replace(
        "joint_states: {type: joint_state_broadcaster}", f"joint_states: {{type: joint_state_broadcaster{controllers}}}"
    )
    return in_folder(folder, text)


def _ends(interface: Interface) -> dict[str, tuple[str, str, int]]:
    ends = (*interface.sources, *interface.sinks)
    return {end.node: (end.qos.reliability, end.qos.durability, end.qos.depth) for end in ends}


_SAID = {
    "controller that publishes": (
        "  /joint_states: {topic: sensor_msgs/msg/JointState, from: joint_states, rate: 500 Hz,\n"
        "                  to: [task, robot_state_publisher]}\n",
        "/joint_states",
        {
            "joint_states": ("reliable", "transient_local", 1),
            "task": ("reliable", "volatile", 10),
            "robot_state_publisher": ("best_effort", "volatile", 5),
        },
    ),
    "controller that follows": (
        "  /arm_trajectory/joint_trajectory: {topic: trajectory_msgs/msg/JointTrajectory, from: task,\n"
        "                                     to: arm_trajectory}\n",
        "/arm_trajectory/joint_trajectory",
        {"task": ("reliable", "volatile", 10), "arm_trajectory": ("best_effort", "volatile", 1)},
    ),
    "part of what is offered": (
        "  /joint_states: {topic: sensor_msgs/msg/JointState, from: {joint_states: {depth: 7}}, to: task,\n"
        "                  rate: 500 Hz}\n",
        "/joint_states",
        {"joint_states": ("reliable", "transient_local", 7), "task": ("reliable", "volatile", 10)},
    ),
    "listener of transforms": (
        "  /tf_static: {topic: tf2_msgs/msg/TFMessage, from: robot_state_publisher, to: task}\n",
        "/tf_static",
        {
            "robot_state_publisher": ("reliable", "transient_local", 1),
            "task": ("reliable", "transient_local", 100),
        },
    ),
}


@pytest.mark.parametrize("what", _SAID)
def test_topic_that_the_spec_declares_keeps_the_profiles_of_its_ends(what: str, tmp_path: Path) -> None:
    text, name, expected = _SAID[what]
    cell = linked(_cell(tmp_path, text))
    assert _ends(there(next((one for one in cell.interfaces if one.name == name), None))) == expected


def test_reader_that_asks_for_more_than_a_controller_offers_is_reported(tmp_path: Path) -> None:
    """A broadcaster is volatile with Cyclone DDS, and transient local is asked of it."""
    text = (
        "  /joint_states: {topic: sensor_msgs/msg/JointState, from: joint_states,\n"
        "                  to: {task: {durability: transient_local, depth: 1}}, rate: 500 Hz, wants: newest,\n"
        "                  max_age: 100 ms, on_stale: reject_goal}\n"
    )
    spec = _cell(tmp_path, text)
    spec.write_text(spec.read_text().replace("rmw_fastrtps_cpp 8.4.4", "rmw_cyclonedds_cpp 2.2.4"))
    assert "durability-mismatch" in {found.code for found in diagnose(spec)}


_RUN = "joint_state_publisher/joint_state_publisher"
_SECOND = f"  joint_state_publisher: {{run: {_RUN}, host: control_pc, owner: integration}}\n"


def test_program_that_is_known_to_publish_is_a_publisher_whether_the_spec_says_so_or_not(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("\nnodes:\n", f"\nnodes:\n{_SECOND}")
    (found,) = (found for found in diagnose(in_folder(tmp_path, text)) if found.code == "second-state-publisher")
    assert found.yaml_path == ("nodes", "joint_state_publisher")


def test_joint_states_on_local_topics_are_no_joint_states_of_the_cell(tmp_path: Path) -> None:
    spec = _cell(tmp_path, "", ", parameters: {use_local_topics: true}")
    assert "/joint_states" not in {interface.name for interface in linked(spec).interfaces}
    (found,) = (found for found in diagnose(spec) if found.code == "missing-joint-states")
    assert found.yaml_path == ("control", "controllers", "joint_states", "parameters", "use_local_topics")


def test_topic_that_a_parameter_takes_away_is_not_offered(tmp_path: Path) -> None:
    declared = "  /joint_states: {topic: sensor_msgs/msg/JointState, from: joint_states, to: task, rate: 500 Hz}\n"
    spec = _cell(tmp_path, declared, ", parameters: {use_local_topics: true}")
    (found,) = (found for found in diagnose(spec) if found.code == "unoffered-topic")
    assert found.help == "did you mean `/joint_states/joint_states`?"
    assert [related.message for related in found.related] == ["this decides which topics it has"]
