"""One gate: what is checked in which state of the robot, the evidence it leaves, and what stops it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.interface import InterfaceKind
from cellc.cell.site import UNKNOWN, FirstMotion
from cellc.deploy.configuration import version_tuple
from cellc.deploy.processes import is_mover
from cellc.deploy.recording import record_command
from cellc.deploy.releases import move_mock, move_real, start_mock, start_real
from cellc.formats.header import Header
from cellc.formats.numbers import shortest
from cellc.link.derived import JOINT_STATE_TYPE

_STARTS = ("ros2 launch ", "ros2 bag record ")


@dataclass(frozen=True, slots=True)
class Check:
    """One line to tick; ``commands`` read and never change anything at the cell, or start what its gate releases."""

    text: str
    commands: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Gate:
    """A gate of chapter 4.

    Args:
        code: ``G0`` to ``G7``, ``L1`` to ``L6``.
        shows: what has been shown once it is passed, in one phrase.
        state: state that the robot or its drives are in.
        evidence: name of the file that the gate must leave.
        owner: who signs, from the spec.
        stop: conditions under which nobody goes on.
    """

    code: str
    title: str
    shows: str
    state: str
    checks: tuple[Check, ...]
    evidence: str
    owner: str
    stop: tuple[str, ...]

    @property
    def key_command(self) -> str:
        """The first command that reads, empty for a gate that people alone pass."""
        commands = (command for check in self.checks for command in check.commands if not starts(command))
        return next(commands, "")


def starts(command: str) -> bool:
    """Tell whether a command starts a part of the cell and stays in its shell, rather than reads and ends."""
    return command.startswith(_STARTS)


def promotion_gates(cell: Cell, header: Header) -> tuple[Gate, ...]:
    """Return the gates in order."""
    return (
        manifest(cell),
        _model(cell, header),
        _mock(cell),
        _network(cell),
        _connected(cell),
        _enabled(cell),
        one_joint(cell),
        trajectory(cell),
    )


def _model(cell: Cell, header: Header) -> Gate:
    measured = tuple(
        Check(f"Frame {frame.name} agrees with its physical marker (calibration {frame.calibration})")
        for frame in cell.frames
        if frame.calibration is not None
    )
    description = f"generated/{cell.name}/urdf/{cell.name}.real.urdf"
    return Gate(
        code="G1",
        title="Model",
        shows="the model is the robot that stands there: axes, limits, TCP, shapes, frames",
        state="offline",
        checks=(
            Check("The package is what the spec makes", (f"{header.command} --check",)),
            Check("The tree is one tree", (f"xacro {description} | check_urdf /dev/stdin",)),
            Check("The hash of the description is kept with the evidence", (f"sha256sum {description}",)),
            Check("Axes, limits, TCP and collision shapes agree with drawing and robot, each with a screenshot"),
            *measured,
        ),
        evidence="G1-model.md",
        owner=cell.owners.responsibilities.frames,
        stop=("a sign or scale that differs", "another configuration id than that of `manifest.json`"),
    )


def _mock(cell: Cell) -> Gate:
    managers = tuple(f"ros2 control list_controllers -v -c {m.namespace}/controller_manager" for m in cell.managers)
    actions = tuple(f"ros2 action info {c.action}" for c in cell.controllers if c.action and "mock" in c.targets)
    moving = move_mock(cell)
    return Gate(
        code="G2",
        title="Mock",
        shows="the cell comes up, claims once, and a cancel holds, without any hardware",
        state="no hardware connected",
        checks=(
            Check("Every rehearsal ends as declared", (f"cellc mock generated/{cell.name}",)),
            Check("The cell starts on the mock", (start_mock(cell),)),
            *((Check("What asks for motion starts, and moves the mock alone", moving),) * bool(moving)),
            Check("Controllers are active, alternates inactive, and each claim has one owner", managers),
            *((Check("Each action has one server and the declared clients", actions),) if actions else ()),
        ),
        evidence="G2-mock.md",
        owner=cell.owners.approvals.controller,
        stop=(
            "a second owner of a command interface",
            "a cancel that does not hold",
            "a rehearsal that ends otherwise",
        ),
    )


def _network(cell: Cell) -> Gate:
    fresh = tuple(f"timeout 600 ros2 topic hz {topic}" for topic in joint_state_topics(cell))
    return Gate(
        code="G3",
        title="Network",
        shows="discovery, data, time and transforms hold for ten minutes on the real network",
        state="drives disabled",
        checks=(
            Check("Layers L1 and L2 have passed"),
            Check(
                "A person releases the real target; it connects, reads and claims, and enables nothing",
                start_real(cell),
            ),
            Check("Layers L3 to L5 have passed"),
            *((Check("State is fresh for ten minutes", fresh),) * bool(fresh)),
            Check("With the real target ended, layer L6 has passed on the mock"),
        ),
        evidence="G3-freshness.md",
        owner=cell.owners.approvals.network,
        stop=("stale or duplicate state", "an endpoint that the contract does not name"),
    )


def _connected(cell: Cell) -> Gate:
    names = tuple(f"{manager.namespace}/controller_manager" for manager in cell.managers)
    hardware = tuple(f"ros2 control list_hardware_components -c {name}" for name in names)
    controllers = tuple(f"ros2 control list_controllers -v -c {name}" for name in names)
    return Gate(
        code="G4",
        title="Connected, idle",
        shows="vendor state, hardware, controllers and managed nodes are what was declared, and nothing moves",
        state="idle, drives disabled",
        checks=(
            Check("A person releases the real target once more", start_real(cell)),
            Check("Hardware components are in the state that the vendor's procedure expects", hardware),
            Check("Controllers are active, alternates inactive, and each claim has one owner", controllers),
            *_managed(cell),
            *_no_stop(cell),
        ),
        evidence="G4-transitions.md",
        owner=cell.owners.approvals.vendor,
        stop=("an unexpected remote mode", "a fault that nobody has explained", "motion of any kind"),
    )


def _enabled(cell: Cell) -> Gate:
    stop, recovery = cell.safety.stop, cell.safety.recovery
    payloads = tuple(
        Check(
            f"{device.name} is told payload {cell.text(*device.path, 'payload', 'mass')}, "
            f"centre of mass {cell.text(*device.path, 'payload', 'center_of_mass')}"
        )
        for device in cell.devices
        if device.payload is not None
    )
    return Gate(
        code="G5",
        title="Enabled",
        shows="the stop works, the area is empty, somebody watches, and the robot knows its load",
        state="reduced mode, enabled by a person through the vendor's procedure",
        checks=(
            Check(f"The stop of {stop.authority} (path: {stop.path}) was tried and the drives went off"),
            Check(f"The observer ({recovery.observer}) stands at the stop and sees the whole area"),
            Check("Nobody and nothing is in the reach of the cell"),
            *payloads,
            *(Check(f"There is evidence of the stop: {one}") for one in stop.evidence),
        ),
        evidence="G5-enable.md",
        owner=cell.owners.approvals.safety,
        stop=("a stop path that was not tried", "an observer who cannot see or reach the stop"),
    )


def _managed(cell: Cell) -> Iterator[Check]:
    for node in cell.nodes:
        if node.lifecycle:
            state = "inactive" if is_mover(cell, node) else "active"
            yield Check(f"{node.full_name} is {state}", (f"ros2 lifecycle get {node.full_name}",))


def _no_stop(cell: Cell) -> Iterator[Check]:
    for device in cell.devices:
        stops = [f"{state.name} ({state.reported})" for state in device.safety.states if state.stops]
        if stops:
            yield Check(f"{device.name} reports none of: {', '.join(stops)}")


_OF_SYSTEM = {"os": "lsb_release -ds", "kernel": "uname -r", "ros": "printenv ROS_DISTRO"}
_PACKAGES = {"ros2_control": "controller_manager", "moveit": "moveit_ros_move_group"}
# Pinned as a package and its version; the rest is read on the device or its panel.
_INSTALLED = ("rmw", "driver", "sdk", "description")


def manifest(cell: Cell) -> Gate:
    """Return the gate of the powered-off inventory."""
    return Gate(
        code="G0",
        title="Manifest",
        shows="every part of the version tuple is the one that stands here",
        state="power off",
        checks=(
            Check("The manifest is that of this configuration", (f"cat generated/{cell.name}/manifest.json",)),
            *_installed(cell),
            *_read_by_people(cell),
        ),
        evidence="G0-inventory.md",
        owner=cell.owners.approvals.vendor,
        stop=(f"a part that is {UNKNOWN}", "a part that differs from the tuple"),
    )


def _installed(cell: Cell) -> Iterator[Check]:
    for name, value in version_tuple(cell).items():
        command = _command(name, value)
        if command:
            yield Check(f"{name} is `{value}`", (command,))


def _read_by_people(cell: Cell) -> Iterator[Check]:
    for name, value in version_tuple(cell).items():
        if not _command(name, value):
            unknown = f"{name} is {UNKNOWN}: it is found out, and written into the spec"
            yield Check(unknown if value == UNKNOWN else f"{name} is `{value}`, by nameplate or panel")


def _command(name: str, value: str) -> str:
    part, words = name.rpartition(".")[2], value.split()
    if value == UNKNOWN:
        return ""
    if part in _OF_SYSTEM:
        return _OF_SYSTEM[part]
    if part in _PACKAGES:
        return f"ros2 pkg xml -t version {_PACKAGES[part]}"
    return f"ros2 pkg xml -t version {words[0]}" if part in _INSTALLED and len(words) == 2 else ""


_NOT_STATED = "`bringup.first_motion` is not stated: joint, sign, largest change, speed, timeout, reasons to stop"


def one_joint(cell: Cell) -> Gate:
    """Return the gate of the single-joint move that the spec states; without one there is nothing that may move."""
    first = cell.bringup.first_motion
    return Gate(
        code="G6",
        title="One joint",
        shows="one joint moves as it was told: its direction, its distance, and no other joint",
        state="reduced speed and range",
        checks=(Check(_NOT_STATED),) if first is None else _first_motion(cell, first),
        evidence="G6-command-state-error.md",
        owner=cell.safety.recovery.observer,
        stop=("no stated first motion",) if first is None else first.stop_if,
    )


def _first_motion(cell: Cell, first: FirstMotion) -> tuple[Check, ...]:
    def motion(part: str) -> str:
        return cell.text("bringup", "first_motion", part)

    return (
        Check(
            f"Said aloud before it moves: joint {first.joint}, direction {first.direction}, at most "
            f"{motion('max_delta')}, {motion('velocity')}, ends within {motion('timeout')}"
        ),
        _recorded(cell, "G6"),
        Check("Positions before the move", _states(cell)),
        Check("A person moves it by that much, there and back, in reduced mode and by the vendor's procedure"),
        Check("It moved in the stated direction and back, and no other joint moved", _states(cell)),
        Check("The position that the controller reports is the physical one"),
    )


def trajectory(cell: Cell) -> Gate:
    """Return the gate of a short action with feedback and cancellation."""
    started = move_real(cell)
    release = (Check("A person releases what asks for motion", started),) if started else ()
    return Gate(
        code="G7",
        title="Trajectory",
        shows="a short goal is accepted, fed back, ended and cancelled, and the record says all of it",
        state="reduced envelope",
        checks=(
            _recorded(cell, "G7"),
            *release,
            *_servers(cell),
            Check("A short goal is accepted, fed back and ended with a result"),
            *_cancels(cell),
            Check(f"The attempt record holds {', '.join(cell.recording.attempt_fields)}"),
        ),
        evidence="G7-attempt.md",
        owner=cell.owners.approvals.graph,
        stop=("a cancel or hold that is not clear", "a result that does not say which layer failed"),
    )


def _recorded(cell: Cell, gate: str) -> Check:
    return Check("The attempt is recorded until it has ended", (" \\\n  ".join(record_command(cell, f"{gate}-bag")),))


def _servers(cell: Cell) -> Iterator[Check]:
    for interface in cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and "real" in interface.targets:
            yield Check(f"`{interface.name}` has one server", (f"ros2 action info {interface.name}",))


def _cancels(cell: Cell) -> Iterator[Check]:
    for interface in cell.interfaces:
        if interface.cancel_within_s is not None and "real" in interface.targets:
            yield Check(f"A cancel on `{interface.name}` holds within {shortest(interface.cancel_within_s)} s")


def joint_state_topics(cell: Cell) -> tuple[str, ...]:
    """Return where joints are reported on real hardware."""
    return tuple(one.name for one in cell.interfaces if one.type == JOINT_STATE_TYPE and "real" in one.targets)


def _states(cell: Cell) -> tuple[str, ...]:
    return tuple(f"ros2 topic echo --once {topic}" for topic in joint_state_topics(cell))
