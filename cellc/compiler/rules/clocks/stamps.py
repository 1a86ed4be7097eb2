"""Rules on what stamps a sample, and on the clock that it reads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Interface, Node
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule
from cellc.contract.vocabulary import UNKNOWN

_OTHER_CLOCK = {"wall": "sim", "sim": "wall"}


@rule(Severity.ERROR)
def contradicting_time_source(graph: CellGraph) -> Findings:
    """Yield interfaces whose time source is not that of a node or device that publishes them."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.time_source is None:
            continue
        for node, clock in _clocks(graph, interface):
            hardware = interface.time_source == "hardware" and clock != "hardware"
            if hardware or clock == _OTHER_CLOCK.get(interface.time_source):
                message = (
                    f"`{interface.name}` claims {interface.time_source} stamps, but `{node}` stamps with {clock} time"
                )
                yield found(graph, (*interface.path, "time_source"), message)
                break


def _clocks(graph: CellGraph, interface: Interface) -> Iterator[tuple[str, str]]:
    """Yield each publisher with its clock: what a sensor states, what a node runs on, or that of all targets."""
    clocks = graph.once(_node_clocks)
    targets = {target.clock for target in graph.cell.targets.values()}
    common = targets.pop() if len(targets) == 1 else "ros"
    for source in interface.sources:
        stamp = graph.cell.stamp_of(source.node)
        yield source.node, clocks.get(source.node) or common if stamp is None else stamp.source


def _node_clocks(graph: CellGraph) -> Mapping[str, str | None]:
    return {node.name: node.clock for node in graph.cell.nodes}


_PARAMETER = "use_sim_time"


@rule(Severity.ERROR)
def mixed_clocks(graph: CellGraph) -> Findings:
    """Yield nodes and controllers whose clock is not that of a target that starts them, by whichever road it is set."""
    for node in graph.cell.nodes:
        clock, path = _stated(node)
        yield from _other_clock(graph, f"node `{node.name}`", clock, path)
    for controller in graph.cell.controllers:
        if isinstance(simulated := controller.written_parameters.get(_PARAMETER), bool):
            path = (*controller.path, "parameters", _PARAMETER)
            yield from _other_clock(graph, f"controller `{controller.name}`", "sim" if simulated else "wall", path)


def _stated(node: Node) -> tuple[str | None, YamlPath]:
    """Return the clock that a node gets, by its own key or by the parameter that ROS has for it."""
    simulated = node.parameters.get(_PARAMETER)
    if node.clock is None and isinstance(simulated, bool):
        return "sim" if simulated else "wall", (*node.path, "parameters", _PARAMETER)
    return node.clock, (*node.path, "clock")


def _other_clock(graph: CellGraph, who: str, clock: str | None, path: YamlPath) -> Findings:
    targets = {name: target.clock for name, target in graph.cell.targets.items()}
    other = next((name for name, target_clock in targets.items() if clock not in (None, target_clock)), None)
    if other is not None:
        yield found(graph, path, f"{who} runs on {clock} time, but target `{other}` on {targets[other]} time")


@rule(Severity.ERROR)
def moving_camera_stamped_on_arrival(graph: CellGraph) -> Findings:
    """Yield cameras that a joint carries and whose stamps are those of the arrival."""
    mounts = {frame.device: frame for frame in graph.cell.frames if frame.kind is FrameKind.MOUNT}
    for device in graph.cell.devices:
        mount = mounts.get(device.name)
        if (
            device.sensing.camera is None
            or device.sensing.stamp is None
            or device.sensing.stamp.source != "arrival"
            or mount is None
        ):
            continue
        moved = next((frame for frame in graph.frames.chain(mount.name) if frame.moving), None)
        if moved is not None:
            message = f"the stamp of `{device.name}` must be that of the exposure, because `{moved.device}` moves it,"
            message += " got `arrival`"
            related = (Related(f"it is mounted on `{mount.parent}`", mount.span),)
            yield found(graph, (*device.path, "stamp", "source"), message, related=related)


@rule(Severity.ERROR, assumes=("real-hardware-in-mock",))
def simulated_time_on_hardware(graph: CellGraph) -> Findings:
    """Yield targets with real hardware and the clock of a simulator."""
    for name, target in graph.cell.targets.items():
        if target.hardware == "real" and target.clock == "sim":
            path = ("targets", name, "clock")
            message = f"the clock of target `{name}` must be wall, because its hardware is real, got sim"
            yield found(graph, path, message)


@rule(Severity.ERROR)
def two_clock_domains(graph: CellGraph) -> Findings:
    """Yield hosts that run nodes in another clock domain than the controller manager, or than the first host."""
    running = {node.host for node in graph.cell.nodes}
    hosts = [host for host in graph.cell.hosts.values() if host.name in running]
    managing = {manager.host for manager in graph.cell.managers}
    hosts.sort(key=lambda host: host.name not in managing)
    for host in hosts[1:]:
        if host.clock.domain != hosts[0].clock.domain:
            message = f"the clock of `{host.name}` must be in the domain `{hosts[0].clock.domain}` of"
            message += f" `{hosts[0].name}`, got `{host.clock.domain}`"
            related = (Related("the other clock", graph.cell.locate(*hosts[0].path, "clock")),)
            yield found(graph, (*host.path, "clock", "domain"), message, related=related)


@rule(Severity.BLOCKER)
def unknown_stamp_source(graph: CellGraph) -> Findings:
    """Yield cameras whose stamp source or clock domain is UNKNOWN or not stated."""
    for device in graph.cell.devices:
        if device.kind != "camera":
            continue
        stamp = device.sensing.stamp
        path = (*device.path, "stamp")
        if stamp is None or stamp.source == UNKNOWN:
            yield found(graph, (*path, "source"), f"the stamp source of `{device.name}` is UNKNOWN")
        elif stamp.clock.domain == UNKNOWN:
            yield found(graph, (*path, "clock"), f"the clock domain of `{device.name}` is UNKNOWN")
