"""The closed lists of words that catalog, contract, compiler and mock share, each declared here and nowhere else.

Members are strings with the text that is in YAML, JSON and messages. What differs between distributions is a
feature in one table: code asks `Feature.X in features(distro)` and compares with no distribution's name.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Final, Literal

UNKNOWN: Final = "UNKNOWN"
"""The answer of a person who does not guess; it blocks the real target and is in the audit."""


class Term(str, Enum):
    """A word of a closed list; it prints as the text that it means."""

    __str__ = str.__str__


class Distro(Term):
    """A ROS 2 distribution, in the order of release."""

    HUMBLE = "humble"
    JAZZY = "jazzy"
    KILTED = "kilted"
    LYRICAL = "lyrical"


class Feature(Enum):
    """What some distributions have and others have not."""

    STATIC_PEERS = "discovery is set by ROS_AUTOMATIC_DISCOVERY_RANGE and ROS_STATIC_PEERS"
    FAST_DDS_3 = "Fast DDS 3, whose profiles have a namespace of their own"
    TYPE_DESCRIPTION = "every node serves get_type_description"
    LOGGER_SERVICES = "controllers serve get_logger_levels and set_logger_levels"
    CLEANUP_CONTROLLER = "the controller manager serves cleanup_controller"
    HARDWARE_NODES = "every hardware component has a node"
    DESCRIPTION_TOPIC = "the controller manager takes the robot description from a topic, not from a parameter"
    LIMITED_COMMANDS = "the controller manager can enforce the joint limits of the description"
    LIMITED_BY_DEFAULT = "it does so by default"
    PREEMPTED_GOALS = "a trajectory controller calls a replaced goal preempted, not canceled"
    TRAJECTORIES_END_AT_REST = "a trajectory must end with zero velocity by default"
    SCALED_STATE = "JointTrajectoryControllerState has the speed scaling factor in place of desired and actual"
    PLUGIN_LISTS = "MoveIt takes planning plugins and their adapters as lists"
    EXIT_ENDS_LAUNCH = 'launch XML knows `on_exit="shutdown"`'
    SERVICE_INFO = "`ros2 service info` counts the clients and servers of a service"
    CONTROLLER_ARGUMENTS = "the spawner hands controllers their remaps; those of the manager are deprecated"
    RECORD_TOPICS_OPTION = "`ros2 bag record` takes the topics after --topics"


_SINCE: Mapping[Feature, Distro] = {
    Feature.STATIC_PEERS: Distro.JAZZY,
    Feature.FAST_DDS_3: Distro.KILTED,
    Feature.TYPE_DESCRIPTION: Distro.JAZZY,
    Feature.LOGGER_SERVICES: Distro.JAZZY,
    Feature.CLEANUP_CONTROLLER: Distro.JAZZY,
    Feature.HARDWARE_NODES: Distro.JAZZY,
    Feature.DESCRIPTION_TOPIC: Distro.JAZZY,
    Feature.LIMITED_COMMANDS: Distro.JAZZY,
    Feature.LIMITED_BY_DEFAULT: Distro.KILTED,
    Feature.PREEMPTED_GOALS: Distro.JAZZY,
    Feature.EXIT_ENDS_LAUNCH: Distro.JAZZY,  # ros2/launch pull request 751
    Feature.TRAJECTORIES_END_AT_REST: Distro.JAZZY,
    Feature.SCALED_STATE: Distro.JAZZY,
    Feature.PLUGIN_LISTS: Distro.JAZZY,
    Feature.SERVICE_INFO: Distro.JAZZY,  # ros2/ros2cli pull request 771
    Feature.CONTROLLER_ARGUMENTS: Distro.JAZZY,  # ros2_control 4.46.0, controller_manager.cpp:4923
    Feature.RECORD_TOPICS_OPTION: Distro.JAZZY,
}
"""The first distribution with each feature; all later ones have it too."""

_ORDER = tuple(Distro)
_FEATURES: Mapping[Distro, frozenset[Feature]] = {
    distro: frozenset(one for one, first in _SINCE.items() if _ORDER.index(first) <= _ORDER.index(distro))
    for distro in Distro
}


def features(distro: Distro) -> frozenset[Feature]:
    """Return what a distribution has."""
    return _FEATURES[distro]


class InterfaceKind(Term):
    """The three interactions of ROS 2."""

    TOPIC = "topic"
    SERVICE = "service"
    ACTION = "action"


class Behavior(Term):
    """What a controller does: the kinds of the catalog, and the variants that one plugin or one device has."""

    JOINT_TRAJECTORY = "joint_trajectory"
    SCALED_JOINT_TRAJECTORY = "scaled_joint_trajectory"
    PARALLEL_GRIPPER = "parallel_gripper"
    POSITION_GRIPPER = "position_gripper"
    FORWARD_COMMAND = "forward_command"
    MULTI_INTERFACE_FORWARD_COMMAND = "multi_interface_forward_command"
    GPIO_COMMAND = "gpio_command"
    PID = "pid"
    JOINT_STATE_BROADCASTER = "joint_state_broadcaster"
    FORCE_TORQUE_SENSOR_BROADCASTER = "force_torque_sensor_broadcaster"
    BROADCASTER = "broadcaster"
    SERVICE = "service"
    OWN_MOTION = "own_motion"
    """A device moves, or lets itself be moved, past its joints' interfaces: force control, hand guiding."""


