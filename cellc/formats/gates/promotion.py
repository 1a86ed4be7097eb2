"""Gates G0 to G7: from the powered-off manifest to a short trajectory."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.formats.gates.gate import Check, Gate
from cellc.formats.gates.manifest import manifest
from cellc.formats.gates.motion import joint_state_topics, one_joint, trajectory
from cellc.formats.gates.releases import move_mock, start_mock, start_real
from cellc.formats.header import Header
from cellc.formats.movers import is_mover


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
        owner=cell.spec.owners.responsibilities.frames,
        stop=("a sign or scale that differs", f"a configuration id other than {header.configuration_id}"),
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
        owner=cell.spec.owners.approvals.controller,
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
        owner=cell.spec.owners.approvals.network,
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
        owner=cell.spec.owners.approvals.vendor,
        stop=("an unexpected remote mode", "a fault that nobody has explained", "motion of any kind"),
    )


def _enabled(cell: Cell) -> Gate:
    stop, recovery = cell.spec.safety.stop, cell.spec.safety.recovery
    payloads = tuple(
        Check(f"{device.name} is told payload {payload.mass.text}, centre of mass {payload.center_of_mass.text}")
        for device in cell.devices
        if (payload := device.spec.payload) is not None
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
        owner=cell.spec.owners.approvals.safety,
        stop=("a stop path that was not tried", "an observer who cannot see or reach the stop"),
    )


def _managed(cell: Cell) -> Iterator[Check]:
    for node in cell.nodes:
        if node.lifecycle:
            state = "inactive" if is_mover(cell, node) else "active"
            yield Check(f"{node.full_name} is {state}", (f"ros2 lifecycle get {node.full_name}",))


def _no_stop(cell: Cell) -> Iterator[Check]:
    for device in cell.devices:
        states = () if device.facts.safety is None else device.facts.safety.states
        stops = [f"{state.name} ({state.reported})" for state in states if state.stops]
        if stops:
            yield Check(f"{device.name} reports none of: {', '.join(stops)}")
