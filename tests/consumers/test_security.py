"""The emitted policy against what launching starts: who may command, and that nobody is denied what it needs."""

from __future__ import annotations

import re
from xml.etree.ElementTree import Element

import pytest

from tests.consumers.matrix import build, every_build
from tests.consumers.permissions import Permissions, Right, permissions, policy_of
from tests.consumers.starting import node_name, plan, processes, proven, written_managers
from tests.consumers.test_walk import commands, sections
from tests.emit.cells import contract_data


def profiles(cell: str, distro: str) -> dict[str, Element]:
    """Return the profile of every node by its fully qualified name."""
    policy = policy_of(build(cell, distro).texts)
    return {
        f"{profile.attrib['ns'].rstrip('/')}/{profile.attrib['node']}": profile for profile in policy.iter("profile")
    }


def granted(profile: Element, plural: str, right: str) -> set[str]:
    """Return the names that a profile grants for one right."""
    lists = [element for element in profile.findall(plural) if element.get(right) == "ALLOW"]
    return {entry.text or "" for item in lists for entry in item}


@every_build
def test_processes_start_in_enclaves_of_the_policy(cell: str, distro: str) -> None:
    policy = policy_of(build(cell, distro).texts)
    enclaves = {enclave.attrib["path"]: enclave for enclave in policy.iter("enclave")}
    for process in processes(cell, distro, "real"):
        flag, path = process.ros_arguments
        assert flag == "--enclave"
        inside = {
            f"{profile.attrib['ns'].rstrip('/')}/{profile.attrib['node']}" for profile in enclaves[path].iter("profile")
        }
        # A spawner calls itself spawner_CONTROLLER after the first one that it is given, in the manager's namespace.
        first = f"spawner_{process.arguments[0]}" if process.executable == "spawner" else ""
        assert {name for name in inside if name.endswith(first)} if first else node_name(process) in inside


@every_build
def test_controllers_serve_their_own_actions_alone_and_their_clients_alone_may_call(cell: str, distro: str) -> None:
    found = profiles(cell, distro)
    callers: dict[str, set[str]] = {}
    for name, profile in found.items():
        for action in granted(profile, "actions", "call"):
            callers.setdefault(action, set()).add(name)
    for namespace, manager in written_managers(cell, distro):
        for controller, written in manager["controllers"].items():
            node = f"{namespace}/{controller}"
            served = granted(found[node], "actions", "execute")
            assert all(action.startswith(f"{node}/") for action in served), node
            for action in served:
                # A person sends one goal in gate G7, from an enclave that may do nothing else.
                by_nodes = callers.get(action, set()) - {"/first_goal"}
                assert by_nodes == ({f"/{written['client']}"} if "client" in written else set())


# move_group hears them (moveit2 2.12.4, planning_scene_monitor.cpp and trajectory_execution_manager.cpp): who says one
# puts objects into the scene or takes them out, past every action, or stops what is carried out.
_SAID_BY_NOBODY = {
    *("/planning_scene", "/collision_object", "/planning_scene_world", "/attached_collision_object"),
    "/trajectory_execution_event",
}


@every_build
def test_nobody_may_change_the_scene_or_stop_a_trajectory_by_a_topic(cell: str, distro: str) -> None:
    for name, profile in profiles(cell, distro).items():
        assert not granted(profile, "topics", "publish") & _SAID_BY_NOBODY, name


@every_build
def test_what_one_node_hears_another_may_say(cell: str, distro: str) -> None:
    found = profiles(cell, distro)
    # A node's own name is in the place of the tilde of what it says: `~/controller_state` of a trajectory controller.
    own = {(name, topic) for name, profile in found.items() for topic in granted(profile, "topics", "publish")}
    said = {topic.replace("~", name, 1) if topic.startswith("~/") else topic for name, topic in own}
    # Who executes an action says its feedback and status.
    executed = {action for profile in found.values() for action in granted(profile, "actions", "execute")}
    said |= {f"{action}/_action/{part}" for action in executed for part in ("feedback", "status")}
    for name, profile in found.items():
        heard = {topic for topic in granted(profile, "topics", "subscribe") if not topic.startswith("~/")} - {"/clock"}
        heard -= _SAID_BY_NOBODY
        # A bag takes diagnostics where somebody says them; the manager of Humble has none.
        heard -= {"/diagnostics"} if (name, distro) == ("/rosbag2_recorder", "humble") else set()
        assert {topic for topic in heard if "/unused/" not in topic} <= said, name


