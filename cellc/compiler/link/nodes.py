"""Binds the nodes of the spec and adds those that devices and controller managers bring along."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import Callback, Node, NodeSource, ParameterValue
from cellc.compiler.link.devices import BoundDevice
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.compiler.link.hardware import camera_parameters, driver_remaps, run_nodes
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.names import JOINT_STATES, home_host, unknown_name
from cellc.compiler.link.programs import endpoints
from cellc.compiler.link.quantities import si
from cellc.compiler.link.robot import node_parameters
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.interfaces import CallbackSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, YamlPath
from cellc.contract.vocabulary import UNKNOWN

DESCRIPTION = "/robot_description"
"""The topic of a description, below the namespace of who publishes it."""
DESCRIPTION_PUBLISHER = "description_publisher"
"""Says the description of one of several controller managers."""

_RUN = re.compile(r"[A-Za-z][A-Za-z0-9_-]*/[A-Za-z0-9_][A-Za-z0-9_.+-]*")
"""A package as REP-144 and REP-127 name it, and a file that `ros2 run` finds in its folder of programs."""


def link_nodes(spec: CellSpec, document: SourceDocument, devices: tuple[BoundDevice, ...]) -> Outcome[tuple[Node, ...]]:
    """Bind the nodes of the spec to their hosts, and add the drivers that the catalog names."""
    nodes: list[Node] = []
    problems = [_not_a_run(run, document, path) for run, path in _runs(spec) if not _RUN.fullmatch(run)]
    for name, node in until_hopeless(spec.nodes.items(), problems):
        path = ("nodes", name)
        package, _, executable = node.run.partition("/")
        if node.host is not None and node.host not in spec.hosts:
            problems.append(unknown_name("unknown-host", node.host, "host", spec.hosts, document, (*path, "host")))
        nodes.append(
            Node(
                name=name,
                path=path,
                span=document.locate(path),
                source=NodeSource.SPEC,
                package=package,
                executable=executable,
                namespace=node.namespace,
                host=node.host or home_host(spec),
                lifecycle=node.lifecycle,
                owner=node.owner,
                language=node.language,
                clock=node.clock,
                respawn=node.respawn,
                executor=node.executor,
                threads=node.threads,
                callbacks={label: _callback(row) for label, row in node.callbacks.items()},
                parameters=dict(node.parameters),
            )
        )
    return Outcome((*nodes, *_adapter_nodes(spec, devices), *_driver_nodes(spec, devices)), tuple(problems))


def _callback(written: CallbackSpec) -> Callback:
    return Callback(
        takes_s=si(written.takes),
        group=written.group or "",
        reentrant=written.reentrant,
        waits_for=written.waits_for,
        period_s=si(written.period),
    )


def _runs(spec: CellSpec) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the programs that the spec names, each with its place."""
    for name, node in spec.nodes.items():
        yield node.run, ("nodes", name, "run")
    for name, device in spec.devices.items():
        if device.adapter is not None and device.adapter.run != UNKNOWN:
            yield device.adapter.run, ("devices", name, "adapter", "run")


def standard_nodes(
    spec: CellSpec, document: SourceDocument, managers: tuple[ControllerManager, ...]
) -> tuple[Node, ...]:
    """Return robot_state_publisher and one node for each controller manager, with what several of them need."""
    publisher = _description_publisher(
        spec, ROBOT_STATE_PUBLISHER, ("devices",), document.locate(("devices",)), home_host(spec)
    )
    return (
        publisher,
        *(_manager_node(spec, manager) for manager in managers),
        *(_own_description(spec, manager) for manager in managers if len(managers) > 1),
    )


def _manager_node(spec: CellSpec, manager: ControllerManager) -> Node:
    # Everybody listens to one topic, wherever the manager is: publishers of joint states are distinguished by joint.
    topic = f"{manager.namespace}{JOINT_STATES}"
    return Node(
        name="controller_manager",
        path=manager.path,
        span=manager.span,
        source=NodeSource.STANDARD,
        package="controller_manager",
        executable="ros2_control_node",
        namespace=manager.namespace,
        host=manager.host,
        owner=spec.owners.responsibilities.command,
        language="cpp",
        parameters={},
        remaps={} if topic == JOINT_STATES else {topic: JOINT_STATES},
    )


