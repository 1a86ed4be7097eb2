"""Rules on what is started in which order, and on what no text of it may hold."""

from __future__ import annotations

import re

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.graph.claims import written_parameters
from cellc.compiler.graph.data_flow import known_executables, program_types
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, did_you_mean, found, rule
from cellc.contract.diagnostics.nearest import is_slip

_CREDENTIALS = (
    ("an address with a password", re.compile(r"(?<=[A-Za-z0-9+.-])://[^/\s:@]*:[^/\s@]+@")),
    ("a private key", re.compile(r"-----BEGIN [A-Z ]*PRIVATE KEY-----")),
    ("an access token", re.compile(r"\b(?:gh[opsu]_[A-Za-z0-9]{36}|glpat-[A-Za-z0-9_-]{20}|AKIA[A-Z0-9]{16})\b")),
)


@rule(Severity.ERROR, assumes=("secret-in-spec",))
def credential_in_text(graph: CellGraph) -> Findings:
    """Yield texts that look like a credential, wherever they stand."""
    for path, text in graph.cell.places.texts.items():
        kind = next((kind for kind, pattern in _CREDENTIALS if pattern.search(text)), None)
        if kind is not None:
            message = f"the text holds {kind}"
            yield found(graph, path, message)


@rule(Severity.WARNING)
def unused_credentials(graph: CellGraph) -> Findings:
    """Yield places of user names and passwords that no driver reads."""
    for device in graph.cell.devices:
        path = (*device.path, "connection", "credentials")
        if path in graph.cell.places.texts and not _logs_in(device):
            yield found(graph, path, f"the driver of `{device.name}` reads no user name and no password")


def _logs_in(device: Device) -> bool:
    hardware = device.control.hardware
    values = () if hardware is None else hardware.parameters.get("real", {}).values()
    return any(word in value for value in values for word in ("{env:", "{yaml:"))


_SECRET = re.compile(r"(?i)(^|_|\.)(password|passwd|passphrase|secret|token|api_?key|private_?key|credential)s?$")


@rule(Severity.ERROR)
def secret_in_spec(graph: CellGraph) -> Findings:
    """Yield parameters of nodes and controllers whose name says that they are secret and that hold a text."""
    for node in graph.cell.nodes:
        if node.source is not NodeSource.SPEC:
            continue
        for name, value in node.parameters.items():
            if value and isinstance(value, str) and _SECRET.search(name):
                path = (*node.path, "parameters", name)
                message = f"parameter `{name}` of `{node.name}` holds a secret"
                yield found(graph, path, message)
    for parameter in written_parameters(graph.cell):
        if parameter.value and isinstance(parameter.value, str) and _SECRET.search(parameter.name):
            message = f"parameter `{parameter.name}` of `{parameter.controller.name}` holds a secret"
            yield found(graph, parameter.path, message)


@rule(Severity.ERROR, assumes=("second-action-server",))
def startup_cycle(graph: CellGraph) -> Findings:
    """Yield a circle of parts that wait for each other, with what each waits for."""
    cycle = graph.startup.cycle()
    if not cycle:
        return
    waits = list(zip(cycle, (*cycle[1:], cycle[0]), strict=True))
    first = {(need.part, need.needs): need for need in reversed(graph.startup.needs)}
    needs = [first[pair] for pair in waits]
    names = " → ".join(f"`{name}`" for name in (*cycle, cycle[0]))
    places = [graph.cell.locate("interfaces", need.proof) for need in needs]
    related = tuple(Related(f"`{n.part}` waits for `{n.proof}`", p) for n, p in zip(needs, places, strict=True))
    path = ("interfaces", needs[0].proof)
    message = f"parts wait for each other at start: {names}"
    yield found(graph, path, message, related=related[1:])


_LISTENERS = frozenset(
    ("foxglove_bridge", "plotjuggler", "rosbag2_transport", "rosbridge_server", "rqt_gui", "rviz2", "web_video_server")
)
"""Packages whose programs only show or record: nothing of the cell waits for them."""


@rule(Severity.ERROR)
def unproven_readiness(graph: CellGraph) -> Findings:
    """Yield nodes of the spec without a lifecycle, an interface, a frame or a controller that they command."""
    shown = {end.node for interface in graph.cell.interfaces for end in (*interface.sources, *interface.sinks)}
    shown |= {frame.authority for frame in graph.cell.frames}
    shown |= {controller.client for controller in graph.cell.controllers if controller.client}
    for node in graph.cell.nodes:
        if node.package in _LISTENERS:
            continue
        if node.source is NodeSource.SPEC and not node.lifecycle and node.name not in shown:
            message = f"no state, interface or transform shows that `{node.name}` is ready"
            yield found(graph, node.path, message)


@rule(Severity.ERROR)
def unmanaged_program(graph: CellGraph) -> Findings:
    """Yield nodes that are said to be managed, although the catalog knows their program as a plain node."""
    for node in graph.cell.nodes:
        if node.source is NodeSource.SPEC and node.lifecycle and program_types(graph.cell, node) is not None:
            message = (
                f"`{node.package}/{node.executable}` is not a managed node: the bring-up would wait for its states"
            )
            yield found(graph, (*node.path, "lifecycle"), message)


_LAUNCH_FILES = (".launch.py", ".launch.xml", ".launch.yaml")


@rule(Severity.ERROR)
def unknown_executable(graph: CellGraph) -> Findings:
    """Yield launch files that are given as programs, and programs that are one slip away from a known one."""
    for node in graph.cell.nodes:
        if node.source is not NodeSource.SPEC:
            continue
        path, program = (*node.path, "run"), f"{node.package}/{node.executable}"
        if node.executable.endswith(_LAUNCH_FILES):
            message = f"`{node.name}` must run a program, got the launch file `{program}`"
            yield found(graph, path, message, "name the program that the launch file starts, as `package/executable`")
            continue
        known = known_executables(node.package)
        if known and node.executable not in known and any(is_slip(node.executable, name) for name in known):
            message = f"`{node.package}` has no program `{node.executable}`"
            yield found(graph, path, message, did_you_mean(node.executable, known, f"programs of `{node.package}`"))