@every_build
def test_nobody_may_command_past_an_action(cell: str, distro: str) -> None:
    # A trajectory controller fails to configure where it may not subscribe; nothing may speak to it there.
    found = profiles(cell, distro)
    said = {topic for profile in found.values() for topic in granted(profile, "topics", "publish")}
    for name, profile in found.items():
        own = {topic.replace("~", name) for topic in granted(profile, "topics", "subscribe") if topic.startswith("~/")}
        assert not own & said


@every_build
def test_unused_topics_are_said_and_heard_by_one_node_alone(cell: str, distro: str) -> None:
    for name, profile in profiles(cell, distro).items():
        names = granted(profile, "topics", "publish") | granted(profile, "topics", "subscribe")
        home = name.rpartition("/")[0]
        unused = {topic for topic in names if "/unused/" in topic}
        assert not unused or name == f"{home}/description_publisher"
        assert all(topic.startswith(f"{home}/unused/") for topic in unused)


# ros2_control.md: what every controller manager serves, and what `spawner --inactive` calls of it: it loads, configures
# and asks what is loaded; to activate is the bring-up's, after its conditions.
_OF_A_MANAGER = {
    *(f"list_{name}" for name in ("controllers", "controller_types", "hardware_components", "hardware_interfaces")),
    *(f"{name}_controller" for name in ("load", "configure", "switch", "unload")),
    *("reload_controller_libraries", "set_hardware_component_state"),
}
_BY_SPAWNER = {"list_controllers", "load_controller", "configure_controller"}


@every_build
def test_managers_serve_what_they_have_and_spawners_may_call_what_they_need_and_no_more(cell: str, distro: str) -> None:
    found = profiles(cell, distro)
    for namespace, _ in written_managers(cell, distro):
        manager = f"{namespace}/controller_manager"
        served = {name.removeprefix(f"{manager}/") for name in granted(found[manager], "services", "reply")}
        assert {name for name in served if "/" not in name} - {"cleanup_controller"} == _OF_A_MANAGER
        spawners_ = [one for name, one in found.items() if name.startswith(f"{namespace}/spawner_")]
        assert spawners_
        for one in spawners_:
            assert granted(one, "services", "request") == {f"{manager}/{name}" for name in _BY_SPAWNER}


@every_build
def test_who_serves_parameters_serves_them_all(cell: str, distro: str) -> None:
    # network_security.md 5.3: what every node needs.
    every = {f"~/{name}_parameters" for name in ("describe", "get", "list", "set")}
    every |= {"~/get_parameter_types", "~/set_parameters_atomically"}
    for name, profile in profiles(cell, distro).items():
        served = {name for name in granted(profile, "services", "reply") if "parameter" in name}
        assert served in (set(), every), name


@every_build
def test_what_one_node_calls_another_serves(cell: str, distro: str) -> None:
    found = profiles(cell, distro)
    served = {
        name.replace("~", node) for node, profile in found.items() for name in granted(profile, "services", "reply")
    }
    # Who executes an action serves its cancel.
    executed = {name.replace("~", node) for node, one in found.items() for name in granted(one, "actions", "execute")}
    served |= {f"{action}/_action/cancel_goal" for action in executed}
    for name, profile in found.items():
        assert granted(profile, "services", "request") <= served, name


