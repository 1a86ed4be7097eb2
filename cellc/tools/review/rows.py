"""Each kind of value that a package holds, and how a change of it is graded.

The first row whose pattern fits a path counts. A part of a pattern in braces means any name, and the names are the
subject; `...` at the end represents whatever follows.
"""

from __future__ import annotations

from collections.abc import Sequence

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Frame, SharedArea
from cellc.compiler.cell.interface import Node
from cellc.compiler.cell.site import Bringup, Host, Safety
from cellc.contract.bring_up import BringUpStep
from cellc.contract.contract import Contract, ContractController, ContractManager
from cellc.contract.entities import ContractEndpoint, ContractInterface
from cellc.contract.grading import (
    DEVIATES,
    FASTER,
    FURTHER,
    GRIPPED,
    OTHER_LOAD,
    OTHER_MASS,
    PLANNED,
    UNAVOIDED,
    Graded,
    Rule,
)
from cellc.contract.rehearsals import RehearsalEntry
from cellc.contract.stated import Network
from cellc.contract.vocabulary import ApprovalArea, ReviewArea
from cellc.tools.review.graded import rows_of
from cellc.tools.review.reasons import with_reason
from cellc.tools.review.rules import HANDED, Row

_A = ReviewArea

_LAW = "contract devices {device} law"
_YIELDS = "the joint yields by another amount, or swings"
_MOVE_GROUP = "file config/moveit/move_group.yaml {_} ros__parameters"
_STRAIGHT = "robot_description_planning.cartesian_limits"
_BURNS = "a tool for another voltage fails, or is destroyed"
_UNREADY = "it is not the first motion that people are ready for"
_MEET = "arms may meet in it"
_STARTS = "somebody else, or a program, starts what moves"
_ANSWERS = "somebody else is responsible for what stops the motion"
_OTHER_POINT = "every goal is reached with another point"
_OTHER = "another device may answer at this address"
_VENDOR: tuple[ApprovalArea, ...] = ("vendor",)


def _first(what: str, rule: Rule, unit: str = "") -> Graded:
    """Return how a value of the first motion is graded: less of it is safe."""
    return Graded(_A.SAFETY, f"first motion {what}".rstrip(), rule, unit, ordered=False, why=_UNREADY)


_DECLARED: Sequence[Row] = tuple(
    row
    for kind, pattern in (
        (ContractInterface, "interface {interface}"),
        (ContractEndpoint, "interface {interface} {end} {node}"),
        (ContractController, "controller {controller}"),
        (ContractManager, "manager {manager}"),
        (BringUpStep, "step real {step}"),
        (RehearsalEntry, "rehearsals {rehearsal}"),
        (Contract, "contract"),
        (Safety, "spec safety"),
        (Bringup, "spec bringup"),
        (Network, "spec network"),
        (Host, "spec hosts {host}"),
        (Node, "spec nodes {node}"),
        (SharedArea, "area {area}"),
        (Frame, "frame {frame}"),
        (Device, "device {device}"),
    )
    for row in rows_of(kind, pattern)
)
"""What fields declare beside their meaning: `Graded` in the models of contract/ and the entities of a cell."""

