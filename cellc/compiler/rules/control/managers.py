"""Rules on controller managers: their rates, names, and what they load."""

from __future__ import annotations

import math
from operator import itemgetter

from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.link.names import JOINT_STATES
from cellc.compiler.rules.advice import add_controllers
from cellc.compiler.rules.described import in_its_file
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.vocabulary import Need


@rule(Severity.ERROR)
def controller_faster_than_manager(graph: CellGraph) -> Findings:
    """Yield controllers with a rate above that of their manager."""
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.update_rate_hz is not None and controller.update_rate_hz > manager.update_rate_hz:
                message = (
                    f"`update_rate` of `{controller.name}` must be at most {manager.update_rate_hz:g} Hz, "
                    f"the rate of its manager, got {controller.update_rate_hz:g} Hz"
                )
                path = (*controller.path, "update_rate")
                related = enters(graph, "the rate of its manager", (*manager.path, "update_rate"))
                yield found(graph, path, message, f"write at most {manager.update_rate_hz:g} Hz", related)


@rule(Severity.ERROR)
def device_apart_from_its_manager(graph: CellGraph) -> Findings:
    """Yield devices of a manager that are connected to another host than its own."""
    devices = {device.name: device for device in graph.cell.devices}
    for manager in graph.cell.managers:
        for name in manager.devices:
            device = devices[name]
            link = device.site.connection
            if link is None or device.control.hardware is None or link.host == manager.host or not manager.host:
                continue
            message = f"`{name}` must be connected to `{manager.host}`, where its controller manager runs, got"
            related = (Related("the manager", graph.cell.locate(*manager.path, "host")),)
            yield found(graph, (*device.path, "connection", "host"), f"{message} `{link.host}`", related=related)


@rule(Severity.ERROR, assumes=("shared-manager-name",))
def device_of_two_managers(graph: CellGraph) -> Findings:
    """Yield controllers of a device that another manager drives: with them this one loads its hardware too."""
    driven: dict[str, dict[str, list[Controller]]] = {}
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.device in manager.devices:
                driven.setdefault(controller.device or "", {}).setdefault(manager.name, []).append(controller)
    for device, by_manager in driven.items():
        home = max(by_manager, key=lambda name: len(by_manager[name]))
        for name, controllers in by_manager.items():
            for controller in controllers if name != home else ():
                message = f"`{controller.name}` of `{name}` drives `{device}`, whose hardware `{home}` loads already"
                related = (Related("driven here", by_manager[home][0].span),)
                advice = f"write a device of `{name}`, or move the controller to `{home}`"
                yield found(graph, (*controller.path, "device"), message, advice, related)


@rule(Severity.ERROR)
def missing_joint_states(graph: CellGraph) -> Findings:
    """Yield managers that drive joints without an active controller that says their states where all read them."""
    for manager in graph.cell.managers:
        active = (controller for controller in manager.controllers if controller.active)
        topics = {topic.name for controller in active for topic in controller.own_topics if topic.publishes}
        if JOINT_STATES in topics or not any(c.command_interfaces and c.joints for c in manager.controllers):
            continue
        message = f"no controller of `{manager.name}` publishes joint states"
        local = (other for other in manager.controllers if other.written_parameters.get(_LOCAL) is True)
        apart = next(local, None)
        if apart is None:
            yield found(graph, (*manager.path, "controllers"), message)
            continue
        path = (*apart.path, "parameters", _LOCAL)
        message += f" on `{JOINT_STATES}`: those of `{apart.name}` are on `{apart.full_name}{JOINT_STATES}`"
        yield found(graph, path, f"{message}, which robot_state_publisher does not read", f"remove `{_LOCAL}`")


_LOCAL = "use_local_topics"


