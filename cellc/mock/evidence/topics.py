"""Which topics a bag holds: names, types and profiles of the contract, and names of our own for what ROS has none for.

Goals of actions travel in a hidden service that no bag records; they and the attempt records stand under ``/cellc``,
where a player that repeats the bag commands nothing.
"""

from __future__ import annotations

from dataclasses import replace

from cellc.contract.contract import Contract
from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.contract.qos import DEFAULT
from cellc.mock.evidence.bag.bag_file import LATCHED
from cellc.mock.evidence.bag.messages import (
    CLOCK,
    CONTROLLER_STATE,
    DIAGNOSTIC_ARRAY,
    JOINT_STATE,
    JOINT_TRAJECTORY,
    POSE_STAMPED,
    STRING,
    TF_MESSAGE,
)
from cellc.mock.nodes.robot_state_publisher import NODE


@dataclass(frozen=True, slots=True)
class BagTopic:
    """A topic of a bag."""

    name: str
    kind: str
    qos: Qos


ATTEMPTS = BagTopic("/cellc/attempts", STRING, replace(LATCHED, history="keep_all"))
LOG = "/cellc/log"
"""Where `cellc mock --live` tells faults and outcomes in words; no bag has it."""
CLOCK_TOPIC = BagTopic("/clock", CLOCK, replace(DEFAULT, reliability="best_effort", depth=1))
"""rclcpp/qos.hpp, ClockQoS."""
DIAGNOSTICS = BagTopic("/diagnostics", DIAGNOSTIC_ARRAY, DEFAULT)


def description_topic(contract: Contract) -> BagTopic:
    """Return the topic of the robot description."""
    return BagTopic("/robot_description", STRING, _qos(contract, "/robot_description", NODE, LATCHED))


def static_transforms_topic(contract: Contract) -> BagTopic:
    """Return the topic of fixed edges."""
    return BagTopic("/tf_static", TF_MESSAGE, _qos(contract, "/tf_static", NODE, LATCHED))


def transforms_topic(contract: Contract) -> BagTopic:
    """Return the topic of moving edges."""
    fallback = replace(DEFAULT, depth=100)  # tf2_ros/qos.hpp, DynamicBroadcasterQoS
    return BagTopic("/tf", TF_MESSAGE, _qos(contract, "/tf", NODE, fallback))


def joint_states_topic(contract: Contract, manager: str, broadcaster: str) -> BagTopic:
    """Return the topic of a joint state broadcaster."""
    for name, interface in contract.interfaces.items():
        for source in interface.sources:
            if interface.type == JOINT_STATE and source.node == broadcaster:
                return BagTopic(name, JOINT_STATE, source.qos)
    return BagTopic(_in_namespace(contract, manager, "joint_states"), JOINT_STATE, _of_broadcasters(contract))


def controller_state_topic(contract: Contract, manager: str, controller: str) -> BagTopic:
    """Return the topic on which a trajectory controller publishes its state, `~/controller_state`."""
    name = f"{contract.managers[manager].controllers[controller].full_name}/controller_state"
    return BagTopic(name, CONTROLLER_STATE, _of_broadcasters(contract))


def goal_topic(controller: str, *, gripper: bool) -> BagTopic:
    """Return the topic of the goals of a controller, as they were sent.

    The contract calls a controller by its full name where several managers have one of its name.
    """
    name = f"/cellc/{controller.removeprefix('/')}/goal"
    return BagTopic(name, JOINT_STATE if gripper else JOINT_TRAJECTORY, DEFAULT)


def pose_topic(contract: Contract, frame: str) -> BagTopic | None:
    """Return the topic on which a dynamic frame's publisher states its pose; None where there is only /tf."""
    entry = contract.frames[frame]
    for name, interface in sorted(contract.interfaces.items()):
        for source in interface.sources:
            if (interface.type, interface.frame, source.node) == (POSE_STAMPED, entry.parent, entry.authority):
                return BagTopic(name, POSE_STAMPED, source.qos)
    return None


def _of_broadcasters(contract: Contract) -> Qos:
    """Return the profile of all publishers of ros2_controllers: SystemDefaults, as the contract resolved it."""
    publishing = (each for each in contract.interfaces.values() if each.type == JOINT_STATE and each.sources)
    return next((each.sources[0].qos for each in publishing), LATCHED)


def _qos(contract: Contract, topic: str, node: str, fallback: Qos) -> Qos:
    interface = contract.interfaces.get(topic)
    sources = () if interface is None else interface.sources
    return next((source.qos for source in sources if source.node == node), fallback)


def _in_namespace(contract: Contract, manager: str, name: str) -> str:
    # What is behind an adapter has no manager, and states its topics in full.
    namespace = contract.managers[manager].namespace.strip("/") if manager in contract.managers else ""
    return f"/{namespace}/{name}" if namespace else f"/{name}"
