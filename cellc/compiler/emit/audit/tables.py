"""Tables of the audit: every command path, and the expected nodes and interfaces of the running cell."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Solid
from cellc.compiler.cell.interface import Endpoint, Interface, Node, NodeSource
from cellc.compiler.cell.vendor import RecordSource
from cellc.compiler.deploy.files import (
    controllers_file,
    is_capped,
    is_planner,
    node_file,
    parameter_files,
    plans,
    stage_files,
)
from cellc.compiler.deploy.labels import (
    ON_TARGET,
    failure_label,
    folded,
    frame_label,
    interface_facts,
    rate_label,
    rates_of_controllers,
    touched_label,
    units,
    watchdogs,
    watched_stream,
)
from cellc.compiler.deploy.processes import past_controllers
from cellc.compiler.formats.escape import code
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.formats.mjcf.parts import assumed, edges_m, mass_kg
from cellc.compiler.formats.mjcf.tree import parts
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.formats.parameter_file import node_parameters
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.claims import claimed_by_device
from cellc.compiler.graph.frame_tree import build_frame_tree
from cellc.compiler.graph.stated_parameters import unchecked_parameters
from cellc.compiler.link.nodes import DESCRIPTION_PUBLISHER
from cellc.contract.vocabulary import InterfaceKind

_NOT_STATED = "not stated"
_ALONE: Mapping[tuple[str, ...], str] = {("real",): " (real target)", ("mock",): " (mock)"}
"""Mark of what only one target has."""


def owners_section(graph: CellGraph) -> str:
    """Write the owner of each command interface, and the client that commands it."""
    return table(("command interface", "controller", "commanded by", "owner"), _owners(graph.cell))


def command_section(graph: CellGraph) -> str:
    """Write the command paths: through controllers down to joints, and the actions above them."""
    head = ("path", "frame", "unit", "rate", "time source", "QoS", "watchdog", "on failure")
    return table(head, [*_requests(graph.cell), *_controllers(graph.cell), *_past_controllers(graph.cell)])


def _owners(cell: Cell) -> Iterator[tuple[str, ...]]:
    people = {node.name: node.owner for node in cell.nodes}
    for controller in cell.controllers:
        client = controller.client or "none"
        state = "" if controller.active else " (inactive)"
        for claims, where in _claims(controller).items():
            for name in folded(claims):
                yield code(name), f"{controller.label}{state}{where}", client, people.get(client, _NOT_STATED)


def calibration_section(cell: Cell) -> str:
    """Write the files of calibration tools that transforms are taken from, each with its date and hash."""
    rows = (
        (
            calibration.name,
            str(calibration.revision),
            calibration.measured,
            calibration.owner,
            code(calibration.file.path),
            code(calibration.file.sha256),
        )
        for calibration in cell.calibrations.values()
        if calibration.file is not None
    )
    return table(("calibration", "revision", "measured", "owner", "file", "sha256"), rows)


def shapes_section(cell: Cell) -> str:
    """Write the source of each device's link shapes, equal on every target."""
    return table(("device", "shapes", "reason"), ((device.name, *_shapes(device)) for device in cell.devices))


def _shapes(device: Device) -> tuple[str, str]:
    vendor = device.body.vendor_description
    if vendor is None:
        return "from its description", "the catalog names no vendor file with other shapes"
    if vendor.description is not None:
        return "from its vendor", f"{code(vendor.package)} is available, and its kinematics matches"
    if vendor.refused:
        return "boxes and cylinders", f"the description in {code(vendor.package)} cannot be read"
    return "boxes and cylinders", f"{code(vendor.package)} is neither beside the spec nor on the package path"


def scene_section(cell: Cell) -> str:
    """Write each thing that planning avoids, what of the surroundings it is, and what its figures rest on."""
    return table(("thing", "shape", "is", "from"), map(partial(_solid, cell), cell.scene))


def _solid(cell: Cell, solid: Solid) -> tuple[str, ...]:
    parts = [part for part, known in cell.surroundings if solid.name in known.shapes]
    shape = "plane" if solid.is_plane else type(solid.geometry).__name__.lower()
    touched = solid.touched
    if touched is None:
        return solid.name, shape, ", ".join(parts) or solid.kind, "figures of the spec"
    return solid.name, shape, ", ".join(parts) or solid.kind, touched_label(touched, solid.is_plane)


def parts_section(cell: Cell) -> str:
    """Write each part as a simulator has it in ``sim/scene.xml``, and what of it is not stated."""
    return table(("part", "edges", "mass", "friction", "not stated"), _parts(cell))


def _parts(cell: Cell) -> Iterator[tuple[str, ...]]:
    for name, part in parts(cell, build_frame_tree(cell)).items():
        edges = " by ".join(f"{edge:.4g}" for edge in edges_m(part))
        figures = f"{edges} m", f"{mass_kg(part):.4g} kg", f"{part.grasp.grips_with:g}"
        yield code(name), *figures, ", ".join(assumed(part)) or "nothing"


