"""A first spec for devices of the catalog: what a new cell must say, and honest blanks for the rest."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from cellc.catalog.load import CatalogDevice
from cellc.vocabulary import Behaviour, Distro

_ASIDE_DEG = 20.0
_UPDATE_RATE = "100 Hz"  # the controller manager's own default, for devices that accept any rate


def starter_spec(
    name: str, distro: Distro, devices: Mapping[str, CatalogDevice], schema: str, packages: Sequence[str] = ()
) -> str:
    """Write a spec that passes every check, in the layout of a hand-written one.

    Args:
        name: name of the cell and its package.
        devices: catalog entries by the names they get in the cell; at least one.
        schema: path or address of the JSON schema for the editor's modeline.
        packages: folders of the repository in which the vendors' packages lie, relative to the spec.

    Returns:
        YAML text that ends in a newline.
    """
    arms = [device for device, entry in devices.items() if entry.model.kind == "arm"]
    grippers = [device for device, entry in devices.items() if entry.model.gripper is not None]
    lines = [
        f"# yaml-language-server: $schema={schema}",
        "format: 1",
        f"cell: {name}",
        f"summary: {', '.join(entry.model.model for entry in devices.values())}, on the mock",
        f"versions: {{ros: {distro}}}        # what is missing here is UNKNOWN and blocks the real target",
        *([f"packages: [{', '.join(packages)}]"] if packages else []),
        "devices:",
        *(line for device, entry in devices.items() for line in _device(device, entry, arms, devices)),
        *_control(distro, devices),
        *_motion(arms, devices),
        "rehearsals:",
        f"  ready: {{steps: [{', '.join(_steps(arms, grippers))}]}}",
    ]
    return "\n".join(lines) + "\n"


def _device(name: str, entry: CatalogDevice, arms: list[str], devices: Mapping[str, CatalogDevice]) -> Iterator[str]:
    yield f"  {name}:"
    yield f"    model: {entry.model.model}"
    control = entry.model.control
    real = None if control is None else control.hardware.real
    if real is not None and real.fixed_joint_names:
        yield '    prefix: ""    # the driver makes the names of joints in its code'
    if name in arms:
        # A metre apart: arms of one cell do not start inside each other.
        yield f"    mount: {{parent: world, xyz: 0 {arms.index(name)} 0 m}}"
    elif arms:
        of_kind = [other for other, one in devices.items() if one.model.kind == entry.model.kind]
        arm = arms[of_kind.index(name) % len(arms)]
        aside = ", xyz: 0 -110 30 mm" if entry.model.camera is not None else ""
        yield f"    mount: {{parent: {arm}/{devices[arm].model.tool_frame or devices[arm].model.base}{aside}}}"


def _control(distro: Distro, devices: Mapping[str, CatalogDevice]) -> Iterator[str]:
    controlled = {name: entry for name, entry in devices.items() if entry.model.control is not None}
    if not controlled:
        return
    rates = [rate.text for one in controlled.values() if one.model.control for rate in one.model.control.update_rates]
    yield "control:"
    yield f"  update_rate: {rates[0] if rates else _UPDATE_RATE}"
    yield "  controllers:"
    yield "    joint_states: {type: joint_state_broadcaster}"
    for name, entry in controlled.items():
        if entry.model.gripper is not None:
            yield f"    {name}_action: {{type: parallel_gripper, device: {name}}}"
        if entry.model.kind == "arm":
            yield f"    {name}_trajectory:"
            yield f"      type: {_trajectory_kind(entry, distro)}"
            yield f"      device: {name}"
            yield "      goal_time: 1 s"
            yield "      path_tolerance: 0.2 rad"
            yield "      goal_tolerance: 0.01 rad"
            yield from (f"    {name}_io: {{type: {kind}, device: {name}}}" for kind in _telling_kinds(entry))


def _telling_kinds(entry: CatalogDevice) -> dict[str, None]:
    """Return the kinds of controllers that tell whether the device listens, each once."""
    real = None if entry.model.control is None else entry.model.control.hardware.real
    return {} if real is None else {told.controller: None for told in real.told.values()}


def _trajectory_kind(entry: CatalogDevice, distro: Distro) -> str:
    """Prefer the device's own trajectory controller, which knows its speed scaling.

    One that claims interfaces of its own is left to a person: a mock moves on position commands.
    """
    for kind, own in entry.model.controllers.items():
        if own.behaviour is Behaviour.JOINT_TRAJECTORY and not own.command_interfaces and distro in own.plugins:
            return kind
    return "joint_trajectory"


def _motion(arms: list[str], devices: Mapping[str, CatalogDevice]) -> Iterator[str]:
    if not arms:
        return
    yield "motion:"
    yield "  groups:"
    for arm in arms:
        model = devices[arm].model
        yield f"    {arm}_group: {{base: {arm}/{model.base}, tip: {arm}/{model.tool_frame or model.base}}}"
    yield "  poses:"
    for name, aside in (("home", 0.0), ("aside", _ASIDE_DEG)):
        yield f"    {name}:"
        for arm in arms:
            yield f"      {arm}_group: {_pose(devices[arm], aside)}"


def _pose(entry: CatalogDevice, aside_deg: float) -> str:
    """Return the home of an arm, turned about its first joint: what stands on that one keeps its shape."""
    home, fingers = entry.model.home or {}, entry.model.gripper
    driven = [one for one in entry.description.joints if one.movable and one.mimic is None]
    joints = [one.name for one in driven if fingers is None or one.name != fingers.joint]
    degrees = [math.degrees(home[joint].si) if joint in home else 0.0 for joint in joints]
    turned = (value + (aside_deg if index == 0 else 0.0) for index, value in enumerate(degrees))
    return " ".join(f"{round(value, 6):g}" for value in turned) + " deg"


def _steps(arms: list[str], grippers: list[str]) -> Iterator[str]:
    if arms:
        yield "{move: home}"
        yield "{move: aside}"
    for gripper in grippers:
        device = f", device: {gripper}" if len(grippers) > 1 else ""
        yield f"{{grip: close{device}}}"
        yield f"{{grip: open{device}}}"
    if arms:
        yield "{move: home}"
    if not arms and not grippers:
        yield "{wait: 1 s}"
