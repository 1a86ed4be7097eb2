"""What move_group is told: every parameter that it needs, none that it does not know, and joints that exist."""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element, fromstring

import pytest

from tests.consumers.matrix import build, every_planning_build
from tests.consumers.parameter_files import told
from tests.consumers.refused_parameters import claimed
from tests.consumers.starting import activated, node_name, processes, written, written_managers

# launch_moveit.md 5.3; request and response adapters of default_planning_*_adapters, Jazzy and later.
_REQUEST = {"ResolveConstraintFrames", "ValidateWorkspaceBounds", "CheckStartStateBounds", "CheckStartStateCollision"}
_RESPONSE = {"AddTimeOptimalParameterization", "ValidateSolution", "DisplayMotionPath"}
_REQUEST_HUMBLE = {
    "AddTimeOptimalParameterization",
    "ResolveConstraintFrames",
    "FixWorkspaceBounds",
    "FixStartStateBounds",
    "FixStartStateCollision",
    "FixStartStatePathConstraints",
}
_JUDGED = ["ResolveConstraintFrames", "ValidateWorkspaceBounds", "CheckStartStateBounds", "CheckStartStateCollision"]
_PLUGINS = {
    "ompl": "ompl_interface/OMPLPlanner",
    "pilz_industrial_motion_planner": "pilz_industrial_motion_planner/CommandPlanner",
}
_SCENE = ("planning_scene", "geometry_updates", "state_updates", "transforms_updates", "robot_description")
_EXECUTION = (
    "execution_duration_monitoring",
    "allowed_execution_duration_scaling",
    "allowed_goal_duration_margin",
    "allowed_start_tolerance",
    "wait_for_trajectory_completion",
)
_CALLED = ("type", "action_ns", "joints", "default")
_LIMITS = ("position_limits", "velocity_limits", "acceleration_limits", "jerk_limits")
_BOUNDS = ("min_position", "max_position", "max_velocity", "max_acceleration", "max_jerk")


def _told(cell: str, distro: str) -> dict[str, Any]:
    texts = build(cell, distro).texts
    planners = [process for process in processes(cell, distro, "mock") if process.executable == "move_group"]
    return told(texts, planners[0].files, "/move_group") if planners else {}


def _semantic(cell: str, distro: str) -> Element:
    return fromstring(build(cell, distro).texts[f"config/moveit/{cell}.srdf"])


def _joints(cell: str, distro: str) -> dict[str, Element]:
    return {joint.attrib["name"]: joint for joint in fromstring(build(cell, distro).urdf("mock")).findall("joint")}


def _commanded(cell: str, distro: str) -> dict[str, list[str]]:
    """Return the joints of each active controller with an action, under the name that MoveIt has for it."""
    texts, found = build(cell, distro).texts, {}
    for manager in (
        process for process in processes(cell, distro, "mock") if process.executable == "ros2_control_node"
    ):
        types = told(texts, manager.files, node_name(manager))
        for name in activated(cell, distro, "mock", node_name(manager)):
            values = told(texts, manager.files, f"{manager.namespace}/{name}")
            joints = [claim.rpartition("/")[0] for claim in claimed(values)]
            if joints and types[f"{name}.type"] != "forward_command_controller/ForwardCommandController":
                found[f"{manager.namespace}/{name}".removeprefix("/")] = joints
    return found


def _adapted(cell: str, distro: str) -> dict[str, list[str]]:
    """Return the joints that no component has, by who serves the action with which move_group moves them."""
    robot = fromstring(build(cell, distro).urdf("real"))
    loaded = {tag.get("name") for tag in robot.findall("ros2_control/joint")}
    moving = (tag for tag in robot.findall("joint") if tag.get("type") != "fixed" and tag.find("mimic") is None)
    free = [tag.attrib["name"] for tag in moving if tag.attrib["name"] not in loaded]
    return {
        name.rpartition("/")[0][1:]: free
        for name, one in written(cell).get("interfaces", {}).items()
        if one.get("action", "").endswith("/FollowJointTrajectory") and one["client"] == "move_group"
    }


def _planned(cell: str, distro: str) -> dict[str, list[str]]:
    """Return those that the spec has move_group command: a second client is a second commander."""
    own = {
        f"{namespace}/{name}".removeprefix("/")
        for namespace, manager in written_managers(cell, distro)
        for name, one in manager["controllers"].items()
        if one.get("client") == "move_group"
    }
    controlled = {name: joints for name, joints in _commanded(cell, distro).items() if name in own}
    return controlled | _adapted(cell, distro)


