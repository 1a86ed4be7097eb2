"""Lines of the gates about the states of devices: which of them stop, in which they may be moved, how one logs in."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.deploy.computers import computers
from cellc.compiler.deploy.enabling import answers_when_powered, enabled_in, has_drives
from cellc.compiler.deploy.gate_motion import Values, speed_of
from cellc.compiler.deploy.processes import adapted_devices
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.formats.urdf.hardware import credentials
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import GateCode, LeftBy

_RESTART = (
    " Restart everything that this test stopped, including the controller manager, with the launch command of G4."
)


def stop_tests(graph: CellGraph) -> Iterator[Values]:
    """Yield the gates in which the stop is tried, and what is restarted then."""
    names: dict[GateCode, list[str]] = {}
    for device in graph.cell.devices:
        if has_drives(device):
            names.setdefault(enabled_in(device), []).append(device.name)
    for gate, powered in sorted(names.items()) or [(GateCode.G5, ["every drive"])]:
        named = f"{'each of ' if len(powered) > 1 else ''}{' and '.join(powered)}"
        yield gate, named, _RESTART if gate is GateCode.G5 else ""


def stop_evidence(graph: CellGraph) -> Iterator[Values]:
    """Yield what proves the test of the stop, in each gate with that test."""
    for gate, *_ in stop_tests(graph):
        yield from ((evidence, gate) for evidence in graph.cell.safety.stop.evidence)


def stop_figures(graph: CellGraph) -> Iterator[Values]:
    """Yield which times and distances of a stop the vendor of an arm publishes, and where."""
    for device in graph.cell.devices:
        stopping = device.procedures.safety.stopping
        if device.kind == "arm" and stopping is not None:
            yield device.name, *stopping, enabled_in(device)


def open_stop_figures(graph: CellGraph) -> Iterator[Values]:
    """Yield the arms and axes of which no public source says how far they go in a stop."""
    moving = (device for device in graph.cell.devices if has_drives(device) and device.kind in ("arm", "axis"))
    open_ = (device for device in moving if device.procedures.safety.stopping is None)
    return ((device.name, enabled_in(device)) for device in open_)


def layers_first(graph: CellGraph) -> Iterator[Values]:
    """Yield one empty row where every device answers on its network with its drives off."""
    return iter(() if any(gate is GateCode.G3 for _, gate in layers_powered(graph)) else ((),))


def layers_powered(graph: CellGraph) -> Iterator[Values]:
    """Yield the devices that answer on their network only while their drives have power, with the gate of that."""
    return ((device.name, enabled_in(device)) for device in graph.cell.devices if answers_when_powered(device))


def speed_controls(graph: CellGraph) -> Iterator[Values]:
    """Yield what slows arms down, what for the first motions, and how people set it."""
    for device in graph.cell.devices:
        control = device.procedures.speed_control
        if device.kind == "arm" and control is not None and control.name:
            yield device.name, control.name, speed_of(control), control.does


def without_speed_control(graph: CellGraph) -> Iterator[Values]:
    """Yield the arms that nothing slows down, and why."""
    for device in graph.cell.devices:
        control = device.procedures.speed_control
        if device.kind == "arm" and control is not None and not control.name:
            yield device.name, control.does


def open_speed_controls(graph: CellGraph) -> Iterator[Values]:
    """Yield the arms of which no source says whether anything slows them down."""
    arms = (device for device in graph.cell.devices if device.kind == "arm")
    return ((device.name,) for device in arms if device.procedures.speed_control is None)


def stopping_devices(graph: CellGraph) -> Iterator[Values]:
    """Yield the states that stop each device, with what shows them, in the gates that look for them."""
    adapted = adapted_devices(graph.cell)
    for device in graph.cell.devices:
        safety = device.procedures.safety
        for gate in GateCode:
            stops = [state for state in safety.states if state.stops and state.gate is gate and state.reported]
            if stops and device.name not in adapted:
                echoes = (
                    f"timeout 10 ros2 topic echo --once {field and f'--field {field} '}{shell_word(topic)}"
                    for topic, field in safety.topics
                )
                states = ", ".join(f"{state.name} ({state.reported})" for state in stops)
                yield device.name, states, "\n".join(echoes), gate


def read_states(graph: CellGraph) -> Iterator[Values]:
    """Yield the states that stop devices behind an adapter: what their driver would report, people read there."""
    adapted = adapted_devices(graph.cell)
    for device in graph.cell.devices:
        states = (state for state in device.procedures.safety.states if state.stops and state.reported)
        if device.name in adapted and (shown := ", ".join(f"{state.name} ({state.reported})" for state in states)):
            yield device.name, shown


def unreported_stops(graph: CellGraph) -> Iterator[Values]:
    """Yield the states that stop a device and that its driver does not report, with what people see in them."""
    for device in graph.cell.devices:
        for state in device.procedures.safety.states:
            if state.stops and state.seen:
                yield device.name, state.name, state.seen, state.gate


def ready_states(graph: CellGraph) -> Iterator[Values]:
    """Yield the states in which a device may be moved, where it reports them."""
    adapted = adapted_devices(graph.cell)
    for device in graph.cell.devices:
        states = (state for state in device.procedures.safety.states if not state.stops and state.reported)
        if device.name not in adapted and (shown := "; ".join(f"{state.name} ({state.reported})" for state in states)):
            yield device.name, shown


def modes(graph: CellGraph) -> Iterator[Values]:
    """Yield the operating modes of each device, by its vendor's names."""
    for device in graph.cell.devices:
        if listed := ", ".join(device.procedures.safety.modes):
            yield device.name, listed, enabled_in(device) if answers_when_powered(device) else GateCode.L2


def variables(graph: CellGraph) -> Iterator[Values]:
    """Yield the environment variables with which a driver logs in at its device, the user name first."""
    for device in graph.cell.devices:
        if names := credentials(device)[0]:
            yield device.name, " and ".join(names), f"printenv {names[0]}"


def secret_files(graph: CellGraph) -> Iterator[Values]:
    """Yield the files from which a driver has its user name and password."""
    for device in graph.cell.devices:
        yield from ((device.name, path, f"stat -c '%a %U' {path}") for path in credentials(device)[1])


def self_resuming(graph: CellGraph) -> Iterator[Values]:
    """Yield the stops that end without a person."""
    states = ((device.name, state) for device in graph.cell.devices for state in device.procedures.safety.states)
    return ((name, state.name) for name, state in states if state.stops and state.left_by is LeftBy.ITSELF)


def identities(graph: CellGraph) -> Iterator[Values]:
    """Yield what identifies each device, as the spec states it."""
    for device in graph.cell.devices:
        safety = " and its safety state" if device.procedures.safety.states else ""
        gate = enabled_in(device) if answers_when_powered(device) else GateCode.L2
        yield device.name, device.software.versions.serial, device.software.versions.firmware, safety, gate


def bounded_clocks(graph: CellGraph) -> Iterator[Values]:
    """Yield the computers whose clock must be within a bound, where no program of the cell reads the offset."""
    read = {name for name, computer in computers(graph).items() if computer.max_offset_s is not None}
    for host in graph.cell.hosts.values():
        if host.clock.max_offset_s is not None and host.name not in read:
            by = host.clock.synchronized_by or "not stated"
            yield host.name, graph.cell.text(*host.path, "clock", "max_offset"), by