_ALL: Sequence[Row] = (
    Row("contract approvals safety", Graded(_A.SAFETY, "approver of safety changes", Rule.DANGEROUS)),
    *(
        Row(f"contract responsibilities {name}", Graded(_A.SAFETY, f"{HANDED}{what}", Rule.DANGEROUS, why=_ANSWERS))
        for name, what in (("physical_stop", "the physical stop"), ("vendor_safety", "the vendor's safety functions"))
    ),
    Row(
        f"{_LAW} joints {{joint}} stiffness",
        Graded(_A.CONTROL, "stiffness of the joint", Rule.DANGEROUS, "stiffness", why=_YIELDS),
    ),
    Row(
        f"{_LAW} joints {{joint}} damping",
        Graded(_A.CONTROL, "damping of the joint", Rule.DANGEROUS, "damping", why=_YIELDS),
    ),
    Row(f"{_LAW} joints {{joint}} ...", Graded(_A.CONTROL, "gain of the joint:", Rule.DANGEROUS, why=_YIELDS)),
    Row(f"{_LAW} part mass_kg", Graded(_A.CONTROL, "mass that its control law holds")),
    Row(f"{_LAW} unaccounted", Graded(_A.PAYLOAD, "load that gravity compensation leaves out")),
    Row(f"{_LAW} ...", Graded(_A.CONTROL, "control law of the joints:")),
    Row(
        "contract frames {frame} grasp mass_kg",
        Graded(_A.MOTION, "mass of the part to grip", Rule.HEAVIER, "kg", why=OTHER_MASS),
    ),
    *(
        Row(
            f"contract frames {{frame}} grasp bands {{device}} {end}",
            Graded(_A.MOTION, what, Rule.REVIEW, "joint", why=GRIPPED),
        )
        for end, what in (
            ("lower", "least joint position that holds it"),
            ("upper", "largest joint position that holds it"),
        )
    ),
    *(
        Row(f"spec safety stop {name}", Graded(_A.SAFETY, quantity, Rule.LOST, ordered=False))
        for name, quantity in (
            ("independent_of", "what the stop is independent of"),
            ("evidence", "evidence of the stop"),
        )
    ),
    Row("spec safety recovery states", Graded(_A.SAFETY, "states that need recovery", Rule.LOST, ordered=False)),
    Row("spec safety recovery owner", Graded(_A.SAFETY, f"{HANDED}the recovery", Rule.NAMED)),
    Row("spec safety recovery observer", Graded(_A.SAFETY, "recovery observer", Rule.NAMED)),
    *_DECLARED,
    # What stops, and what happens then.
    Row("area {area} {what}", Graded(_A.SAFETY, "shared area", Rule.DANGEROUS, why=_MEET)),
    Row("watch {watch} ...", Graded(_A.SAFETY, "watch that deactivates controllers", Rule.DANGEROUS, ordered=False)),
    Row("check payload {device} {what}", Graded(_A.PAYLOAD, "robot payload", Rule.LOAD, why=OTHER_LOAD)),
    Row(
        "check tcp {device} {what}",
        Graded(_A.PAYLOAD, "robot TCP", Rule.TOOL, why=_OTHER_POINT),
    ),
    Row("check thresholds {device}", Graded(_A.SAFETY, "collision thresholds set in the robot", Rule.DANGEROUS)),
    Row("check load {device}", Graded(_A.PAYLOAD, "load set in the robot", Rule.LOAD, why=OTHER_LOAD)),
    Row("check joint_impedance {device}", Graded(_A.SAFETY, "impedance of the joints", Rule.DANGEROUS)),
    Row("check tool_impedance {device}", Graded(_A.SAFETY, "impedance at the tool", Rule.DANGEROUS)),
    Row("check tool_voltage {device} {what}", Graded(_A.SAFETY, "tool connector", Rule.DANGEROUS, why=_BURNS)),
    Row("spec program {device} mode", Graded(_A.SAFETY, "mode for the program", Rule.DANGEROUS, why=_STARTS)),
    Row("spec program {device} played_by", Graded(_A.SAFETY, "who starts the program", Rule.DANGEROUS, why=_STARTS)),
    Row("spec surroundings {part} none", Graded(_A.SAFETY, "reason why there is nothing", Rule.RESTATED)),
    Row("spec surroundings {part} open {what}", Graded(_A.SAFETY, "open question on the surroundings")),
    Row("spec surroundings {part} ...", Graded(_A.SAFETY, "what is stated around the arms", Rule.LOST, ordered=False)),
    # What a camera sees.
    Row("camera {device} range {what}", Graded(_A.DEVICES, "range of")),
    Row("camera {device} view {what}", Graded(_A.DEVICES, "field of view of")),
    Row("camera {device} resolution {what}", Graded(_A.DEVICES, "resolution of")),
    Row("camera {device} images {stream} {what}", Graded(_A.INTERFACES, "images:")),
    # Frames and what measured them.
    Row("placement {frame}", Graded(_A.FRAMES, "pose in its parent", Rule.PLACED)),
    Row(
        "file config/frames.yaml calibrations {calibration} residual_m",
        Graded(_A.CALIBRATION, "residual", Rule.MEASURED, "m"),
    ),
    Row("file config/frames.yaml calibrations {calibration} {what}", Graded(_A.CALIBRATION, "measurement")),
    # What moves, and how far.
    Row(
        "real joint {joint} limit effort",
        Graded(
            _A.LIMITS, "effort", Rule.MORE, "effort", why="the joint may press harder than people at the cell expect"
        ),
    ),
    *(
        Row(f"real joint {{joint}} limit {end}", Graded(_A.LIMITS, f"{end} position", rule, "joint", why=FURTHER))
        for end, rule in (("lower", Rule.LESS), ("upper", Rule.MORE))
    ),
    Row("real joint {joint} limit velocity", Graded(_A.LIMITS, "velocity", Rule.MORE, "joint/s", why=FASTER)),
    Row("spec recording topics", Graded(_A.FIGURES, "recording topics", Rule.ADDED, ordered=False)),
    Row("spec recording ...", Graded(_A.FIGURES, "recording")),
    Row("real joint {joint} axis", Graded(_A.MODEL, "axis", Rule.DANGEROUS, why="the joint turns about another axis")),
    Row("real joint {joint} type", Graded(_A.MODEL, "type", Rule.DANGEROUS)),
    Row("real joint {joint} mimic ...", Graded(_A.MODEL, "mimicked joint", Rule.DANGEROUS)),
    Row("real joint {joint} safety ...", Graded(_A.LIMITS, "soft limit")),
    Row("real joint {joint} parent", Graded(_A.MODEL, "parent in the description")),
    Row("real joint {joint} dynamics ...", Graded(_A.MODEL, "friction")),
    Row("real shapes {link} ...", Graded(_A.MODEL, "collision shapes", Rule.COVERED, why=UNAVOIDED)),
    Row("real inertia {link} mass", Graded(_A.MODEL, "mass", unit="kg")),
    Row("real inertia {link} ...", Graded(_A.MODEL, "inertia")),
    Row("real visuals {link} ...", Graded(_A.DOCUMENTS, "looks", Rule.SAFE)),
    Row("pair {links}", Graded(_A.MODEL, "reason why the pair is not checked for collision", why=PLANNED)),
    # Who commands, and by what.
    Row(
        "claim {interface}",
        Graded(_A.CONTROL, "controller that claims it", Rule.CLAIM, why="another controller commands the joint"),
    ),
    Row("controller {controller} {what}", Graded(_A.CONTROL, "controller")),
    Row("manager {manager} {what}", Graded(_A.CONTROL, "controller manager")),
    Row(
        "parameters {_} {node} ros__parameters constraints {joint} trajectory",
        Graded(_A.CONTROL, "path tolerance", Rule.LOOSER, "joint", why=DEVIATES),
    ),
    Row(
        "parameters {_} {node} ros__parameters constraints {joint} goal",
        Graded(_A.CONTROL, "goal tolerance", Rule.LOOSER, "joint", why="the joint may end further from its goal"),
    ),
    Row("parameters {_} {node} ros__parameters goal_tolerance", Graded(_A.CONTROL, "goal tolerance", Rule.LOOSER)),
    Row(
        "parameters {_} {node} ros__parameters enforce_command_limits",
        Graded(_A.LIMITS, "enforcement of command limits", Rule.DANGEROUS),
    ),
    Row(
        "parameters {_} {node} ros__parameters hardware_components_initial_state ...",
        Graded(_A.START_ORDER, "startup state of the hardware", Rule.DANGEROUS, ordered=False),
    ),
    Row(
        "file config/moveit/servo.yaml {_} ros__parameters moveit_servo scale {what}",
        Graded(_A.LIMITS, "largest speed of servoing", Rule.MORE, why=FASTER),
    ),
    *(
        Row(f"parameters {{_}} {{node}} ros__parameters {name}", Graded(_A.NETWORK, "address", asks=_VENDOR))
        for name in ("robot_ip", "address", "port")
    ),
    Row("parameters {_} {node} ros__parameters ...", Graded(_A.CONTROL, "parameter")),
    Row("real hardware {component} plugin", Graded(_A.CONTROL, "hardware plugin", Rule.DANGEROUS)),
    Row("mock hardware {component} plugin", Graded(_A.CONTROL, "hardware plugin of the mock", Rule.DANGEROUS)),
    *(
        Row(
            f"real hardware {{component}} parameters {name}",
            Graded(_A.NETWORK, "address", Rule.DANGEROUS, why=_OTHER, asks=_VENDOR),
        )
        for name in ("robot_ip", "ip_address", "COM_port", "can_interface")
    ),
    *(
        Row(f"real hardware {{component}} parameters {name}", Graded(_A.NETWORK, name.replace("_", " "), asks=_VENDOR))
        for name in ("reverse_ip", "reverse_port", "script_sender_port", "script_command_port", "trajectory_port")
    ),
    Row("real hardware {component} parameters {what}", Graded(_A.CONTROL, "parameter of the hardware")),
    Row("real hardware {component} ...", Graded(_A.CONTROL, "hardware")),
    # Where it goes.
    Row(
        "contract poses {pose} {group} positions",
        Graded(_A.MOTION, "joint positions", unit="joint", why=PLANNED),
    ),
    Row(
        f"{_MOVE_GROUP} {_STRAIGHT.replace('.', ' ')} max_trans_dec",
        Graded(_A.LIMITS, "Cartesian limit", Rule.LESS, why=FASTER),  # it is negative
    ),
    Row(
        f"{_MOVE_GROUP} robot_description_planning ...",
        Graded(_A.LIMITS, "Cartesian limit", Rule.MORE, why=FASTER),
    ),
    Row(f"{_MOVE_GROUP} trajectory_execution ...", Graded(_A.MOTION, "execution")),
    Row(f"{_MOVE_GROUP} ...", Graded(_A.MOTION, "planning", why=PLANNED)),
    # What others rely on.
    # What it is made of, and where it runs.
    Row("matrix {part}", Graded(_A.VERSIONS, "compatibility matrix", Rule.MATRIX)),
    Row("middleware {host} ROS_DOMAIN_ID", Graded(_A.NETWORK, "ROS_DOMAIN_ID", breaking=True)),
    Row("middleware {host} RMW_IMPLEMENTATION", Graded(_A.NETWORK, "middleware", breaking=True)),
    Row("middleware {host} {what}", Graded(_A.NETWORK, "variable")),
    Row("right {enclave} ...", Graded(_A.NETWORK, "right to", ordered=False)),
    Row("spec network ...", Graded(_A.NETWORK, "network")),
    Row("device {device} min_force", Graded(_A.DEVICES, "least grip force", unit="N")),
    Row("device {device} nic", Graded(_A.NETWORK, "network card that it is connected to", asks=_VENDOR)),
    Row("device {device} host", Graded(_A.NETWORK, "computer that it is connected to", asks=_VENDOR)),
    Row("spec hosts {host} ...", Graded(_A.NETWORK, "host")),
    Row("spec nodes {node} owner", Graded(_A.OWNERS, "owner", Rule.NAMED)),
    Row("spec nodes {node} {what}", Graded(_A.CONTROL, "node", asks=("graph",))),
    Row("spec nodes {node} ...", Graded(_A.CONTROL, "parameter of the node")),
    Row("spec targets {target} {what}", Graded(_A.DEVICES, "target", Rule.DANGEROUS)),
    Row("spec mock_statements ...", Graded(_A.SAFETY, "statement that it touches no hardware", Rule.DANGEROUS)),
    # How it starts.
    Row("step real {step} called", Graded(_A.START_ORDER, "what the step is called")),
    Row(
        "step real {step} request parts",
        Graded(_A.START_ORDER, "versions that it compares", Rule.COMPARED, ordered=False),
    ),
    Row("step real {step} after", Graded(_A.START_ORDER, "steps before it", Rule.LOST, ordered=False)),
    Row(
        "step real {step} request controllers",
        Graded(_A.START_ORDER, "controllers to activate on hardware", Rule.DANGEROUS, ordered=False),
    ),
    Row(
        "step real {step} observed controllers",
        Graded(_A.START_ORDER, "controllers that only read hardware", Rule.LOST, ordered=False),
    ),
    Row("step real {step} observed ...", Graded(_A.START_ORDER, "activation of controllers that only read hardware")),
    Row("step real {step} ...", Graded(_A.START_ORDER, "request on hardware", Rule.DANGEROUS, ordered=False)),
    Row("step mock {step} ...", Graded(_A.START_ORDER, "step on the mock", ordered=False)),
    Row("spec bringup commissioning stages", Graded(_A.LIMITS, "stages of commissioning", Rule.KEPT, ordered=False)),
    Row("spec bringup commissioning {what}", Graded(_A.LIMITS, "commissioning", Rule.MORE, "ratio", why=FASTER)),
    Row("stage {stage} {joint} velocity", Graded(_A.LIMITS, "share of its velocity", Rule.MORE, "ratio", why=FASTER)),
    Row(
        "stage {stage} {joint} acceleration",
        Graded(_A.LIMITS, "share of its acceleration", Rule.MORE, "ratio", why=FASTER),
    ),
    Row(f"stage {{stage}} {_STRAIGHT}.max_trans_dec", Graded(_A.LIMITS, "deceleration", Rule.LESS, why=FASTER)),
    Row("stage {stage} ...", Graded(_A.LIMITS, "cap", Rule.MORE, why=FASTER)),
    *(
        row
        for kind, name, end in (("check", "{device}", ""), ("spec bringup", "{joint}", " value"))
        for row in (
            Row(f"{kind} first_motion {name} max_delta{end}", _first("largest move", Rule.MORE, "joint")),
            Row(f"{kind} first_motion {name} velocity{end}", _first("velocity", Rule.MORE, "joint/s")),
            Row(f"{kind} first_motion {name} stop_if", _first("reasons to stop", Rule.KEPT)),
            Row(f"{kind} first_motion {name} ...", _first("", Rule.DANGEROUS)),
        )
    ),
    # What is rehearsed, who answers, and what is recorded.
    Row("rehearsals {rehearsal} {what}", Graded(_A.REHEARSALS, "rehearsal")),
    Row(
        "file config/uncertainty.json tolerances {goal}",
        Graded(_A.REHEARSALS, "tolerance of a sweep", Rule.LOOSER, "m"),
    ),
    Row(
        "file config/uncertainty.json expected {rehearsal} success",
        Graded(_A.REHEARSALS, "required success rate", Rule.FEWER, "ratio"),
    ),
    Row(
        "file config/uncertainty.json expected {rehearsal} confidence",
        Graded(_A.REHEARSALS, "required confidence", Rule.FEWER, "ratio"),
    ),
    Row("file config/uncertainty.json quantities {quantity} {what}", Graded(_A.REHEARSALS, "sweep quantity")),
    Row(
        "file {_} {_} ros__parameters moveit_simple_controller_manager {controller} {what}",
        Graded(_A.CONTROL, "parameter in MoveIt's controller list:"),
    ),
    Row("file {_} {node} ros__parameters ...", Graded(_A.CONTROL, "parameter")),
    Row("manifest cellc_version", Graded(_A.VERSIONS, "cellc")),
)
ROWS = tuple(map(with_reason, _ALL))
"""What no row fits is `review`, in the area of its file."""