def _expected(cell: str, distro: str) -> set[str]:
    """Return the name of every parameter of a complete configuration."""
    groups = [
        group.attrib["name"] for group in _semantic(cell, distro).findall("group") if group.find("chain") is not None
    ]
    commanded = _commanded(cell, distro)
    names = {f"publish_{one}" for one in (*_SCENE, "robot_description_semantic")}
    names |= {f"trajectory_execution.{one}" for one in _EXECUTION} | {"moveit_manage_controllers"}
    names |= {"planning_pipelines", "default_planning_pipeline", "capabilities", "moveit_controller_manager"}
    manager = "moveit_simple_controller_manager"
    names |= {f"{manager}.controller_names"}
    names |= {f"{manager}.{one}.{key}" for one in _planned(cell, distro) for key in _CALLED}
    planning = "robot_description_planning"
    names |= {f"{planning}.default_{name}_scaling_factor" for name in ("velocity", "acceleration")}
    names |= {f"{planning}.cartesian_limits.max_{name}" for name in ("trans_vel", "trans_acc", "trans_dec", "rot_vel")}
    joints = {joint for one in (*commanded.values(), *_adapted(cell, distro).values()) for joint in one}
    names |= {f"{planning}.joint_limits.{joint}.has_{limit}" for joint in joints for limit in _LIMITS}
    turning = {joint for joint in joints if _joints(cell, distro)[joint].get("type") == "continuous"}
    names |= {
        f"{planning}.joint_limits.{joint}.{bound}"
        for joint in joints
        for bound in _BOUNDS
        if not (joint in turning and bound.endswith("_position"))  # URDF: a continuous joint has no lower and upper
    }
    solver = ("kinematics_solver", "kinematics_solver_search_resolution", "kinematics_solver_timeout")
    names |= {f"robot_description_kinematics.{group}.{one}" for group in groups for one in solver}
    return names | _pipelines(distro, groups)


def _pipelines(distro: str, groups: list[str]) -> set[str]:
    humble = distro == "humble"
    own = (
        ("planning_plugin", "request_adapters")
        if humble
        else ("planning_plugins", "request_adapters", "response_adapters")
    )
    names = {f"{pipeline}.{key}" for pipeline in _PLUGINS for key in own}
    names |= {"ompl.start_state_max_bounds_error"} if humble else set()
    of_group = ("default_planner_config", "planner_configs", "longest_valid_segment_fraction", "projection_evaluator")
    names |= {f"ompl.{group}.{key}" for group in groups for key in of_group}
    return names | {
        "ompl.planner_configs.RRTConnectkConfigDefault.type",
        "pilz_industrial_motion_planner.default_planner_config",
    }


@every_planning_build
def test_move_group_is_told_all_that_it_needs_and_nothing_that_it_does_not_know(cell: str, distro: str) -> None:
    # What the spec says of the QoS of its topics is another page's: test_agreement.py.
    found = {name for name in _told(cell, distro) if not name.startswith("qos_overrides.")}
    assert not found or found == _expected(cell, distro)


@every_planning_build
def test_pipelines_name_plugins_and_adapters_that_exist(cell: str, distro: str) -> None:
    found = _told(cell, distro)
    for pipeline, plugin in _PLUGINS.items() if found else ():
        if distro == "humble":
            assert found[f"{pipeline}.planning_plugin"] == plugin
            adapters = found[f"{pipeline}.request_adapters"].split()
            assert {
                adapter.removeprefix("default_planner_request_adapters/") for adapter in adapters
            } <= _REQUEST_HUMBLE
        else:
            assert found[f"{pipeline}.planning_plugins"] == [plugin]
            for side, known in (("request", _REQUEST), ("response", _RESPONSE)):
                adapters = found[f"{pipeline}.{side}_adapters"]
                found_here = [adapter.removeprefix(f"default_planning_{side}_adapters/") for adapter in adapters]
                assert set(found_here) <= known
                # moveit_configs_utils, default_configs/*_planning.yaml (2.12.3): the planner of a pipeline may leave
                # out that it times a path by itself, and nothing else.
                timed = ["AddTimeOptimalParameterization"] * (pipeline == "ompl")
                assert found_here == (
                    _JUDGED if side == "request" else [*timed, "ValidateSolution", "DisplayMotionPath"]
                )
    if found:
        assert found["planning_pipelines"] == list(_PLUGINS)
        switches = ("execution_duration_monitoring", "wait_for_trajectory_completion")
        assert all(isinstance(found[f"trajectory_execution.{switch}"], bool) for switch in switches)
        for name in (name for name in found if name.endswith(".planner_configs")):
            configured = {finding.split(".")[2] for finding in found if finding.startswith("ompl.planner_configs.")}
            assert found[name.replace("planner_configs", "default_planner_config")] in found[name]
            assert set(found[name]) == configured
        assert found["default_planning_pipeline"] in found["planning_pipelines"]
        assert found["pilz_industrial_motion_planner.default_planner_config"] in ("PTP", "LIN", "CIRC")
        capabilities = found["capabilities"].split()
        service = {"pilz_industrial_motion_planner/MoveGroupSequenceAction"}
        assert service <= set(capabilities) <= service | {"pilz_industrial_motion_planner/MoveGroupSequenceService"}
        manager = "moveit_simple_controller_manager/MoveItSimpleControllerManager"
        assert found["moveit_controller_manager"] == manager