TRAJECTORIES = frozenset({Behavior.JOINT_TRAJECTORY, Behavior.SCALED_JOINT_TRAJECTORY})
"""They take FollowJointTrajectory goals."""

PASSIVE = frozenset({Behavior.BROADCASTER, Behavior.SERVICE})
"""They command no joint: such a kind of a device publishes what the hardware reports, or answers services."""

OF_ONE_DEVICE = PASSIVE | {Behavior.OWN_MOTION}
"""They act as no neutral kind: such a kind of a device says itself what it claims, reads, publishes and serves."""


class AttemptOutcome(Term):
    """How an attempt ends; each failure is distinguished from every other."""

    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    STALE_STATE = "stale_state"
    TF_FAILURE = "tf_failure"
    PLANNING_FAILURE = "planning_failure"
    GOAL_REJECTION = "goal_rejection"
    TOLERANCE_VIOLATION = "tolerance_violation"
    GRIP_FAILURE = "grip_failure"
    """Nothing, or the wrong part, is between the fingers that closed; the part is lost, or let go of in the air."""
    MISSED_CYCLE = "missed_cycle"
    PROTECTIVE_STOP = "protective_stop"
    EMERGENCY_STOP = "emergency_stop"
    HARDWARE_FAULT = "hardware_fault"
    WRONG_OWNER = "wrong_owner"
    CLAIM_FAILURE = "claim_failure"
    UNCOMMANDED_MOTION = "uncommanded_motion"
    TIMEOUT = "timeout"


class Moment(Term):
    """When a device may act in the world: a step of its hardware component, or what its own controller does."""

    START = "start"
    """A process of its driver starts."""
    INIT = "init"
    CONFIGURE = "configure"
    ACTIVATE = "activate"
    CLAIM = "claim"
    """A controller that commands it becomes active."""
    RELEASE = "release"
    DEACTIVATE = "deactivate"
    CLEANUP = "cleanup"
    PROGRAM_START = "program_start"
    """The program on the device's own controller, through which set points pass, begins or goes on."""
    PROGRAM_STOP = "program_stop"
    PROGRAM_PAUSE = "program_pause"
    """The program keeps its place: by a person at the device, or because the device stops."""
    PROGRAM_RESUME = "program_resume"
    """A paused program goes on from where it was."""
    STOP = "stop"
    """The device stops by itself: a reflex, a protective stop, an emergency stop."""
    POWER_LOST = "power_lost"
    """The device loses its supply, as at an emergency stop that switches the supply off."""
    LINK_LOST = "link_lost"
    """The cable or network between the device and its computer carries nothing any more."""
    RECONNECT = "reconnect"
    """It carries again."""


class LeftBy(Term):
    """What ends a stop of a device once its cause is gone, and so what may bring motion back."""

    ITSELF = "itself"
    """No person acts: a door closes, and the device continues."""
    PERSON = "person"
    """A person acknowledges at the device or by its service, and it goes on."""
    ACTIVATION = "activation"
    """The driver starts, or activates its component, again; until then nothing follows a set point."""


class Motion(Term):
    """What moves at a moment, from the least to the worst."""

    NONE = "none"
    """Nothing; the device commands what it commanded before, or nothing."""
    HOLDS = "holds"
    """It holds where it is measured, and follows set points from then on."""
    MOVES = "moves"
    """It moves by itself, on a path that no set point asked for."""
    JUMPS = "jumps"
    """It goes immediately to set points that were kept from before, wherever it was moved meanwhile."""
    FALLS = "falls"
    """It is held by nothing."""
    UNKNOWN = "unknown"


class CommandAuthority(Term):
    """What a moment does to who may command the device."""

    UNCHANGED = "unchanged"
    TAKEN = "taken"
    GIVEN_BACK = "given_back"
    UNKNOWN = "unknown"


class ManagerLock(Term):
    """For how long a moment keeps the controller manager from reading and writing all of its hardware."""

    NONE = "none"
    SECONDS = "seconds"
    """Seconds, or without a limit."""
    UNKNOWN = "unknown"