DERIVED: Sequence[str] = (
    "manifest version_tuple ...",
    "contract distro",
    "contract files ...",
    "controller {controller} full_name",
    "parameters {_} {node} ros__parameters constraints goal_time",
    *(
        f"parameters nodes {{adapter}} ros__parameters {name}"
        for name in ("command_timeout", "stop_time", "goal_time", "path_tolerance")
    ),
    "parameters {_} {node} ros__parameters update_rate",
    "parameters {_} {node} ros__parameters joints",
    "parameters {_} {node} ros__parameters {controller} type",
    "file config/frames.yaml frames ...",
    "file config/frames.yaml calibrations {calibration} revision",
    "file config/frames.yaml calibrations {calibration} owner",
    "file config/joint_limits.yaml ...",
)
"""Values that the compiler writes from others of the package, and from nothing else: listed where a file was edited."""

_REPEATING = ("bringup commissioning", "recording", "network", "targets", "mock_statements", "hosts")
"""Sections of a spec that other files of the package hold in their own form."""

FOLLOWS: Sequence[str] = (
    "contract plugin_behaviors ...",
    "controller {controller} command_interfaces",
    "real visuals ...",
    "real joint {joint} limit ...",
    "real joint {joint} name",
    "real joint {joint} parent",
    "real joint {joint} child",
    "mock ...",
    "step mock ...",
    "check first_motion ...",
    "step real {step} after",
    "step real {step} proof",
    "step real {step} effect",
    "step real {step} request controllers",
    "step real {step} observed controllers",
    "parameters nodes {node} ros__parameters qos_overrides ...",
    "file config/recording_qos.yaml ...",
    "file config/uncertainty.json quantities ...",
    "file config/moveit/controllers.yaml ...",
    "file config/moveit/controllers.mock.yaml ...",
    "file config/moveit/controllers.real.yaml ...",
    "right ...",
    "contract devices {device} law unaccounted",
    "device {device} payload ...",
    "device {device} tcp",
    "device {device} stamp ...",
    *(f"spec safety stop {name}" for name in ("path", "authority")),
    *(f"spec safety recovery {name}" for name in ("states", "acknowledge", "on_reconnect")),
    *(f"spec {name} ..." for name in _REPEATING),
    *(
        f"spec nodes {{node}} {name} ..."
        for name in ("endpoints", "parameters", "remaps", "inside", "lifecycle", "namespace", "owner", "device")
    ),
)
"""Values that repeat others in their own form: left out where one line of the spec makes both, else listed.

Who does what, such as the owner of the recovery, repeats nothing: that another line names the same people says nothing.
"""
