"""What real controller managers and the real bring-up are told, and QoS of nodes and recorder."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from cellc.contract.bring_up import Activation, HardwareActivation, Restart, Target
from cellc.contract.contract import Contract, ContractInterface, ContractQos
from cellc.contract.qos import recorder_depth, weakest
from cellc.mock.agreement.said import Edited, Names, Said, below, differing, parameters, plain

Side = Literal["publisher", "subscription"]
_NS = 1_000_000_000
_STANDARD = frozenset({"robot_state_publisher", "controller_manager"})
"""Names of nodes that no spec writes, so that nothing overrides their QoS."""


def real_controllers(edited: Edited, file: str) -> Iterator[str]:
    """Compare the parameter file of the real target, where it has one of its own, with the contract."""
    mock_file = file.replace(".real.yaml", ".mock.yaml")
    names = [name for name, one in edited.contract.files.parameters.items() if one == mock_file]
    for manager in (edited.contract.managers[name] for name in names):
        node = f"{manager.namespace}/controller_manager"
        said = parameters(file, edited.texts[file], node)
        types = {name: value for name, value in said.items() if name.endswith(".type")}
        loaded = [controller for controller in manager.controllers.values() if "real" in controller.targets]
        executed = {
            f"{controller.full_name.rpartition('/')[2]}.type": controller.plugin
            for controller in manager.controllers.values()
        }
        yield from differing(types, executed, f"{node}: ")
        rate: Names = {"update_rate": said.get("update_rate")}
        yield from differing(rate, {"update_rate": manager.update_rate_hz}, f"{node}: ")
        for controller in loaded:
            joints = parameters(file, edited.texts[file], controller.full_name).get("joints")
            if joints is not None:
                yield from differing({"joints": joints}, {"joints": controller.joints}, f"{controller.full_name}: ")


def bring_up(edited: Edited, _: str) -> Iterator[str]:
    """Compare what the steps of each target start with what the contract has active, and never on the other one."""
    for target in ("mock", "real"):
        requests = [step.request for step in edited.steps(target) if step.request is not None]
        asked = [
            f"{request.manager.rpartition('/')[0]}/{name}"
            for request in requests
            if isinstance(request, Activation)
            for name in request.controllers
        ]
        yield from differing(
            {"activates": sorted(asked)}, {"activates": _active(edited.contract, target)}, f"{target} "
        )
        known = {device.hardware_component for device in edited.contract.devices.values()}
        for request in requests:
            if isinstance(request, HardwareActivation) and request.component not in known:
                yield f"hardware component `{request.component}` of `{target}` is not in the contract"
            if isinstance(request, Restart):
                for name in request.controllers:
                    if f"{request.manager.rpartition('/')[0]}/{name}" not in asked:
                        yield f"`{target}` restarts `{name}`, which it does not activate"


def _active(contract: Contract, target: Target) -> list[str]:
    return sorted(
        f"{manager.namespace}/{name.rpartition('/')[2]}"
        for manager in contract.managers.values()
        for name, one in manager.controllers.items()
        if one.active and target in one.targets
    )


def qos_overrides(edited: Edited, file: str) -> Iterator[str]:
    """Compare the QoS that nodes are started with and the QoS that the mock connects them by."""
    contract = edited.contract
    written = plain(file, edited.texts[file])
    topics = [name for name in contract.interfaces if any(f".{name}." in key for key in written)]
    for node in dict.fromkeys(node for topic in topics for node in _writable(contract, topic)):
        executed: dict[str, Said] = {}
        for topic in topics:
            for side, qos in _profiles(contract.interfaces[topic], node):
                executed |= {f"{topic}.{side}.{name}": value for name, value in _policies(qos, side).items()}
        said = below(parameters(file, edited.texts[file], node), "qos_overrides.")
        yield from differing(said, executed, f"{node}: ")
    for key in written:
        topic = key.partition(".qos_overrides.")[2].partition(".")[0]
        if topic and topic not in contract.interfaces:
            yield f"`{topic}` must be a topic of `contract.json`"


def _writable(contract: Contract, topic: str) -> Iterator[str]:
    """Yield the full names of the nodes at a topic whose QoS a spec may write: no controllers, no devices."""
    others = {
        controller.full_name for manager in contract.managers.values() for controller in manager.controllers.values()
    }
    for end in (*contract.interfaces[topic].sources, *contract.interfaces[topic].sinks):
        own = end.full_name.rpartition("/")[2]
        if end.full_name not in others and end.node not in contract.devices and own not in _STANDARD:
            yield end.full_name


def _profiles(interface: ContractInterface, node: str) -> Iterator[tuple[Side, ContractQos]]:
    for end in interface.sources:
        if end.full_name == node:
            yield "publisher", end.qos
    for end in interface.sinks:
        if end.full_name == node:
            yield "subscription", end.qos


def _policies(qos: ContractQos, side: Side) -> dict[str, Said]:
    stated: dict[str, Said] = {
        "reliability": qos.reliability,
        "durability": qos.durability,
        "history": qos.history,
        "depth": qos.depth,
        "liveliness": qos.liveliness,
    }
    durations = {"deadline": qos.deadline_s, "liveliness_lease_duration": qos.lease_duration_s}
    if side == "publisher":
        durations["lifespan"] = qos.lifespan_s
    return stated | {name: round(value * _NS) for name, value in durations.items() if value is not None}


def recording(edited: Edited, file: str) -> Iterator[str]:
    """Compare the QoS of the recorder with what every publisher of a topic offers."""
    said = plain(file, edited.texts[file])
    for topic, interface in edited.contract.interfaces.items():
        if interface.kind == "topic" and (own := below(said, f"{topic}.")):
            yield from differing(own, _recorded(interface), f"{topic} ")
        elif interface.kind == "topic" and not interface.type.endswith(("/Image", "/PointCloud2")):
            yield f"`{topic}` must be recorded"


def _recorded(interface: ContractInterface) -> Names:
    """Return the profile that suits every publisher, the weakest that one of them offers, with a queue for all."""
    offered = [end.qos for end in interface.sources]
    reliability, durability = weakest(offered)
    return {
        "history": "keep_last",
        "depth": recorder_depth((qos.depth for qos in offered), interface.rate_hz),
        "reliability": reliability,
        "durability": durability,
    }