@every_build
def test_descriptions_and_joint_states_pass(cell: str, distro: str) -> None:
    found = profiles(cell, distro)
    for process in (process for process in processes(cell, distro, "mock") if process.executable != "spawner"):
        may_say = granted(found[node_name(process)], "topics", "publish")
        may_hear = granted(found[node_name(process)], "topics", "subscribe")
        if process.executable == "robot_state_publisher":
            assert f"{process.namespace}/robot_description" in may_say
            assert {process.remaps.get(topic, topic) for topic in ("/tf", "/tf_static")} <= may_say
            states = f"{process.namespace}/joint_states"
            assert process.remaps.get(states, states) in may_hear
        if process.executable == "ros2_control_node":
            assert process.remaps["~/robot_description"] in may_hear
        if process.executable == "move_group":
            assert "/joint_states" in may_hear


@pytest.mark.parametrize("side", ["left", "right"])
def test_arm_of_one_side_is_not_commanded_from_the_other(side: str) -> None:
    other = "right" if side == "left" else "left"
    profile = profiles("two_arms", "jazzy")[f"/{side}_task"]
    assert granted(profile, "actions", "call") >= {f"/{side}/gripper_action/gripper_cmd"}
    assert not [action for action in granted(profile, "actions", "call") if action.startswith(f"/{other}/")]


def _typed(cell: str, distro: str, enclave: str = "people") -> Permissions:
    return permissions(build(cell, distro).texts)[f"/{cell}/{enclave}"]


@every_build
def test_people_may_do_what_the_gates_have_them_type(cell: str, distro: str) -> None:
    may, asked = _typed(cell, distro), 0
    typed = (command for text in sections(cell, distro).values() for command in commands(text))
    for command in (re.sub(r"^timeout \d+ ", "", word).split(" | ")[0] for word in typed):
        words = command.split()
        ends: list[tuple[Right, str]] = []
        if re.search(r"ros2 topic (echo|hz|delay|bw)", command):
            ends = [("subscribe", next(word for word in words if word.startswith("/")))]
        elif command.startswith("ros2 bag record"):
            ends = [("subscribe", word) for word in words if word.startswith("/")]
        elif command.startswith("ros2 control list_"):
            ends = [("request", f"{words[-1]}/{words[2]}")]
        elif command.startswith("ros2 lifecycle get"):
            ends = [("request", f"{words[-1]}/get_state")]
        elif command.startswith("ros2 lifecycle set"):
            ends = [("request", f"{words[-2]}/{name}") for name in ("change_state", "get_available_transitions")]
        elif command.startswith("ros2 service call") and words[3].endswith("/get_parameters"):
            ends = [("request", words[3])]
        elif "tf2_echo" in command or "tf2_monitor" in command:
            ends = [("subscribe", "/tf"), ("subscribe", "/tf_static")]
        for right, name in ends:
            assert may.allow(right, name), command
            asked += 1
    assert asked > 10


@every_build
def test_people_may_neither_command_nor_switch_from_a_shell(cell: str, distro: str) -> None:
    texts, may = build(cell, distro).texts, _typed(cell, distro)
    for name, one in contract_data(texts["contract.json"])["interfaces"].items():
        assert one["kind"] != "action" or not may.allow("call", name), name
        assert one["kind"] != "topic" or not may.allow("publish", name) or name in ("/rosout", "/parameter_events")
    for namespace, _ in written_managers(cell, distro):
        for service in ("switch_controller", "set_hardware_component_state", "load_controller", "set_parameters"):
            assert not may.allow("request", f"{namespace}/controller_manager/{service}")


_CALLED_BY_BRING_UP: dict[str, tuple[str, ...]] = {
    "controller": ("list_controllers",),
    "hardware": ("list_hardware_components",),
    "lifecycle": ("get_state",),
}
"""What a proof asks its manager or node, and below what a request calls: controller_manager 4.47, lifecycle_msgs."""
_REQUESTED_BY_BRING_UP: dict[str, tuple[str, ...]] = {
    "controllers": ("list_controllers", "switch_controller"),
    "restart": ("list_controllers", "switch_controller"),
    "hardware": ("set_hardware_component_state",),
    "transition": ("change_state",),
}