def signals_section(cell: Cell) -> str:
    """Write each output and sensor of switched devices: what drives it, and what a loss of power does."""
    head = ("device", "signal", "interface", "controller", "commanded by", "without power")
    return table(head, _signals(cell))


def _signals(cell: Cell) -> Iterator[tuple[str, ...]]:
    for device in cell.devices:
        switched = device.switched
        if switched is None:
            continue
        accepted = "" if switched.accepted_by is None else f", accepted by {switched.accepted_by}"
        lost = "holds nothing" if switched.holds is None else f"{switched.power_lost}{accepted}"
        for name, interface in switched.outputs.items():
            by = next((each for each in cell.controllers if interface in each.all_claims), None)
            client = "none" if by is None or by.client is None else by.client
            yield device.name, f"output {name}", code(interface), "none" if by is None else by.label, client, lost
        for name, interface in switched.inputs.items():
            by = next((each for each in cell.controllers if interface in each.state_interfaces), None)
            yield device.name, f"sensor {name}", code(interface), "none" if by is None else by.label, "read only", lost


def _claims(controller: Controller) -> dict[tuple[str, ...], str]:
    """Return what a controller claims → where, which is empty for every target alike."""
    claims = {controller.claims(target): f" on {ON_TARGET[target]}" for target in controller.targets}
    return claims if len(claims) > 1 else dict.fromkeys(claims, "")


def _requests(cell: Cell) -> Iterator[tuple[str, ...]]:
    served = {controller.action for controller in cell.controllers}
    for interface in cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and interface.name not in served:
            ends = f"{_names(interface.sinks)} → {code(interface.name)} → {_names(interface.sources)}"
            time = interface.time_source or _NOT_STATED
            qos = _qos((*interface.sinks, *interface.sources))
            by = next((adapted.device for adapted in cell.adapters if adapted.action == interface.name), None)
            watched = None if by is None else watched_stream(cell, cell.device(by))
            yield (
                ends,
                frame_label(interface),
                interface.unit or "per message type",
                "on request",
                time,
                qos,
                watched or "none",
                failure_label(interface, {}),
            )


def _past_controllers(cell: Cell) -> Iterator[tuple[str, ...]]:
    """Yield what moves a device without a controller; any node that the policy permits can call it."""
    for device, offer, does in past_controllers(cell):
        path = f"no client in the cell → {code(offer.name)} → {device.name} (real target)"
        typed, watched = "per message type", device.procedures.safety.watchdog or _NOT_STATED
        yield path, typed, typed, "on request", _NOT_STATED, typed, watched, f"{does}; needs no claim"


def _controllers(cell: Cell) -> Iterator[tuple[str, ...]]:
    actions = {interface.name: interface for interface in cell.interfaces}
    for manager in cell.managers:
        for controller in manager.controllers:
            if controller.command_interfaces:
                yield _controller(cell, manager, controller, actions.get(controller.action or ""))


def _controller(
    cell: Cell, manager: ControllerManager, controller: Controller, action: Interface | None
) -> tuple[str, ...]:
    components = (cell.device(name).control.hardware for name in claimed_by_device(cell, controller))
    hardware = " and ".join(component.name for component in components if component is not None) or "its hardware"
    rate = controller.update_rate_hz or manager.update_rate_hz
    behavior = "" if action is None else f"; {failure_label(action, {})}"
    name, client = controller.action or controller.full_name, controller.client or "no client"
    return (
        f"{client} → {code(name)} → {controller.label} → {hardware}{_alone(controller.targets)}",
        (action.frame if action is not None else None) or "joints",
        units(cell, controller, controller.all_claims),
        f"{shortest(rate)} Hz",
        (action.time_source if action is not None else None) or f"clock of {manager.host or 'its host'}",
        _NOT_STATED if action is None else _qos((*action.sinks, *action.sources)),
        watchdogs(cell, controller),
        f"on violation {controller.on_violation}{behavior}",
    )


def _qos(ends: tuple[Endpoint, ...]) -> str:
    texts = (f"{end.qos.reliability}, {end.qos.durability}, depth {end.qos.depth}" for end in ends)
    return "; ".join(dict.fromkeys(texts)) or _NOT_STATED


def _names(ends: tuple[Endpoint, ...]) -> str:
    return ", ".join(dict.fromkeys(end.node for end in ends)) or "no node"


def nodes_section(cell: Cell) -> str:
    """Write every node with its owner, and whose parameters no check knows: they are those of the user's programs."""
    nodes = table(("node", "program", "host", "owner", "parameters"), _nodes(cell))
    unchecked = [f"- {code(owner)}: {_code(names)}" for owner, names in unchecked_parameters(cell)]
    if not unchecked:
        return nodes
    advice = "No check knows these. Compare with `ros2 param list`: a name that a node does not declare has no effect."
    return "\n".join((nodes, "", advice, "", *unchecked))