class Need(Term):
    """What must hold before a moment; people, or the device's own controller, bring it about."""

    BRAKES_OPEN = "brakes_open"
    INTERFACE_ENABLED = "interface_enabled"
    """A person has set the device to accept commands from a computer."""
    PROGRAM_RUNNING = "program_running"
    PROGRAM_STOPPED = "program_stopped"
    """No program waits for set points that would be late."""
    NOT_PAUSED = "not_paused"
    """The program on the device's own controller does not pause."""
    NO_STOP = "no_stop"
    """The safety functions of the device do not stop it."""
    NO_FAULT = "no_fault"
    AREA_EMPTY = "area_empty"
    NOTHING_HELD = "nothing_held"
    PAYLOAD_TOLD = "payload_set"
    HOMED = "homed"


class Unmet(Term):
    """What becomes of a moment whose need does not hold."""

    REFUSED = "refused"
    """It fails, and everything is as before."""
    ENDS_MANAGER = "ends_manager"
    """The process of the controller manager ends."""
    ENDS_PROGRAM = "ends_program"
    """A program on a device's own controller ends, because set points are late."""
    KEEPS_SET_POINTS = "keeps_set_points"
    """It succeeds, and the set points of that moment are sent whenever the need is met."""
    CLEARS_FAULT = "clears_fault"
    """The driver clears the fault without asking anybody, and goes on."""
    UNNOTICED = "unnoticed"
    """It succeeds as if the need were met."""
    UNKNOWN = "unknown"


class Loop(Term):
    """What holds the joints of a real device at what they are commanded."""

    POSITION = "position"
    """A position loop of the device's own, whatever the joints carry."""
    SPRING = "spring"
    """A torque for each rad from the command: a load moves the joint."""
    UNKNOWN = "unknown"


class Gravity(Term):
    """Who holds joints behind springs against gravity."""

    SPRING = "spring"
    """The springs alone: the arm droops under its own weight."""
    COMPENSATED = "compensated"
    """The device, for its own links and the payload that it is set to; the springs hold what differs from that."""


class Held(Term):
    """What stays in force when a goal is canceled or aborted."""

    MEASURED = "measured"
    """Where the joints are: behind springs, they sink once more by as much."""
    COMMANDED = "commanded"
    """The last set point."""


class BringUpPhase(Term):
    """What is released together in a bring-up: by the launch file on the mock, each by a person on the real target."""

    START = "start"
    ACTIVATE = "activate"
    CLAIM = "claim"
    MOVE = "move"


class GateCode(Term):
    """A gate of bring-up: G from the powered-off manifest to motion, L from the cable to the command path."""

    G0 = "G0"
    G1 = "G1"
    G2 = "G2"
    G3 = "G3"
    G4 = "G4"
    G5 = "G5"
    G6 = "G6"
    G7 = "G7"
    L1 = "L1"
    L2 = "L2"
    L3 = "L3"
    L4 = "L4"
    L5 = "L5"
    L6 = "L6"
    S2 = "S2"
    """The checklist of every interface: a late sample, a missing responder, a canceled goal."""


PROMOTION_GATES = tuple(code for code in GateCode if code.startswith("G"))
"""Gates of the first bring-up, in order."""
NETWORK_GATES = tuple(code for code in GateCode if code.startswith("L"))
"""Gates from layer to layer of a cell that runs, in order."""
GATE_ORDER = (*PROMOTION_GATES[:3], *NETWORK_GATES, *PROMOTION_GATES[3:])
"""All gates as they are passed: the network (G3) layer by layer."""


ApprovalArea = Literal["graph", "time_tf", "controller", "vendor", "network", "safety", "data"]
"""Area of `owners.approvals`: who approves changes of it."""

RobotSetting = Literal[
    "payload", "tcp", "load", "thresholds", "joint_impedance", "tool_impedance", "tool_voltage", "first_motion"
]
"""What a gate has set, checked or tried in the controller of a robot."""


class Grade(Term):
    """How a change of a cell is taken by who reviews it, from the least to the most."""

    SAFE = "safe"
    """It lets nothing move faster, further or with less watching than before, and takes nothing from a consumer."""
    REVIEW = "review"
    """The owner of its approval area reads it."""
    DANGEROUS = "dangerous"
    """Something may move otherwise than people at the cell expect, or a protection is weaker than it was."""


class ReviewArea(Term):
    """What a change of a cell concerns: of one grade, what protects and moves is read before versions and texts."""

    SAFETY = "safety"
    LIMITS = "limits"
    CONTROL = "control"
    FRAMES = "frames"
    CALIBRATION = "calibration"
    PAYLOAD = "payload"
    MODEL = "model"
    MOTION = "motion"
    START_ORDER = "start order"
    DEVICES = "devices"
    TIME = "time"
    INTERFACES = "interfaces"
    QOS = "QoS"
    NETWORK = "network"
    GATES = "gates"
    VERSIONS = "versions"
    REHEARSALS = "rehearsals"
    OWNERS = "owners"
    FIGURES = "figures"
    DOCUMENTS = "documents"
    """Texts of the package that no other area explains."""
