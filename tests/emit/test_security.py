"""The security policy against its schema, and who may command what."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest
import xmlschema

from tests.cells import DISTROS
from tests.consumers.permissions import policy_of, policy_text
from tests.emit.cells import CELLS, artifacts_of
from tests.oracles import UPSTREAM, needs_upstream


def _policy(cell: str, distro: str = "jazzy") -> ElementTree.Element:
    return policy_of(artifacts_of(cell, distro))


def _holders(policy: ElementTree.Element, plural: str, right: str, name: str) -> set[str]:
    """Return the nodes that hold a right on an absolute name."""
    return {
        profile.attrib["node"]
        for profile in policy.iter("profile")
        for entries in profile.findall(f"{plural}[@{right}='ALLOW']")
        for entry in entries
        if entry.text == name
    }


@needs_upstream
@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize("cell", CELLS)
def test_policy_is_what_sros2_declares(cell: str, distro: str) -> None:
    folder = UPSTREAM / "xsd"
    schema = xmlschema.XMLSchema(
        folder / "sros2_policy.xsd", locations={"http://www.w3.org/XML/1998/namespace": str(folder / "xml.xsd")}
    )
    schema.validate(policy_text(artifacts_of(cell, distro)))


def test_only_declared_clients_may_call_an_action() -> None:
    policy = _policy("ur5e_pick")
    action = "/arm_trajectory/follow_joint_trajectory"
    # Beside the client of the spec, what a person starts once in gate G7, in an enclave of its own.
    assert _holders(policy, "actions", "call", action) == {"move_group", "first_goal"}
    assert _holders(policy, "actions", "execute", action) == {"arm_trajectory"}
    assert _holders(policy, "actions", "call", "/gripper_action/gripper_cmd") == {"task"}


def test_a_person_may_call_what_the_vendor_has_people_call_and_nothing_else() -> None:
    """A UR without remote control is unlocked at its pendant; an FR3 recovers by the action of its driver."""
    of_people = _commissioning("ur5e_pick")
    assert not {name for name in _named(of_people, "services", "request") if name.startswith("/arm_dashboard_client/")}
    of_people = _commissioning("fr3_hand")
    recovery = {name for name in _named(of_people, "actions", "call") if name.endswith("/action_server/error_recovery")}
    assert len(recovery) == 1
    servers = {name for name in _named(of_people, "services", "request") if "/service_server/" in name}
    # Its commissioning in the catalog sets the collision thresholds by hand, and nothing else of that server.
    assert {name.rpartition("/")[2] for name in servers} == {"set_full_collision_behavior"}


def _commissioning(cell: str) -> ElementTree.Element:
    (enclave,) = (each for each in _policy(cell).iter("enclave") if each.attrib["path"] == f"/{cell}/commissioning")
    return enclave


def _named(enclave: ElementTree.Element, plural: str, right: str) -> set[str]:
    return {entry.text or "" for entries in enclave.iter(plural) if right in entries.attrib for entry in entries}


def test_only_declared_sources_may_publish() -> None:
    policy = _policy("ur5e_pick")
    assert _holders(policy, "topics", "publish", "/object_pose") == {"perception"}
    assert _holders(policy, "topics", "publish", "/joint_states") == {"joint_states"}
    assert _holders(policy, "topics", "publish", "/tf_static") == {"robot_state_publisher"}
    # Nobody holds the bare topic past the action: a trajectory without accept, cancel and result.
    assert _holders(policy, "topics", "publish", "/arm_trajectory/joint_trajectory") == set()


def test_only_the_bring_up_may_switch_controllers() -> None:
    policy = _policy("ur5e_pick")
    holders = _holders(policy, "services", "request", "/controller_manager/switch_controller")
    # The names that the one program gives its node; and a person, who gives claims back where a recovery says so.
    acting = policy.find("enclaves/enclave[@path='/ur5e_pick/commissioning']")
    assert acting is not None
    holders -= {profile.attrib["node"] for profile in acting.iter("profile")}
    assert holders == {*(f"bring_up_{phase}" for phase in ("start", "activate", "claim", "move")), "claim_watch"}
    assert _holders(policy, "services", "reply", "/controller_manager/switch_controller") == {"controller_manager"}


def test_nothing_is_allowed_by_wildcard_and_enclaves_are_unique() -> None:
    policy = _policy("ur5e_pick")
    assert [entry.text for entry in policy.iter() if entry.text and "*" in entry.text] == []
    # A name that differs at every start opens nothing but what lies below it.
    changing = [profile for profile in policy.iter("profile") if "*" in profile.attrib["node"]]
    assert {name.attrib["node"].rstrip("*") for name in changing} == {
        *("move_group_private_", "moveit_", "transform_listener_impl_", "_ros2cli_", "tf2_monitor"),
        *("rviz_private_", "rviz_ssp_"),
    }
    paths = [enclave.attrib["path"] for enclave in policy.iter("enclave")]
    assert len(paths) == len(set(paths))
    assert all(path.startswith("/ur5e_pick/") for path in paths)


def test_controllers_live_in_the_enclave_of_their_process() -> None:
    (process,) = [e for e in _policy("ur5e_pick").iter("enclave") if e.get("path") == "/ur5e_pick/controller_manager"]
    assert [profile.get("node") for profile in process.iter("profile")] == [
        "controller_manager",
        "joint_states",
        "arm_trajectory",
        "gripper_action",
        "arm_speed",
        "arm_io",
        "arm_tcp",
        "arm_software",
        "arm_hardware",
        "gripper_hardware",
    ]


@pytest.mark.parametrize("cell", CELLS)
def test_every_launched_process_has_an_enclave_of_the_policy(cell: str) -> None:
    declared = {enclave.get("path") for enclave in _policy(cell).iter("enclave")}
    launch = ElementTree.fromstring(artifacts_of(cell)["launch/cell.launch.xml"])
    used = [node.attrib["ros_args"].removeprefix("--enclave ") for node in launch.iter("node")]
    assert set(used) <= declared


def test_hardware_has_no_node_on_humble() -> None:
    nodes = {profile.get("node") for profile in _policy("ur5e_pick", "humble").iter("profile")}
    assert "arm_hardware" not in nodes
    assert "controller_manager" in nodes


def test_rviz_asks_for_the_planning_scene_of_a_cell_that_plans() -> None:
    """rviz_default_plugins shows the robot; moveit_rviz_plugin's PlanningScene asks move_group for the whole scene."""
    for cell, plans in (("ur5e_pick", True), ("minimal", False)):
        profiles = [each for each in _policy(cell).iter("profile") if each.attrib["node"] == "rviz"]
        assert len(profiles) == 2  # of the operator and of commissioning
        for profile in profiles:
            assert "/robot_description" in _named(profile, "topics", "subscribe")
            assert ("/monitored_planning_scene" in _named(profile, "topics", "subscribe")) is plans
            assert ("/get_planning_scene" in _named(profile, "services", "request")) is plans
