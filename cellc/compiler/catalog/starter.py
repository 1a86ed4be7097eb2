"""A first spec for devices of the catalog or of folders: what a new cell must say, and honest blanks for the rest."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.load import CatalogDevice
from cellc.compiler.catalog.starter_mounts import mounts_of
from cellc.compiler.catalog.starter_wires import Wires, outputs_controller, switching, wires_of
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Behavior, Distro
from cellc.robot.description.model import Joint

_ASIDE = {False: math.radians(20.0), True: 0.05}
"""By whether a joint slides: how far the first joint goes, rad or m, where its range is ten times as wide."""
_UNITS = {False: "rad", True: "m"}
_MOVED = ("arm", "axis")
"""Kinds that a first rehearsal moves along their chain."""
_UPDATE_RATE = "100 Hz"  # the controller manager's own default, for devices that accept any rate


@dataclass(frozen=True, slots=True)
class NamedDevice:
    """A device, and the text by which the spec names it: a model of the catalog, or a folder beside the spec."""

    named: str
    entry: CatalogDevice

    @property
    def model(self) -> DeviceModel:
        """What the catalog, or the folder, says about it."""
        return self.entry.model


def starter_spec(
    name: str, distro: Distro, devices: Mapping[str, NamedDevice], schema: str, packages: Sequence[str] = ()
) -> str:
    """Write a spec that passes every check, in the layout of a hand-written one.

    Args:
        name: name of the cell and its package.
        devices: by the names they get in the cell; at least one.
        schema: path or address of the JSON schema for the editor's modeline.
        packages: folders of the repository in which the vendors' packages lie, relative to the spec.

    Returns:
        YAML text that ends in a newline.
    """
    models = {device: named.model for device, named in devices.items()}
    movers = [device for device, named in devices.items() if named.model.kind in _MOVED and _chain(named.entry)]
    grippers = [device for device, model in models.items() if model.gripper is not None]
    mounts, wires = mounts_of(models), wires_of(models)
    lines = [
        f"# yaml-language-server: $schema={schema}",
        "format: 1",
        f"cell: {name}",
        f"summary: {', '.join(model.model for model in models.values())}, on the mock",
        f"versions: {{ros: {distro}}}        # what is missing here is UNKNOWN and blocks the real target",
        *([f"packages: [{', '.join(packages)}]"] if packages else []),
        "devices:",
        *(line for device, named in devices.items() for line in _device(device, named, mounts[device], wires)),
        *_managed(distro, devices, mounts, wires),
        *_motion(movers, devices),
        "rehearsals:",
        f"  ready: {{steps: [{', '.join(_steps(movers, grippers))}]}}",
    ]
    return "\n".join(lines) + "\n"


def _device(name: str, device: NamedDevice, mount: str, wires: Wires) -> Iterator[str]:
    yield f"  {name}:"
    yield f"    model: {device.named}"
    control = device.model.control
    real = None if control is None else control.hardware.real
    if real is not None and real.fixed_joint_names:
        yield '    prefix: ""    # the driver makes the names of joints in its code'
    yield f"    mount: {mount}"
    if name in wires:
        yield f"    switching: {switching(wires[name])}"


def _managed(
    distro: Distro, devices: Mapping[str, NamedDevice], mounts: Mapping[str, str], wires: Wires
) -> Iterator[str]:
    """Write the controllers, under a manager of its own for each update rate that devices demand."""
    groups = _by_rate(devices, mounts)
    if len(groups) == 1:
        (rate,) = groups
        yield "control:"
        yield from _controllers(rate, "joint_states", distro, groups[rate], wires, "  ")
    elif groups:
        yield "managers:"
        for rate, members in groups.items():
            first = next(iter(members))
            yield f"  {first}_manager:"
            yield f"    namespace: /{first}"
            yield from _controllers(rate, f"{first}_joint_states", distro, members, wires, "    ")


def _by_rate(devices: Mapping[str, NamedDevice], mounts: Mapping[str, str]) -> dict[str, dict[str, NamedDevice]]:
    """Return the devices with control by the update rate of their manager: that of what carries one that takes any."""
    groups: dict[str, dict[str, NamedDevice]] = {}
    controlled = {name: named for name, named in devices.items() if named.model.control is not None}
    free = []
    for name, named in controlled.items():
        rates = [rate.text for rate in named.model.control.update_rates] if named.model.control else []
        if rates:
            groups.setdefault(next((rate for rate in rates if rate in groups), rates[0]), {})[name] = named
        else:
            free.append(name)
    for name in free:
        carrier = mounts[name].partition("parent: ")[2].partition("/")[0]
        of_carrier = next((rate for rate, members in groups.items() if carrier in members), None)
        groups.setdefault(of_carrier or next(iter(groups), _UPDATE_RATE), {})[name] = controlled[name]
    return groups


def _controllers(
    rate: str,
    states: str,
    distro: Distro,
    devices: Mapping[str, NamedDevice],
    wires: Wires,
    indent: str,
) -> Iterator[str]:
    yield f"{indent}update_rate: {rate}"
    yield f"{indent}controllers:"
    yield f"{indent}  {states}: {{type: joint_state_broadcaster}}"
    for name, named in devices.items():
        yield from (f"{indent}  {line}" for line in _of_device(name, named, distro, wires))


def _of_device(name: str, one: NamedDevice, distro: Distro, wires: Wires) -> Iterator[str]:
    if one.model.gripper is not None:
        yield f"{name}_action: {{type: parallel_gripper, device: {name}}}"
    chain = _chain(one.entry) if one.model.kind in _MOVED else []
    if chain:
        yield f"{name}_trajectory:"
        yield f"  type: {_trajectory_kind(one.model, distro)}"
        yield f"  device: {name}"
        if len(chain) < len(_driven(one.entry)):
            yield f"  joints: [{', '.join(f'{name}/{joint.name}' for joint in chain)}]"
        yield "  goal_time: 1 s"
        yield f"  path_tolerance: {_tolerance(chain, {False: 0.2, True: 0.02})}"
        yield f"  goal_tolerance: {_tolerance(chain, {False: 0.01, True: 0.001})}"
        for kind, topic in _telling_kinds(one.model).items():
            yield f"{name}_{topic}: {{type: {kind}, device: {name}}}"
    yield from outputs_controller(name, wires)


def _telling_kinds(model: DeviceModel) -> dict[str, str]:
    """Return the kinds of controllers that tell whether the device listens, each once, with a word for its name."""
    real = None if model.control is None else model.control.hardware.real
    topics = {} if real is None else {report.controller: report.topic for report in real.reported_by.values()}
    return {kind: topic if number else "io" for number, (kind, topic) in enumerate(topics.items())}


def _trajectory_kind(model: DeviceModel, distro: Distro) -> str:
    """Prefer the device's own trajectory controller, which knows its speed scaling.

    One that claims interfaces of its own is left to a person: a mock moves on position commands.
    """
    for kind, facts in model.controllers.items():
        if facts.behavior is Behavior.JOINT_TRAJECTORY and not facts.command_interfaces and distro in facts.plugins:
            return kind
    return "joint_trajectory"


def _motion(movers: list[str], devices: Mapping[str, NamedDevice]) -> Iterator[str]:
    if not movers:
        return
    yield "motion:"
    yield "  groups:"
    for arm in movers:
        model = devices[arm].model
        yield f"    {arm}_group: {{base: {arm}/{model.base}, tip: {arm}/{model.tool_frame or model.base}}}"
    yield "  poses:"
    for name, aside in (("home", False), ("aside", True)):
        yield f"    {name}:"
        for arm in movers:
            yield f"      {arm}_group: {_pose(devices[arm].entry, aside=aside)}"


def _driven(entry: CatalogDevice) -> list[Joint]:
    """Return the joints that are commanded, without those of a gripper that is part of the device."""
    fingers = entry.model.gripper
    driven = (joint for joint in entry.description.joints if joint.movable and joint.mimic is None)
    return [joint for joint in driven if fingers is None or joint.name != fingers.joint]


def _chain(entry: CatalogDevice) -> list[Joint]:
    """Return the driven joints between base and tool, in the order of the description."""
    frames, above = entry.model.frames, {joint.child: joint for joint in entry.description.joints}
    tool = entry.model.tool_frame
    link, between = frames.get(tool or "", tool or ""), set()
    while link in above:
        between.add(above[link].name)
        link = above[link].parent
    return [joint for joint in _driven(entry) if joint.name in between]


def _tolerance(chain: Sequence[Joint], figures: Mapping[bool, float]) -> str:
    """Return one figure for each kind of joint of a chain."""
    kinds = dict.fromkeys(joint.slides for joint in chain)
    return " ".join(f"{figures[slides]:g} {_UNITS[slides]}" for slides in sorted(kinds))


def _pose(entry: CatalogDevice, *, aside: bool) -> str:
    """Return the home of an arm, or that with its first joint aside: what is mounted on that one keeps its shape."""
    chain = _chain(entry)
    values = [_home(entry, joint) for joint in chain]
    if aside and chain:
        values[0] += _way(chain[0], values[0])
    if not any(joint.slides for joint in chain):
        return " ".join(f"{round(math.degrees(value), 6):g}" for value in values) + " deg"
    texts = []
    for number, joint in enumerate(chain):
        ends = number + 1 == len(chain) or chain[number + 1].slides != joint.slides
        texts.append(f"{round(values[number], 6):g}" + (f" {_UNITS[joint.slides]}" if ends else ""))
    return " ".join(texts)


def _home(entry: CatalogDevice, joint: Joint) -> float:
    """Return where a joint is at home, rad or m: as the device says, else as near zero as its limits allow."""
    home = entry.model.home or {}
    if joint.name in home:
        return home[joint.name].si
    lower, upper = _ends(joint)
    return min(max(0.0, lower), upper)


def _way(joint: Joint, home: float) -> float:
    """Return how far a joint goes aside, towards its farther end."""
    lower, upper = _ends(joint)
    most = min(_ASIDE[joint.slides], max(upper - home, home - lower) / 10.0)
    return most if upper - home >= home - lower else -most


def _ends(joint: Joint) -> tuple[float, float]:
    limit = joint.limit
    endless = limit is None or joint.type == "continuous" or limit.lower is None or limit.upper is None
    return (-math.inf, math.inf) if endless or limit is None else (limit.lower or 0.0, limit.upper or 0.0)


def _steps(movers: list[str], grippers: list[str]) -> Iterator[str]:
    if movers:
        yield "{move: home}"
        yield "{move: aside}"
    for gripper in grippers:
        device = f", device: {gripper}" if len(grippers) > 1 else ""
        yield f"{{grip: close{device}}}"
        yield f"{{grip: open{device}}}"
    if movers:
        yield "{move: home}"
    if not movers and not grippers:
        yield "{wait: 1 s}"
