"""``urdf/<cell>.<target>.urdf`` and ``config/moveit/<cell>.srdf``: the robot description, and what goes with it.

URDF 1.0 with ``<ros2_control>`` tags for ``mock`` and ``real``, as robot_state_publisher and ros2_control read it,
and for ``sim`` where the spec asks for it: one tag, of the simulator, for the hardware of all devices. The
launch file passes it through xacro, which puts in the share folders of installed packages (``$(find …)`` in hardware
parameters); nothing else in it needs xacro. A cell with several controller managers has one more for each,
``urdf/<cell>.<manager>.<target>.urdf``: a manager takes all hardware that it reads of, and two that drive one robot are
one too many. It has the robots of the manager and all that is in their reach, not those at the other end of a hall.
Left out: accelerations and jerks, which URDF cannot hold (``config/joint_limits.yaml`` has them), dynamic
frames, and transmissions.

SRDF as srdfdom reads it, for a cell with planning groups: groups, end effectors, named poses, and links that may touch.
move_group takes it as ``robot_description_semantic``, the mock takes its pairs. Pairs without a check are found by
sampling, as MoveIt's Setup Assistant does, with its reasons. Left out: virtual joints, because the description is
rooted in the world; and pairs of robots that cannot reach each other, which are as many as the square of the robots:
move_group compares the boxes around links before it compares links.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.motion import NamedPose
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import SCENE, description_file, manager_description_file, semantic_file
from cellc.compiler.feasibility import MARGIN_M, RNG_SEED, disabled_links, part_with, parts_of
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.formats.urdf.robot import (
    manager_description,
    real_description,
    robot_description,
    simulated_description,
)
from cellc.compiler.formats.xml_text import comment, element, headed, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.simulated import SIM, is_asked
from cellc.contract.entities import Target


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the description for each target, and the semantic one."""
    cell = graph.cell
    texts: dict[Target, str] = {"mock": render(robot_description(cell, "mock")), "real": graph.once(real_description)}
    for target, text in texts.items():
        yield Artifact(description_file(cell, target), headed(text, plan.header.text))
        for manager in cell.managers if len(cell.managers) > 1 else ():
            robot = manager_description(part_with(graph, manager.devices), target, manager.devices)
            yield Artifact(manager_description_file(cell, manager, target), render(robot, plan.header.text))
    if is_asked(cell):
        robot = simulated_description(cell, SCENE)
        yield Artifact(description_file(cell, SIM), render(robot, plan.header.text))
    if cell.groups:
        root = element("robot", {"name": cell.name}, _semantic(graph))
        yield Artifact(semantic_file(cell), render(root, plan.header.text))


def _semantic(graph: CellGraph) -> Iterator[Element]:
    cell = graph.cell
    for group in cell.groups:
        yield comment(f"motion.groups.{group.name}")
        chain = element("chain", {"base_link": group.base_link, "tip_link": group.tip_frame})
        yield element("group", {"name": group.name}, [chain])
    for pose in cell.poses:
        yield _state(pose)
    yield from _named_together(cell.poses)
    named = {group.name for group in cell.groups}
    for device in cell.devices:
        if device.gripper is not None and _hand_group(device.name, device.kind) not in named:
            yield comment(f"devices.{device.name}")
            yield from _gripper(device)
    disabled = disabled_links(graph)
    if len(parts_of(graph)) > 1:
        yield comment("robots that cannot reach each other are in no pair: boxes around their links keep them apart")
    yield comment(
        f"adjacent links, and pairs that collide in all or none of {disabled.samples} configurations within the joint "
        f"limits (seed {RNG_SEED}); none means farther apart than {shortest(MARGIN_M)} m"
    )
    for pair in disabled.pairs:
        names = {"link1": pair.first, "link2": pair.second}
        yield element("disable_collisions", names | {"reason": pair.reason.capitalize()})


def _named_together(poses: Sequence[NamedPose]) -> Iterator[Element]:
    """Yield a group of all groups that a pose names, for one request to move_group, and the pose of all of them."""
    declared: set[str] = set()
    for name in dict.fromkeys(pose.name for pose in poses):
        parts = [pose for pose in poses if pose.name == name]
        group = _several_groups(pose.group for pose in parts)
        if len(parts) > 1 and group not in declared:
            yield element("group", {"name": group}, [element("group", {"name": pose.group}) for pose in parts])
        if len(parts) > 1:
            yield element("group_state", {"name": name, "group": group}, [item for pose in parts for item in _at(pose)])
        declared.add(group)


def _state(pose: NamedPose) -> Element:
    return element("group_state", {"name": pose.name, "group": pose.group}, list(_at(pose)))


def _at(pose: NamedPose) -> Iterator[Element]:
    for joint, value in zip(pose.joints, pose.positions, strict=False):
        yield element("joint", {"name": joint, "value": shortest(value)})


def _gripper(device: Device) -> Iterator[Element]:
    gripper, group = device.gripper, _hand_group(device.name, device.kind)
    assert gripper is not None
    joint = gripper.joint
    yield element("group", {"name": group}, [element("joint", {"name": joint})])
    for name, position in (("open", gripper.open), ("closed", gripper.closed)):
        value = element("joint", {"name": joint, "value": shortest(position)})
        yield element("group_state", {"name": name, "group": group}, [value])
    if device.kind != "arm":  # fingers of an arm have no mount; a marker then is at the tip of the arm's group
        yield element("end_effector", {"name": group, "group": group, "parent_link": device.mount.parent_frame})


def _hand_group(device: str, kind: str) -> str:
    """Return the group of the SRDF that the fingers of a device are: an arm that has its own has another group too."""
    return f"{device}_gripper" if kind == "arm" else device


def _several_groups(groups: Iterable[str]) -> str:
    """Return the group of the SRDF that several groups are, whose poses are reached together."""
    return "_and_".join(groups)