@rule(Severity.ERROR)
def refused_update_rate(graph: CellGraph) -> Findings:
    """Yield managers whose rate a device that they drive does not list."""
    for manager in graph.cell.managers:
        for device in (graph.cell.device(name) for name in manager.devices):
            rates = device.control.update_rates_hz
            if rates and all(abs(rate - manager.update_rate_hz) > 1e-9 for rate in rates):
                accepted = " or ".join(f"{rate:g} Hz" for rate in rates)
                message = f"`update_rate` for `{device.name}` must be {accepted}, got {manager.update_rate_hz:g} Hz"
                path = (*manager.path, "update_rate")
                advice = f"write {accepted}, or give the device a manager of its own"
                yield found(graph, path, message, advice, in_its_file(device, "control", "update_rates"))


@rule(Severity.ERROR)
def shared_manager_name(graph: CellGraph) -> Findings:
    """Yield managers whose namespace is taken."""
    first: dict[str, ControllerManager] = {}
    for manager in graph.cell.managers:
        earlier = first.setdefault(manager.namespace, manager)
        if earlier is not manager:
            name = manager.namespace or "/"
            message = f"managers `{earlier.name}` and `{manager.name}` are both in namespace `{name}`"
            related = (Related("the first is here", earlier.span),)
            yield found(graph, manager.path, message, related=related)


@rule(Severity.WARNING)
def uneven_update_rate(graph: CellGraph) -> Findings:
    """Yield controllers whose rate does not divide that of their manager."""
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            rate = controller.update_rate_hz
            if not rate or rate > manager.update_rate_hz:
                continue
            cycles = manager.update_rate_hz / rate
            if abs(cycles - round(cycles)) > 1e-6:
                even = manager.update_rate_hz / math.ceil(cycles)
                message = (
                    f"`update_rate` of `{controller.name}` must divide {manager.update_rate_hz:g} Hz, got {rate:g} Hz"
                )
                related = enters(graph, "the rate of its manager", (*manager.path, "update_rate"))
                yield found(graph, (*controller.path, "update_rate"), message, f"write {even:g} Hz", related)


_LOST = {
    Need.PROGRAM_RUNNING: "its program stops",
    Need.NOT_PAUSED: "its program pauses",
    Need.NO_STOP: "it is stopped",
    Need.BRAKES_OPEN: "its brakes close",
    Need.NO_FAULT: "it has a fault",
}


@rule(Severity.BLOCKER, assumes=("shared-prefix",))
def unwatched_claim(graph: CellGraph) -> Findings:
    """Yield controllers whose claims a real robot keeps over a stop or pause that no topic of the cell reports."""
    for manager in graph.cell.managers:
        claiming: dict[str, dict[int, Controller]] = {}
        for number, controller in enumerate(manager.controllers):
            for interface in controller.command_interfaces if "real" in controller.targets else ():
                claiming.setdefault(interface.rpartition("/")[0], {})[number] = controller
        telling = {
            (controller.kind, controller.device)
            for controller in manager.controllers
            if controller.active and "real" in controller.targets
        }
        for name in manager.devices:
            device = graph.cell.device(name)
            hardware = device.control.hardware
            if hardware is None or "real" not in hardware.targets or not hardware.kept_by_a_claim:
                continue
            reports = hardware.heard_before_a_claim
            unheard = [
                need
                for need in hardware.kept_by_a_claim
                if need not in reports or (reports[need].controller_kind, name) not in telling
            ]
            if not unheard:
                continue
            kinds = dict.fromkeys(reports[need].controller_kind for need in unheard if need in reports)
            owners = {
                number: controller
                for joint in device.joints
                for number, controller in claiming.get(joint.name, {}).items()
            }
            advice = (
                add_controllers(device, kinds, graph.cell.distro)
                if kinds
                else f"say under `reported_by` of the `device.yaml` of `{name}` which topic reports that"
            )
            lost = " or ".join(_LOST.get(need, f"`{need}` ends") for need in unheard)
            for _, controller in sorted(owners.items(), key=itemgetter(0)):
                message = f"`{name}` keeps the set points of `{controller.name}` when {lost}, and nothing reports this"
                yield found(graph, controller.path, message, advice)