@every_build
def test_bring_up_may_call_what_its_steps_ask(cell: str, distro: str) -> None:
    steps, asked = plan(cell, distro), set()
    may = permissions(build(cell, distro).texts)[steps["enclave"]]
    for step in (*proven(steps, "mock"), *proven(steps, "real")):
        proofs = (*step["proof"], *step.get("effect", ()))
        ends = [(proof, _CALLED_BY_BRING_UP.get(proof["kind"], ())) for proof in proofs]
        if "request" in step:
            ends.append((step["request"], _REQUESTED_BY_BRING_UP.get(step["request"]["kind"], ())))
        for one, services in ends:
            asked |= {f"{one['manager'] if 'manager' in one else one['node']}/{name}" for name in services}
    assert asked
    assert not [name for name in asked if not may.allow("request", name)]


_ACTS = re.compile(r"ros2 service call (/\S+)|ros2 control (switch_controller|set_hardware_component_state)")


@every_build
def test_a_person_may_act_where_a_gate_or_a_recovery_says_so(cell: str, distro: str) -> None:
    texts, may = build(cell, distro).texts, _typed(cell, distro, "commissioning")
    pages = " ".join(" ".join(texts[page].split()) for page in ("gates/promotion.md", "gates/network.md", "audit.md"))
    found = list(_ACTS.finditer(pages))
    claiming = any(step["phase"] == "claim" for step in plan(cell, distro)["real"])
    assert ("switch_controller" in {finding[2] for finding in found}) is claiming
    assert cell == "minimal" or any((finding[1] or "").endswith("/cancel_goal") for finding in found)
    for one in found:
        managers = [f"{namespace}/controller_manager/{one[2]}" for namespace, _ in written_managers(cell, distro)]
        for name in [one[1]] if one[1] else managers:
            assert may.allow("request", name), name


@pytest.mark.parametrize("distro", ["humble", "jazzy"])
def test_a_person_may_call_what_the_vendor_of_an_arm_has_people_call(distro: str) -> None:
    # franka_ros2 2.5.0 and 3.4.0: recovery from a reflex, homing of the hand, thresholds before a claim.
    may = _typed("fr3_hand", distro, "commissioning")
    assert may.allow("call", "/action_server/error_recovery")
    assert may.allow("call", "/hand_gripper/homing")
    assert may.allow("request", "/service_server/set_full_collision_behavior")
    assert not may.allow("call", "/action_server/ptp_motion")
    assert not may.allow("call", "/hand_gripper/grasp")


@every_build
def test_who_acts_in_a_gate_sends_no_goal_to_a_controller_and_says_nothing(cell: str, distro: str) -> None:
    texts, may = build(cell, distro).texts, _typed(cell, distro, "commissioning")
    for name, one in contract_data(texts["contract.json"])["interfaces"].items():
        assert one["kind"] != "action" or not may.allow("request", f"{name}/_action/send_goal"), name
        assert one["kind"] != "topic" or not may.allow("publish", name) or name in ("/rosout", "/parameter_events")
    for namespace, _ in written_managers(cell, distro):
        for service in ("load_controller", "unload_controller", "set_parameters"):
            assert not may.allow("request", f"{namespace}/controller_manager/{service}")


@every_build
def test_rviz_may_show_what_its_configuration_shows(cell: str, distro: str) -> None:
    texts, may = build(cell, distro).texts, _typed(cell, distro)
    topics = re.findall(r"^ +(?:Value|[A-Z]\w+(?: \w+)* Topic): (/\S+)$", texts["config/cell.rviz"], re.MULTILINE)
    assert "/robot_description" in topics
    for topic in (*topics, "/tf", "/tf_static", "/clock", "/parameter_events"):
        assert may.allow("subscribe", topic), topic
    # moveit2, planning_scene_display.cpp: the whole scene is asked for once.
    assert "/monitored_planning_scene" not in topics or may.allow("request", "/get_planning_scene")
    for name in ("/rviz/reset_time", "/rviz/get_parameters", "/rviz_private_94213/list_parameters"):
        assert may.allow("reply", name) or (
            name.startswith("/rviz_private") and "/monitored_planning_scene" not in topics
        )