@every_planning_build
def test_controllers_of_moveit_have_the_joints_of_their_controllers(cell: str, distro: str) -> None:
    found, manager = _told(cell, distro), "moveit_simple_controller_manager"
    if not found:
        return
    planned = _planned(cell, distro)
    assert planned
    assert found[f"{manager}.controller_names"] == list(planned)
    gripper = "GripperCommand" if distro == "humble" else "ParallelGripperCommand"
    for name, joints in planned.items():
        kind, action = (
            (gripper, "gripper_cmd") if len(joints) == 1 else ("FollowJointTrajectory", "follow_joint_trajectory")
        )
        assert found[f"{manager}.{name}.joints"] == joints
        assert (found[f"{manager}.{name}.type"], found[f"{manager}.{name}.action_ns"]) == (kind, action)
        assert found[f"{manager}.{name}.default"] is True


@every_planning_build
def test_limits_of_moveit_are_those_of_the_description(cell: str, distro: str) -> None:
    found, joints = _told(cell, distro), _joints(cell, distro)
    start = "robot_description_planning.joint_limits."
    for joint in {name.removeprefix(start).split(".")[0] for name in found if name.startswith(start)}:
        limit = joints[joint].find("limit")
        assert limit is not None
        values = {name.removeprefix(f"{start}{joint}."): one for name, one in found.items() if f".{joint}." in name}
        turns = joints[joint].attrib["type"] == "continuous"  # it has no limit of position to tell
        assert all(values[f"has_{limit}"] is True for limit in _LIMITS if not (turns and "position" in limit)), joint
        assert values.get("min_position") == (None if turns else float(limit.attrib["lower"]))
        assert values.get("max_position") == (None if turns else float(limit.attrib["upper"]))
        assert values["max_velocity"] == float(limit.attrib["velocity"])
        assert values["max_acceleration"] > 0 < values["max_jerk"]


@every_planning_build
def test_stages_are_shares_of_the_last_one_for_every_joint(cell: str, distro: str) -> None:
    texts, start = build(cell, distro).texts, "robot_description_planning.joint_limits."
    files = {
        int(path.removesuffix(".yaml").rpartition("_")[2]): path
        for path in texts
        if path.startswith("config/commissioning/stage_")
    }
    if not files:  # a corpus cell without the section
        return
    stages = {share: told(texts, (path,), "/move_group") for share, path in files.items()}
    full = _told(cell, distro)
    for share, values in stages.items():
        assert values.keys() == stages[100].keys(), share
        for name, value in values.items():
            if name.startswith(f"{start}") and ".has_" in name:
                assert value is True, name
            elif name.startswith(start):
                assert value == pytest.approx(stages[100][name] * share / 100, rel=1e-9), name
                assert 0 < value <= full[name] * (1 + 1e-9), name
    moved = {name.removeprefix(start).split(".")[0] for name in full if name.startswith(start)}
    for quantity in ("velocity", "acceleration"):
        for part in (f"has_{quantity}_limits", f"max_{quantity}"):
            assert {f"{start}{joint}.{part}" for joint in moved} <= stages[100].keys()


