"""Rules on hardware components: their plugins, interfaces and joints."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.real_target import unmoved_on_real
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.WARNING, assumes=("unprovided-command-interface", "trajectory-without-gains"))
def command_against_vendor(graph: CellGraph) -> Findings:
    """Yield controllers without what the vendor's own claim of a joint on the real target."""
    for controller in graph.cell.controllers:
        vendor = controller.vendor
        if vendor is None or "real" not in controller.targets:
            continue
        claimed = tuple(dict.fromkeys(name.rpartition("/")[2] for name in controller.claims("real")))
        if not set(vendor.interfaces) <= set(claimed):
            theirs = " + ".join(vendor.interfaces)
            message = (
                f"`{controller.name}` commands {' + '.join(claimed)} of `{controller.device}`, but its vendor "
                f"commands {theirs}: {vendor.because}"
            )
            yield found(graph, (*controller.path, "command_interfaces"), message)


@rule(Severity.ERROR)
def component_named_twice(graph: CellGraph) -> Findings:
    """Yield each device of a manager whose component has the name of an earlier one's."""
    for manager in graph.cell.managers:
        first: dict[str, Device] = {}
        for device in map(graph.cell.device, manager.devices):
            if device.control.hardware is None:
                continue
            earlier = first.setdefault(device.control.hardware.name, device)
            if earlier is not device:
                message = f"`{device.name}` and `{earlier.name}` both have the hardware component"
                message += f" `{device.control.hardware.name}` under `{manager.node}`"
                related = (Related(f"`{earlier.name}` is here", earlier.span),)
                yield found(graph, device.path, message, related=related)


@rule(Severity.BLOCKER, assumes=("shared-prefix",))
def interface_exported_twice(graph: CellGraph) -> Findings:
    """Yield each device of a manager that exports what an earlier one exports, one finding a device."""
    for manager in graph.cell.managers:
        first: dict[str, Device] = {}
        for device in map(graph.cell.device, manager.devices):
            twice = [name for name in _exported(device) if first.setdefault(name, device) is not device]
            if twice:
                earlier = first[twice[0]]
                more = f" and {len(twice) - 1} more" if len(twice) > 1 else ""
                message = f"`{device.name}` and `{earlier.name}` both export `{twice[0]}`{more} to `{manager.node}`"
                related = (Related(f"`{earlier.name}` is here", earlier.span),)
                yield found(graph, device.path, message, related=related)


def _exported(device: Device) -> Iterator[str]:
    """Yield the interfaces of sensors and gpios by full name; joints are named once in a cell."""
    hardware = device.control.hardware
    for group in () if hardware is None else (*hardware.sensors, *hardware.gpios):
        yield from (f"{group.name}/{name}" for name in (*group.command_interfaces, *group.state_interfaces))


@rule(Severity.BLOCKER)
def missing_real_plugin(graph: CellGraph) -> Findings:
    """Yield devices with joints that a controller names, and neither a plugin nor a driver on the real target."""
    for device, joint in unmoved_on_real(graph.cell):
        message = (
            f"nothing moves `{joint.name}` of `{device.name}` on the real target, because its model has no plugin there"
        )
        yield found(graph, device.path, message)


@rule(Severity.ERROR, assumes=("unprovided-command-interface",))
def refused_interface_combination(graph: CellGraph) -> Findings:
    """Yield controllers with a combination that their kind does not list."""
    for controller in graph.cell.controllers:
        kind = controller.declared
        if kind is None or not kind.command_combinations or not controller.joints:
            continue
        prefix = f"{controller.joints[0]}/"
        for claims in dict.fromkeys(controller.claims(target) for target in controller.targets):
            names = tuple(c.removeprefix(prefix) for c in claims if c.startswith(prefix))
            if names not in kind.command_combinations:
                allowed = "; ".join(", ".join(combination) for combination in kind.command_combinations)
                message = f"`{controller.name}` refuses the command interfaces {' + '.join(names)}"
                yield found(graph, (*controller.path, "command_interfaces"), message, f"use one of: {allowed}")


@rule(Severity.ERROR)
def renamed_joints(graph: CellGraph) -> Findings:
    """Yield devices with a prefix whose real plugin knows no other names than its own."""
    for device in graph.cell.devices:
        hardware, prefix = device.control.hardware, device.body.prefix
        if hardware is not None and hardware.fixed_joint_names and prefix:
            joint = device.actuated_joints[0].local_name
            message = (
                f"the driver of `{device.name}` fixes its joint names, such as `{joint}`, got the prefix `{prefix}`"
            )
            yield found(graph, (*device.path, "prefix"), message)


@rule(Severity.ERROR)
def wrong_joint_count(graph: CellGraph) -> Findings:
    """Yield controllers without a joint where their kind names joints, or with several where it names one."""
    for controller in graph.cell.controllers:
        kind = controller.declared
        number = len(controller.joints)
        if kind is None or kind.joints_parameter is None or number == 1 or (number and not kind.single_joint):
            continue
        expected = "one joint" if kind.single_joint else "at least one joint"
        got = f"none: no joint of `{controller.device}` is driven" if number == 0 else str(number)
        message = f"expected {expected} for `{controller.name}` of kind `{controller.kind}`, got {got}"
        help_text = "name the device whose joints it drives" if number == 0 else "name the one joint under `joints`"
        yield found(graph, (*controller.path, "device"), message, help_text)


@rule(Severity.ERROR, assumes=("circular-mimic", "mimic-of-nothing", "mimic-of-fixed-joint"))
def follower_without_leader(graph: CellGraph) -> Findings:
    """Yield joints with interfaces that follow one without: the controller manager refuses the description."""
    for device in graph.cell.devices:
        listed = {joint.name for joint in device.joints if joint.command_interfaces or joint.state_interfaces}
        for joint in device.joints if device.control.hardware is not None else ():
            if joint.name in listed and joint.mimics is not None and joint.mimics not in listed:
                message = f"`{joint.name}` follows `{joint.mimics}`, which must be in the `control` of its device, too"
                yield found(graph, (*device.path, "model"), message)
