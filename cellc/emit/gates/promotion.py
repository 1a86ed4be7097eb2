"""Gates G0 to G7: from the powered-off manifest to a short trajectory."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.emit.gates.gate import Check, Gate
from cellc.emit.gates.motion import one_joint, trajectory
from cellc.formats.confirmation import CONFIRMATION
from cellc.formats.header import Header
from cellc.formats.version_tuple import version_tuple


def promotion_gates(cell: Cell, header: Header) -> tuple[Gate, ...]:
    """Return the gates in order."""
    return (
        _manifest(cell),
        _model(cell, header),
        _mock(cell),
        _network(cell),
        _connected(cell),
        _enabled(cell),
        one_joint(cell),
        trajectory(cell),
    )


def _manifest(cell: Cell) -> Gate:
    parts = tuple(
        Check(f"{name} on the nameplate or in the installed system is `{value}`")
        for name, value in version_tuple(cell).items()
    )
    return Gate(
        code="G0",
        title="Manifest",
        state="power off",
        checks=(Check("The version tuple is the one of this package", ("cat manifest.json",)), *parts),
        evidence="G0-inventory.md",
        owner=cell.spec.owners.approvals.vendor,
        stop=("an UNKNOWN in the list above", "a part that differs from the list"),
    )


def _model(cell: Cell, header: Header) -> Gate:
    measured = tuple(
        Check(f"Frame {frame.name} agrees with its physical marker (calibration {frame.calibration})")
        for frame in cell.frames
        if frame.calibration is not None
    )
    return Gate(
        code="G1",
        title="Model",
        state="offline",
        checks=(
            Check("The package is what the spec makes", (f"{header.command} --check",)),
            Check("The tree is one tree", (f"xacro urdf/{cell.name}.real.urdf | check_urdf /dev/stdin",)),
            Check("Axes, limits, TCP and collision shapes agree with drawing and robot"),
            *measured,
        ),
        evidence="G1-model.md",
        owner=cell.spec.owners.responsibilities.frames,
        stop=("a sign or scale that differs", f"a configuration id other than {header.configuration_id}"),
    )


def _mock(cell: Cell) -> Gate:
    managers = tuple(f"ros2 control list_controllers -c {m.namespace}/controller_manager" for m in cell.managers)
    actions = tuple(f"ros2 action info {c.action}" for c in cell.controllers if c.action)
    return Gate(
        code="G2",
        title="Mock",
        state="no hardware connected",
        checks=(
            Check("Every rehearsal ends as declared", (f"cellc mock generated/{cell.name}",)),
            Check("The cell starts on the mock", (f"ros2 launch {cell.name} cell.launch.xml",)),
            Check("Controllers claim what the contract says", managers),
            Check("Each action has one server and the declared clients", actions),
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
    fresh = tuple(f"timeout 600 ros2 topic hz {manager.namespace}/joint_states" for manager in cell.managers)
    return Gate(
        code="G3",
        title="Network",
        state="drives disabled",
        checks=(
            Check("Layers L1 and L2 of `gates/network.md` have passed"),
            Check(
                "A person releases the real target; it connects, reads and claims, and enables nothing",
                (f"ros2 launch {cell.name} cell.launch.xml target:=real confirm_real:={CONFIRMATION}",),
            ),
            Check("Layers L3 to L6 of `gates/network.md` have passed"),
            Check("State is fresh for ten minutes", fresh),
        ),
        evidence="G3-freshness.md",
        owner=cell.spec.owners.approvals.network,
        stop=("stale or duplicate state", "an endpoint that the contract does not name"),
    )


def _connected(cell: Cell) -> Gate:
    managed = tuple(f"ros2 lifecycle get {node.full_name}" for node in cell.nodes if node.lifecycle)
    hardware = tuple(
        f"ros2 control list_hardware_components -c {m.namespace}/controller_manager" for m in cell.managers
    )
    return Gate(
        code="G4",
        title="Connected, idle",
        state="idle, drives disabled",
        checks=(
            Check("Hardware components are in the state that the vendor's procedure expects", hardware),
            *((Check("Managed nodes are in their declared state", managed),) if managed else ()),
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
        state="reduced mode, enabled by a person through the vendor's procedure",
        checks=(
            Check(f"The stop of {stop.authority} (path: {stop.path}) was tried and the drives went off"),
            Check(f"The observer ({recovery.observer}) stands at the stop and sees the whole area"),
            Check("Nobody and nothing is in the reach of the cell"),
            *payloads,
        ),
        evidence="G5-enable.md",
        owner=cell.spec.owners.approvals.safety,
        stop=("a stop path that was not tried", "an observer who cannot see or reach the stop"),
    )


def _no_stop(cell: Cell) -> Iterator[Check]:
    for device in cell.devices:
        states = () if device.facts.safety is None else device.facts.safety.states
        stops = [state.name for state in states if state.stops]
        if stops:
            yield Check(f"{device.name} reports none of: {', '.join(stops)}")
