"""Binds the nodes of the spec and adds those that devices and controller managers bring along."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.control import ControllerManager
from cellc.cell.device import Device
from cellc.cell.interface import Node, NodeSource
from cellc.diagnostics import Diagnostic, Outcome, Severity
from cellc.link.frames import ROBOT_STATE_PUBLISHER
from cellc.link.placeholders import placeholders
from cellc.link.unknown import unknown_name
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec


def link_nodes(spec: CellSpec, document: SourceDocument, devices: tuple[Device, ...]) -> Outcome[tuple[Node, ...]]:
    """Bind the nodes of the spec to their hosts, and add the drivers that the catalogue names."""
    nodes: list[Node] = []
    problems: list[Diagnostic] = []
    for name, written in spec.nodes.items():
        path = ("nodes", name)
        package, _, executable = written.run.partition("/")
        if not package or not executable or "/" in executable:
            problems.append(_not_a_run(written.run, document, (*path, "run")))
        if written.host is not None and written.host not in spec.hosts:
            problems.append(unknown_name("unknown-host", written.host, "host", spec.hosts, document, (*path, "host")))
        nodes.append(
            Node(
                name=name,
                path=path,
                span=document.locate(path),
                source=NodeSource.SPEC,
                package=package,
                executable=executable,
                host=written.host or _only_host(spec),
                lifecycle=written.lifecycle,
                owner=written.owner,
                language=written.language,
                clock=written.clock,
                respawn=written.respawn,
                parameters=dict(written.parameters),
            )
        )
    return Outcome((*nodes, *_driver_nodes(spec, devices)), tuple(problems))


def standard_nodes(
    spec: CellSpec, document: SourceDocument, managers: tuple[ControllerManager, ...]
) -> tuple[Node, ...]:
    """Return robot_state_publisher and one node for each controller manager."""
    publisher = Node(
        name=ROBOT_STATE_PUBLISHER,
        path=("devices",),
        span=document.locate(("devices",)),
        source=NodeSource.STANDARD,
        package=ROBOT_STATE_PUBLISHER,
        executable=ROBOT_STATE_PUBLISHER,
        host=_only_host(spec),
        owner=spec.owners.responsibilities.frames,
        language="cpp",
        parameters={},
    )
    loops = tuple(
        Node(
            name="controller_manager",
            path=manager.path,
            span=manager.span,
            source=NodeSource.STANDARD,
            package="controller_manager",
            executable="ros2_control_node",
            namespace=manager.namespace,
            host=manager.host or _only_host(spec),
            owner=spec.owners.responsibilities.command,
            language="cpp",
            parameters={},
        )
        for manager in managers
    )
    return (publisher, *loops)


def _driver_nodes(spec: CellSpec, devices: tuple[Device, ...]) -> Iterator[Node]:
    for device in devices:
        connection = device.spec.connection
        known = placeholders(device.name, device.prefix, device.spec, spec)
        for entry in device.facts.nodes:
            namespace, _, name = known.fill(entry.name).rpartition("/")
            yield Node(
                name=name,
                path=device.path,
                span=device.span,
                source=NodeSource.DEVICE,
                package=entry.package,
                executable=entry.executable,
                namespace=namespace,
                host=connection.host if connection is not None else _only_host(spec),
                owner=spec.owners.responsibilities.vendor_safety,
                language="cpp",
                real_only=entry.provides == "real",
                device=device.name,
                parameters=known.fill_parameters(entry.parameters),
            )


def _only_host(spec: CellSpec) -> str | None:
    return next(iter(spec.hosts)) if len(spec.hosts) == 1 else None


def _not_a_run(run: str, document: SourceDocument, path: tuple[str, ...]) -> Diagnostic:
    return Diagnostic(
        code="not-an-executable",
        severity=Severity.ERROR,
        message=f"`{run}` is not a package and an executable",
        span=document.locate(path),
        yaml_path=path,
        help="write `package/executable`, such as `cell_tasks/pick_place`",
    )
