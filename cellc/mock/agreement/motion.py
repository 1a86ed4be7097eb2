"""What MoveIt reads: limits of joints, groups and poses, and the controllers that it calls."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from cellc.contract.contract import (
    Contract,
    ContractController,
    ContractGripper,
    ContractJointLimits,
    hand_group,
    several_groups,
)
from cellc.contract.quantities import LARGEST
from cellc.mock.agreement.said import Edited, Names, Said, below, differing, parameters, xml
from cellc.robot.description.xml_tree import XmlElement

_NODE = "/move_group"
_LIMITS = "robot_description_planning.joint_limits."
_CALLED = "moveit_simple_controller_manager."
_PLANNING = "moveit_msgs/action/MoveGroup"
_TYPES = ("FollowJointTrajectory", "GripperCommand", "ParallelGripperCommand")
_POSITIONS = ("has_position_limits", "min_position", "max_position")


def joint_limits(edited: Edited, file: str) -> Iterator[str]:
    """Compare the limits that MoveIt plans with and those that the mock plans with."""
    said = below(parameters(file, edited.texts[file], _NODE), _LIMITS)
    limits = edited.contract.joint_limits
    for joint, own in limits.items():
        stated = {name: _bounded(value) for name, value in below(said, f"{joint}.").items()}
        yield from differing(*_comparable(stated, own), f"{_LIMITS}{joint}.")
    for joint in dict.fromkeys(name.partition(".")[0] for name in said):
        if edited.description.joint(joint) is None:
            yield f"`{_LIMITS}{joint}` must be a joint of `{edited.contract.files.urdf_mock}`"


def _bounded(value: Said) -> Said:
    return max(-LARGEST, min(LARGEST, value)) if isinstance(value, float) else value


def _comparable(said: Names, own: ContractJointLimits) -> tuple[Names, Names]:
    """Return both sides, without positions that nothing bounds."""
    executed: dict[str, Said] = {
        name: value
        for kind, value in (("velocity", own.velocity), ("acceleration", own.acceleration), ("jerk", own.jerk))
        for name, value in ((f"has_{kind}_limits", True), (f"max_{kind}", value))
    }
    bounds = {"min_position": own.lower, "max_position": own.upper}
    executed |= {name: value for name, value in bounds.items() if value is not None}
    if own.lower is not None or own.upper is not None:
        executed["has_position_limits"] = True
    bounded = any(abs(value) < LARGEST for name in bounds if isinstance(value := said.get(name), float))
    unbounded = () if bounded else _POSITIONS
    return {name: value for name, value in said.items() if name in executed or name not in unbounded}, executed


def moveit_controllers(edited: Edited, file: str) -> Iterator[str]:
    """Compare what MoveIt calls with the actions of the active controllers that no other node commands."""
    called = parameters(file, edited.texts[file], _NODE)
    target: Literal["mock", "real"] = "real" if file.endswith(".real.yaml") else "mock"
    said = below(called, _CALLED)
    names = said.get("controller_names", ())
    listed = [str(name) for name in names] if isinstance(names, list) else []
    executed = {
        action.rpartition("/")[0].strip("/"): (action, kind, controller)
        for manager in edited.contract.managers.values()
        for controller in manager.controllers.values()
        if controller.client is None or controller.client in _planners(edited.contract)
        for action, kind in _action(controller, target)
    }
    yield from differing(
        {"controller_names": sorted(name.strip("/") for name in listed)},
        {"controller_names": sorted(executed)},
        _CALLED,
    )
    for name in listed:
        if name.strip("/") in executed:
            action, kind, one = executed[name.strip("/")]
            wanted: Names = {
                "type": kind,
                "action_ns": action.rpartition("/")[2],
                "joints": one.joints,
                "default": True,
            }
            yield from differing(below(said, f"{name}."), wanted, f"{_CALLED}{name}.")


def _planners(contract: Contract) -> frozenset[str]:
    """Return the nodes that plan for others: what they are the client of, they send what they planned."""
    serving = (interface for interface in contract.interfaces.values() if interface.type == _PLANNING)
    return frozenset(end.node for interface in serving for end in interface.sources)


def _action(one: ContractController, target: Literal["mock", "real"]) -> Iterator[tuple[str, str]]:
    action, kind = one.action, one.action_type
    if target not in one.targets:
        action, kind = one.real_action, one.real_action_type
    short = (kind or "").rpartition("/")[2]
    if one.active and action is not None and short in _TYPES:
        yield action, short


def semantics(edited: Edited, file: str) -> Iterator[str]:
    """Compare groups, end effectors and poses of the SRDF; its pairs of links are executed."""
    root = xml(file, edited.texts[file])
    groups = {element.attributes.get("name", ""): _group(element) for element in root.all("group")}
    states = {
        f"{element.attributes.get('group', '')}.{element.attributes.get('name', '')}": _positions(element)
        for element in root.all("group_state")
    }
    effectors: dict[str, Said] = {
        element.attributes.get("name", ""): [element.attributes.get(name, "") for name in ("group", "parent_link")]
        for element in root.all("end_effector")
    }
    contract = edited.contract
    grippers = {
        hand_group(name, device.kind): device.gripper
        for name, device in contract.devices.items()
        if device.gripper is not None and hand_group(name, device.kind) not in contract.groups
    }
    mounted = {name: one for name, one in contract.devices.items() if name in grippers and one.kind != "arm"}
    parents = {name: contract.frames[one.root_link].parent for name, one in mounted.items()}
    yield from differing(groups, _executed_groups(contract, grippers), "group ")
    yield from differing(states, _executed_states(contract, grippers), "group_state ")
    yield from differing(effectors, {name: [name, parent] for name, parent in parents.items()}, "end_effector ")


def _group(group: XmlElement) -> Said:
    return [
        f"{part.tag} {' '.join(value for name, value in sorted(part.attributes.items()))}" for part in group.children
    ]


def _positions(state: XmlElement) -> Said:
    return [part for element in state.all("joint") for part in (element.attributes.get("name", ""), _number(element))]


def _number(joint: XmlElement) -> Said:
    text = joint.attributes.get("value", "")
    try:
        return float(text)
    except ValueError:
        return text


def _executed_groups(contract: Contract, grippers: Mapping[str, ContractGripper]) -> Names:
    chains: dict[str, Said] = {
        name: [f"chain {group.base_link} {group.tip_frame}"] for name, group in contract.groups.items()
    }
    several = [[target.group for target in pose] for pose in contract.poses.values() if len(pose) > 1]
    chains |= {several_groups(names): [f"group {name}" for name in names] for names in several}
    return chains | {name: [f"joint {gripper.joint}"] for name, gripper in grippers.items()}


def _executed_states(contract: Contract, grippers: Mapping[str, ContractGripper]) -> Names:
    states: dict[str, Said] = {}
    for name, pose in contract.poses.items():
        for target in pose:
            joints = contract.groups[target.group].joints
            states[f"{target.group}.{name}"] = [
                part for pair in zip(joints, target.positions, strict=True) for part in pair
            ]
    for name, pose in contract.poses.items():
        if len(pose) > 1:
            parts = [states[f"{target.group}.{name}"] for target in pose]
            together = [said for part in parts if isinstance(part, list) for said in part]
            states[f"{several_groups(target.group for target in pose)}.{name}"] = together
    for name, gripper in grippers.items():
        states[f"{name}.open"] = [gripper.joint, gripper.open]
        states[f"{name}.closed"] = [gripper.joint, gripper.closed]
    return states
