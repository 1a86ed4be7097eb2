"""What the lines of the gates stand for: the things of a cell, each with the fields that a text may name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from cellc.cell.cell import Cell
from cellc.cell.interface import Endpoint, Interface, InterfaceKind
from cellc.cell.site import UNKNOWN
from cellc.deploy.bringup import bring_up, phases
from cellc.deploy.configuration import version_tuple
from cellc.deploy.processes import asks_for_motion, description_nodes, motion_clients, started_by_a_person
from cellc.deploy.recording import record_command
from cellc.deploy.releases import ACTIVATE, CLAIM, Release, move_mock, move_real, release_once, start_mock, start_real
from cellc.formats.escape import shell_word
from cellc.formats.header import Header
from cellc.formats.numbers import shortest
from cellc.graph.cell_graph import CellGraph
from cellc.graph.versions import compatibility
from cellc.link.derived import JOINT_STATE_TYPE
from cellc.pins import is_commit, last_word
from cellc.vocabulary import BringUpPhase

Row = Mapping[str, str]
Values = tuple[str, ...]

CELL = "cell"
"""The subject of a line that stands once."""

_OF_SYSTEM = {"os": "lsb_release -ds", "kernel": "uname -r", "ros": "printenv ROS_DISTRO"}
_PACKAGES = {"ros2_control": "controller_manager", "moveit": "moveit_ros_move_group"}
# Pinned as a package and its version; the rest is read on the device or its panel.
_INSTALLED = ("rmw", "driver", "sdk", "description")


def cell_row(cell: Cell, header: Header, code: str) -> Row:
    """Return what every text and command may name; ``record`` is for a bag of one gate."""
    stop = cell.safety.stop
    return {
        "gate": code,
        "cell": cell.name,
        "build": header.command,
        "description": f"generated/{cell.name}/urdf/{cell.name}.real.urdf",
        "start_mock": start_mock(cell),
        "record": " \\\n  ".join(record_command(cell, f"{code}-bag")),
        "domain": str(cell.network.domain_id),
        "stop_authority": stop.authority,
        "stop_path": stop.path,
        "observer": cell.safety.recovery.observer,
        "attempt_fields": ", ".join(cell.recording.attempt_fields),
    }


def _installed(graph: CellGraph) -> Iterator[Values]:
    for name, value in version_tuple(graph.cell).items():
        if (command := _command(name, value)) and not is_commit(last_word(value)):
            yield name, value, command


def _built(graph: CellGraph) -> Iterator[Values]:
    """Yield what is pinned to a commit, which the source that was built shows and no version of a package."""
    for judged in compatibility(graph.cell):
        pin = judged.pin
        if pin.part in _INSTALLED and is_commit(last_word(pin.text)):
            source = next((f"src/{one.name}" for one in judged.built_from[:1]), "")
            name = pin.part if pin.holder == graph.cell.name else f"{pin.holder}.{pin.part}"
            yield name, pin.text, f"git -C {shell_word(source)} rev-parse HEAD" if source else ""


def _visible(graph: CellGraph) -> Iterator[Values]:
    for name, value in version_tuple(graph.cell).items():
        if value != UNKNOWN and not _command(name, value):
            yield name, value


def _unknown(graph: CellGraph) -> Iterator[Values]:
    return ((name,) for name, value in version_tuple(graph.cell).items() if value == UNKNOWN)


def _command(name: str, value: str) -> str:
    """Return what shows an installed version, empty where people read it."""
    part, words = name.rpartition(".")[2], value.split()
    if value == UNKNOWN:
        return ""
    if part in _OF_SYSTEM:
        return _OF_SYSTEM[part]
    if part in _PACKAGES:
        return f"ros2 pkg xml -t version {_PACKAGES[part]}"
    return f"ros2 pkg xml -t version {shell_word(words[0])}" if part in _INSTALLED and len(words) == 2 else ""


def _calibrated_frames(graph: CellGraph) -> Iterator[Values]:
    return ((one.name, one.calibration) for one in graph.cell.frames if one.calibration is not None)


def _mock_statements(graph: CellGraph) -> Iterator[Values]:
    return ((device.name, name, said.by, said.date) for device, name, said in graph.cell.signed_for_mock())


def _managers(graph: CellGraph) -> Iterator[Values]:
    return ((f"{manager.namespace}/controller_manager",) for manager in graph.cell.managers)


def _mock_actions(graph: CellGraph) -> Iterator[Values]:
    return ((one.action,) for one in graph.cell.controllers if one.action and "mock" in one.targets)


def _joint_states(graph: CellGraph) -> Iterator[Values]:
    return ((one.name,) for one in _on_real(graph) if one.type == JOINT_STATE_TYPE and one.sinks)


def _managed_nodes(graph: CellGraph) -> Iterator[Values]:
    for node in graph.cell.nodes:
        if node.lifecycle:
            yield node.full_name, "inactive" if asks_for_motion(graph.cell, node) else "active"


def _stopping_devices(graph: CellGraph) -> Iterator[Values]:
    for device in graph.cell.devices:
        if stops := [f"{state.name} ({state.reported})" for state in device.safety.states if state.stops]:
            yield device.name, ", ".join(stops)


def _loaded_devices(graph: CellGraph) -> Iterator[Values]:
    text = graph.cell.text
    for device in graph.cell.devices:
        if device.payload is not None:
            payload = (*device.path, "payload")
            yield device.name, text(*payload, "mass"), text(*payload, "center_of_mass")


def _first_motion(graph: CellGraph) -> Iterator[Values]:
    first = graph.cell.bringup.first_motion
    if first is not None:
        written = (graph.cell.text("bringup", "first_motion", part) for part in ("max_delta", "velocity", "timeout"))
        yield first.joint, first.direction, *written


def _missing_first_motion(graph: CellGraph) -> Iterator[Values]:
    return iter(((),) if graph.cell.bringup.first_motion is None else ())


def _stop_reasons(graph: CellGraph) -> Iterator[Values]:
    first = graph.cell.bringup.first_motion
    return ((reason,) for reason in (() if first is None else first.stop_if))


def _by_vendors(graph: CellGraph, *, shows: bool = False, powers: bool = False) -> Iterator[Values]:
    """Yield what the vendors have people do in the gates, or what must show there once something was released.

    What gives drives their power is yielded by itself: a stop is tried on drives that can lose it.
    """
    for device in graph.cell.devices:
        for step in device.commissioning:
            if (step.shows, step.powers) == (shows, powers):
                yield device.name, step.does, _newest_of(step.log), step.gate


def _newest_of(lines: tuple[str, ...]) -> str:
    """Return what prints the newest line of the logs of this host that holds one of these texts; empty for none."""
    wanted = " ".join(f"-e {shell_word(line)}" for line in lines)
    newest = "xargs -r -d '\\n' ls -t | head -n 1 | xargs -r -d '\\n'"
    found = f'grep -rlF {wanted} "$(printenv ROS_LOG_DIR || echo ~/.ros/log)"'
    return f"{found} | {newest} grep -hF {wanted} | tail -n 1" if lines else ""


def _nominal_devices(graph: CellGraph) -> Iterator[Values]:
    for device in graph.cell.devices:
        if device.kinematics is not None and device.kinematics.calibration is None:
            yield device.name, device.kinematics.tool


def _calibrated_devices(graph: CellGraph) -> Iterator[Values]:
    for device in graph.cell.devices:
        one = None if device.kinematics is None else device.kinematics.calibration
        if one is not None:
            path = f"cells/{graph.cell.name}/{one.name}"
            yield device.name, one.name, one.hash, one.measured, one.owner, one.sha256, path


def _released(graph: CellGraph, release: Release, phase: BringUpPhase) -> Iterator[Values]:
    """Yield the one command of a release, where the real target has a step in its phase."""
    if phase in phases(bring_up(graph.cell), "real"):
        yield (release_once(graph.cell, release),)


def _real_actions(graph: CellGraph) -> Iterator[Values]:
    return ((one.name,) for one in _on_real(graph) if one.kind is InterfaceKind.ACTION)


def _cancels(graph: CellGraph) -> Iterator[Values]:
    for interface in _on_real(graph):
        if interface.cancel_within_s is not None:
            yield interface.name, shortest(interface.cancel_within_s)


def _cards(graph: CellGraph) -> Iterator[Values]:
    return ((nic.full_name, nic.text, ", ".join(nic.carries) or "nothing stated") for nic in graph.network.nics)


def _reached_devices(graph: CellGraph) -> Iterator[Values]:
    for one in graph.network.devices:
        if one.text is not None:
            yield one.host, one.device, one.nic or "not stated", one.text


def _devices(graph: CellGraph) -> Iterator[Values]:
    return ((one.name, one.versions.serial, one.versions.firmware) for one in graph.cell.devices)


def _interfaces(graph: CellGraph) -> Iterator[Values]:
    late = {node.name for node in motion_clients(graph.cell) if started_by_a_person(graph.cell, node)}

    def names(ends: tuple[Endpoint, ...]) -> str:
        return ", ".join(end.node + (" (from G7 on)" if end.node in late else "") for end in ends) or "nobody"

    for one in _on_real(graph):
        yield one.name, names(one.sources), names(one.sinks), _info(one)


def _info(interface: Interface) -> str:
    if interface.kind is InterfaceKind.ACTION:
        return f"ros2 action info {shell_word(interface.name)}"
    if interface.kind is InterfaceKind.SERVICE:
        return f"ros2 service type {shell_word(interface.name)}"
    return f"ros2 topic info -v {shell_word(interface.name)}"


def _streams(graph: CellGraph) -> Iterator[Values]:
    for one in _on_real(graph):
        if one.kind is InterfaceKind.TOPIC and one.rate_hz is not None:
            # What is measured is the sum of all sources, and the interface has the rate of the slowest manager.
            several = f" or more: {len(one.sources)} sources add up" if len(one.sources) > 1 else ""
            age = (
                "with no bound on its age"
                if one.max_age_s is None
                else f"no sample older than {shortest(one.max_age_s)} s"
            )
            yield one.name, f"{shortest(one.rate_hz)} Hz{several}", age


def _bounded_clocks(graph: CellGraph) -> Iterator[Values]:
    for host in graph.cell.hosts.values():
        if host.clock.max_offset_s is not None:
            yield host.name, graph.cell.text(*host.path, "clock", "max_offset")


def _on_real(graph: CellGraph) -> Iterator[Interface]:
    return (interface for interface in graph.cell.interfaces if "real" in interface.targets)


def _each(values: tuple[str, ...]) -> Iterator[Values]:
    return ((value,) for value in values)


_SUBJECTS: Mapping[str, tuple[Values, Callable[[CellGraph], Iterator[Values]]]] = {
    "installed_part": (("part", "version", "command"), _installed),
    "built_part": (("part", "version", "command"), _built),
    "visible_part": (("part", "version"), _visible),
    "unknown_part": (("part",), _unknown),
    "nominal_device": (("device", "tool"), _nominal_devices),
    "calibrated_device": (("device", "file", "hash", "measured", "owner", "sha256", "path"), _calibrated_devices),
    "calibrated_frame": (("frame", "calibration"), _calibrated_frames),
    "mock_statement": (("device", "loaded", "by", "date"), _mock_statements),
    "mock_motion": (("command",), lambda graph: _each(move_mock(graph.cell))),
    "manager": (("manager",), _managers),
    "mock_action": (("action",), _mock_actions),
    "real_start": (("command",), lambda graph: _each(start_real(graph.cell))),
    "joint_states": (("topic",), _joint_states),
    "managed_node": (("node", "state"), _managed_nodes),
    "stopping_device": (("device", "states"), _stopping_devices),
    "loaded_device": (("device", "mass", "center_of_mass"), _loaded_devices),
    "stop_evidence": (("evidence",), lambda graph: _each(graph.cell.safety.stop.evidence)),
    "first_motion": (("joint", "direction", "max_delta", "velocity", "timeout"), _first_motion),
    "missing_first_motion": ((), _missing_first_motion),
    "stop_reason": (("reason",), _stop_reasons),
    "vendor_step": (("device", "does", "command", "gate"), _by_vendors),
    "vendor_power": (("device", "does", "command", "gate"), lambda graph: _by_vendors(graph, powers=True)),
    "vendor_sign": (("device", "does", "command", "gate"), lambda graph: _by_vendors(graph, shows=True)),
    "real_activation": (("command",), lambda graph: _released(graph, ACTIVATE, BringUpPhase.ACTIVATE)),
    "real_claim": (("command",), lambda graph: _released(graph, CLAIM, BringUpPhase.CLAIM)),
    "real_motion": (("command",), lambda graph: _each(move_real(graph.cell))),
    "real_action": (("action",), _real_actions),
    "cancel": (("action", "seconds"), _cancels),
    "card": (("card", "address", "carries"), _cards),
    "reached_device": (("host", "device", "card", "address"), _reached_devices),
    "device": (("device", "serial", "firmware"), _devices),
    "interface": (("interface", "starts", "ends", "command"), _interfaces),
    "stream": (("topic", "rate", "age"), _streams),
    "bounded_clock": (("host", "offset"), _bounded_clocks),
    "group": (("tip", "base"), lambda graph: ((one.tip_frame, one.base_link) for one in graph.cell.groups)),
    "described_node": (("node",), lambda graph: _each(description_nodes(graph.cell))),
}
_OF_CELL = ("cell", "build", "description", "start_mock", "record", "domain", "stop_authority", "stop_path")

FIELDS: Mapping[str, Values] = {
    CELL: ("gate", *_OF_CELL, "observer", "attempt_fields"),
    **{name: fields for name, (fields, _) in _SUBJECTS.items()},
}
"""What a text of each subject may name; what the cell has every text may name."""

ROWS: Mapping[str, Callable[[CellGraph], Iterator[Values]]] = {name: rows for name, (_, rows) in _SUBJECTS.items()}
"""The values of the fields, once for each subject that a cell has."""