def _own_description(spec: CellSpec, manager: ControllerManager) -> Node:
    """Return the node that says which hardware one of several managers drives.

    It is a robot_state_publisher of which only the description is wanted: it hears no joint states, and its transforms
    go where nothing listens, so that those of the cell keep one authority.
    """
    home = description_home(manager)
    apart = {"/tf": "/tf", "/tf_static": "/tf_static", f"{home}{JOINT_STATES}": JOINT_STATES}
    node = _description_publisher(spec, DESCRIPTION_PUBLISHER, manager.path, manager.span, manager.host)
    return replace(node, namespace=home, remaps={name: f"{home}/unused{topic}" for name, topic in apart.items()})


def description_home(manager: ControllerManager) -> str:
    """Return the namespace in which the description of one of several managers is published."""
    return manager.namespace or f"/{manager.name}"


def _description_publisher(spec: CellSpec, name: str, path: YamlPath, span: Span, host: str) -> Node:
    return Node(
        name=name,
        path=path,
        span=span,
        source=NodeSource.STANDARD,
        package=ROBOT_STATE_PUBLISHER,
        executable=ROBOT_STATE_PUBLISHER,
        host=host,
        owner=spec.owners.responsibilities.frames,
        language="cpp",
        parameters={},
    )


def _adapter_nodes(spec: CellSpec, devices: tuple[BoundDevice, ...]) -> Iterator[Node]:
    """Yield the programs that reach a device by the library of its vendor: never beside the mock, whatever they are."""
    for device in (bound.device for bound in devices):
        adapter = spec.devices[device.name].adapter
        if device.architecture == "direct_sdk" and adapter is not None and adapter.run != UNKNOWN:
            package, _, executable = adapter.run.partition("/")
            yield Node(
                name=device.name,
                path=(*device.path, "adapter"),
                span=device.span,
                source=NodeSource.DEVICE,
                package=package,
                executable=executable,
                host=device.site.host or home_host(spec),
                owner=spec.owners.responsibilities.vendor_safety,
                real_only=True,
                device=device.name,
                parameters=_reached(device),
            )


def _reached(device: Device) -> dict[str, ParameterValue]:
    way = device.site.connection
    if way is None or (way.address or way.port) is None:
        return {}
    return {"address": way.address} if way.address is not None else {"port": way.port or UNKNOWN}


def _driver_nodes(spec: CellSpec, devices: tuple[BoundDevice, ...]) -> Iterator[Node]:
    for bound in devices:
        device, known = bound.device, bound.names
        for entry in run_nodes(bound.facts, known, device.software.versions.firmware):
            namespace, _, name = f"/{known.fill(entry.name)}".rpartition("/")
            yield Node(
                name=name,
                path=device.path,
                span=device.span,
                source=NodeSource.DEVICE,
                package=entry.package,
                executable=entry.executable,
                namespace=namespace,
                host=device.site.host,
                owner=spec.owners.responsibilities.vendor_safety,
                language="cpp",
                real_only=entry.provides == "real",
                device=device.name,
                parameters={
                    **known.fill_parameters(entry.parameters),
                    **camera_parameters(bound.facts, spec.devices[device.name]),
                    **node_parameters(bound.facts, spec.devices[device.name], entry.name),
                },
                remaps=driver_remaps(bound.facts, entry, known),
                endpoints=endpoints(entry.endpoints, known.fill),
            )


def _not_a_run(run: str, document: SourceDocument, path: tuple[str, ...]) -> Diagnostic:
    return Diagnostic(
        code="not-an-executable",
        severity=Severity.ERROR,
        message=f"`run` must be the name of a package and that of an executable, got `{run}`",
        span=document.locate(path),
        yaml_path=path,
        help="write `package/executable`, such as `cell_tasks/pick_place`",
    )