@every_planning_build
def test_semantic_description_names_what_exists(cell: str, distro: str) -> None:
    robot, joints = fromstring(build(cell, distro).urdf("mock")), _joints(cell, distro)
    links = {link.attrib["name"]: link for link in robot.findall("link")}
    semantic = _semantic(cell, distro)
    assert semantic.attrib["name"] == robot.attrib["name"]
    groups = {group.attrib["name"] for group in semantic.findall("group")}
    for tag in semantic.iter():
        assert {
            tag.attrib[key] for key in ("base_link", "tip_link", "parent_link", "link1", "link2") if key in tag.attrib
        } <= set(links)
        assert tag.get("group", next(iter(groups))) in groups
    for tag in (*semantic.findall("group/joint"), *semantic.findall("group_state/joint")):
        limit = joints[tag.attrib["name"]].find("limit")
        assert limit is not None
        # URDF: a continuous joint has no lower and upper.
        lower, upper = (float(limit.get(end, sign)) for end, sign in (("lower", "-inf"), ("upper", "inf")))
        assert lower <= float(tag.get("value", max(lower, -1e3))) <= upper
    pairs = [frozenset((tag.attrib["link1"], tag.attrib["link2"])) for tag in semantic.findall("disable_collisions")]
    assert len(set(pairs)) == len(pairs)
    assert all(len(pair) == 2 and all(links[link].find("collision") is not None for link in pair) for pair in pairs)
    reasons = {tag.get("reason") for tag in semantic.findall("disable_collisions")}
    assert reasons <= {"Adjacent", "Never", "Always", "Default", "User"}  # DisabledReason of its setup assistant


@every_planning_build
def test_links_that_a_joint_connects_are_never_checked_against_each_other(cell: str, distro: str) -> None:
    # MoveIt's setup assistant leaves them out as adjacent, whether they touch or not: neighbours do at every joint.
    robot, joints = fromstring(build(cell, distro).urdf("mock")), _joints(cell, distro)
    solid = {link.attrib["name"] for link in robot.findall("link") if link.find("collision") is not None}
    above = {_link_of(joint, "child"): _link_of(joint, "parent") for joint in joints.values()}
    left_out = {
        frozenset((tag.attrib["link1"], tag.attrib["link2"]))
        for tag in _semantic(cell, distro).findall("disable_collisions")
    }
    for link in solid & set(above):
        parent = above[link]
        while parent not in solid and parent in above:
            parent = above[parent]
        assert parent not in solid or frozenset((link, parent)) in left_out, f"{parent} and {link}"


def _link_of(joint: Element, end: str) -> str:
    found = joint.find(end)
    assert found is not None
    return found.attrib["link"]


@every_planning_build
def test_named_states_state_every_joint_of_their_group(cell: str, distro: str) -> None:
    semantic, joints = _semantic(cell, distro), _joints(cell, distro)
    parents = {_link_of(joint, "child"): joint for joint in joints.values()}
    told: dict[str, set[str]] = {}
    for group in semantic.findall("group"):
        names = {joint.attrib["name"] for joint in group.findall("joint")}
        names = names.union(*(told[part.attrib["name"]] for part in group.findall("group")))
        chain = group.find("chain")
        link = "" if chain is None else chain.attrib["tip_link"]
        while chain is not None and link != chain.attrib["base_link"]:
            joint = parents[link]
            names |= {joint.attrib["name"]} if joint.get("type") != "fixed" else set()
            link = _link_of(joint, "parent")
        assert names
        told[group.attrib["name"]] = names
        for state in semantic.findall("group_state"):
            if state.get("group") == group.get("name"):
                assert {joint.attrib["name"] for joint in state.findall("joint")} == names


@every_planning_build
def test_move_group_gets_both_descriptions(cell: str, distro: str) -> None:
    for process in (process for process in processes(cell, distro, "real") if process.executable == "move_group"):
        texts = build(cell, distro).texts
        assert process.values["robot_description"] == (texts[f"urdf/{cell}.real.urdf"], "str")
        assert process.values["robot_description_semantic"] == (texts[f"config/moveit/{cell}.srdf"], "str")


@every_planning_build
def test_values_are_within_what_their_readers_can_use(cell: str, distro: str) -> None:
    solvers = {"kdl_kinematics_plugin/KDLKinematicsPlugin", "lma_kinematics_plugin/LMAKinematicsPlugin"}
    for name, value in _told(cell, distro).items():
        if name.endswith(".kinematics_solver"):
            assert value in solvers
        if name.endswith((".kinematics_solver_timeout", ".kinematics_solver_search_resolution")):
            assert 0 < value <= 0.1  # a planner asks many times
        if name.endswith(".allowed_start_tolerance"):
            assert 0 < value <= 0.1  # rad; zero would switch the check off
        if name.startswith("publish_") or name == "moveit_manage_controllers":
            assert isinstance(value, bool)
        if name.endswith(("scaling_factor", "longest_valid_segment_fraction")):
            assert 0 < value <= 1