def interfaces_section(cell: Cell, kind: InterfaceKind) -> str:
    """Write the topics, services or actions, each with both ends."""
    ends = ("publishers", "subscribers") if kind is InterfaceKind.TOPIC else ("server", "clients")
    rates = rates_of_controllers(cell)
    rows = (_interface(interface, rates) for interface in cell.interfaces if interface.kind is kind)
    return table(("name", "type", *ends, "contract"), rows)


def drivers_section(cell: Cell) -> str:
    """Write the interfaces that drivers offer by the catalog and the spec does not name."""
    return table(("name", "kind", "type", "device"), _of_drivers(cell))


def tf_section(cell: Cell) -> str:
    """Write who publishes which edges of the frame tree."""
    publishers: dict[str, list[str]] = {}
    for frame in cell.frames:
        if frame.parent:
            publishers.setdefault(frame.authority, []).append(frame.name)
    return table(("publisher", "frames"), ((name, _code(frames)) for name, frames in publishers.items()))


def record_section(cell: Cell) -> str:
    """Write the source of each attempt field that only the devices know, on the real target."""
    return table(("field", "device", "from"), _record(cell))


def _record(cell: Cell) -> Iterator[tuple[str, ...]]:
    for device in cell.devices:
        for source in device.procedures.record:
            if source.attempt_field in cell.recording.attempt_fields:
                yield code(source.attempt_field), device.name, _record_source(cell, device, source)


def _record_source(cell: Cell, device: Device, source: RecordSource) -> str:
    if source.read is not None:
        return f"by hand: {source.read}"
    reporter = cell.reporting(device, source)
    return _NOT_STATED if reporter is None else f"`{source.field}` of {code(f'{reporter.full_name}/{source.topic}')}"


def _nodes(cell: Cell) -> Iterator[tuple[str, ...]]:
    files = {manager.node: controllers_file(cell, manager, "real") for manager in cell.managers}
    for node in cell.nodes:
        real = " (real target)" if node.real_only else ""
        program = f"{node.package}/{node.executable}{real}"
        own = files.get(node.full_name)
        parameters = _parameters(cell, node) if own is None else (own,)
        yield code(node.full_name), program, node.host or "not stated", node.owner, _code(parameters)
    for device in cell.devices:
        for host_program in device.site.programs:
            program = f"{host_program.package}/{host_program.program} (real target, no node)"
            owner = cell.owners.responsibilities.vendor_safety
            yield (
                code(host_program.name),
                program,
                device.site.host or "not stated",
                owner,
                _code(host_program.arguments),
            )
    for manager in cell.managers:
        for controller in manager.controllers:
            owner = cell.owners.approvals.controller
            name, host = (
                f"`{manager.namespace}/{controller.name}`",
                f"{manager.host or 'not stated'}{_alone(controller.targets)}",
            )
            yield name, controller.plugin, host, owner, _code(controller.parameters_on("real"))


def _parameters(cell: Cell, node: Node) -> tuple[str, ...]:
    """Return the names of parameters of a node that is no manager, and the files of those that several nodes share."""
    if node.name == DESCRIPTION_PUBLISHER:
        return ("robot_description",)
    if node.source is NodeSource.STANDARD:
        return ("robot_description", "publish_frequency")
    planned = ("robot_description", "robot_description_semantic", *parameter_files(cell, "real"))
    own = (node_file(node),) if node_parameters(cell, node) else ()
    capped = stage_files(cell).values() if is_capped(cell, node) else ()
    return (*(planned if is_planner(node) and plans(cell) else ()), *own, *capped)


def _of_drivers(cell: Cell) -> Iterator[tuple[str, ...]]:
    named = {interface.name for interface in cell.interfaces}
    for device in cell.devices:
        for name, type_ in device.topics.items():
            if name not in named:
                yield code(name), "topic", type_, device.name
        for offer in device.control.offers:
            if offer.kind is InterfaceKind.SERVICE:
                yield code(offer.name), "service", offer.type, device.name


def _interface(interface: Interface, rates: Mapping[str, str]) -> tuple[str, ...]:
    _, *facts = interface_facts(interface, rates)
    contract = "; ".join((rate_label(interface, rates), *facts)) + _alone(interface.targets)
    return code(interface.name), interface.type, _ends(interface.sources), _ends(interface.sinks), contract


def _alone(targets: Sequence[str]) -> str:
    return _ALONE.get(tuple(targets), "")


def _ends(ends: tuple[Endpoint, ...]) -> str:
    shown = (f"{end.node} ({end.qos.reliability}, {end.qos.durability}, depth {end.qos.depth})" for end in ends)
    return ", ".join(dict.fromkeys(shown)) or "none"


def _code(names: Iterable[str]) -> str:
    return ", ".join(code(name) for name in names) or "none"
