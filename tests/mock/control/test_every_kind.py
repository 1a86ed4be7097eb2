"""Every kind of controller of the catalog runs on the mock, in every distribution, on every device that offers it.

A device offers a kind where its mock has what the kind takes: interfaces of joints, a force and torque sensor, a gpio.
Kinds that only one device has are offered by that device alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.device_interfaces import GroupInterfaces, counted
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.load import CatalogDevice, controller_kinds, device_names, load_controller_kind, load_device
from cellc.contract.vocabulary import PASSIVE, TRAJECTORIES, Behavior, Distro
from cellc.mock import load
from tests.cells import build_into, written

SIMULATED = (("position",), ("velocity",))
"""What moves a joint of GenericSystem: one of these alone; it refuses effort and two at once, as was observed."""
GRIPPERS = (Behavior.PARALLEL_GRIPPER, Behavior.POSITION_GRIPPER)


@dataclass(frozen=True, slots=True)
class Offer:
    """A type of controller on a device, what the spec has to say of it, and what the mock is expected to run."""

    type: str
    device: str
    behavior: Behavior
    distros: tuple[Distro, ...]
    written: str = ""

    def __str__(self) -> str:
        return f"{self.type}-{self.device}"


def _device(name: str) -> CatalogDevice:
    loaded = load_device(name).value
    assert loaded is not None
    return loaded


def _kind(name: str) -> ControllerKind:
    loaded = load_controller_kind(name).value
    assert loaded is not None
    return loaded


def _simulated(groups: dict[str, GroupInterfaces]) -> dict[str, GroupInterfaces]:
    return {name: group for name, group in groups.items() if not group.real_only}


def _combinations(kind: ControllerKind, device: DeviceModel) -> Iterator[tuple[str, ...]]:
    """Yield the combinations of command interfaces that all joints of a device have and that move them on the mock."""
    control = device.control
    if (
        control is None
        or not control.joints
        or (kind.action is not None and kind.single_joint and device.gripper is None)
    ):
        return
    for wanted in kind.command_combinations:
        if wanted in SIMULATED and all(set(wanted) <= set(joint.command) for joint in control.joints.values()):
            yield wanted


def _gains(device: CatalogDevice) -> str:
    """Return a proportional gain for each joint of the arm: without one, velocity alone moves nothing."""
    moving = [joint.name for joint in device.description.joints if joint.type != "fixed" and joint.mimic is None]
    gripper = device.model.gripper
    driven = [name for name in moving if gripper is None or len(moving) == 1 or name != gripper.joint]
    return ", parameters: {" + ", ".join(f'"gains.{{prefix}}{name}.p": 1.0' for name in driven) + "}"


def _written(kind: ControllerKind, catalog: CatalogDevice) -> Iterator[str]:
    """Yield what the spec says of a neutral kind on a device that offers it, once for each way of offering it."""
    device, control = catalog.model, catalog.model.control
    if control is None:
        return
    if kind.scope == "manager":
        yield ""
    for wanted in _combinations(kind, device):
        by_pid = kind.kind in TRAJECTORIES and "position" not in wanted
        yield f", command_interfaces: [{', '.join(wanted)}]{_gains(catalog) if by_pid else ''}"
    if kind.kind is Behavior.FORCE_TORQUE_SENSOR_BROADCASTER:
        for name, group in _simulated(control.sensors).items():
            if set(kind.state_interfaces) <= set(group.state):
                yield f', parameters: {{sensor_name: "{{prefix}}{name}", frame_id: world}}'
    if kind.kind is Behavior.GPIO_COMMAND:
        for name, group in _simulated(control.gpios).items():
            gpio, taken = f"{{prefix}}{name}", f"[{', '.join(counted(group.command))}]"
            yield f', parameters: {{gpios: ["{gpio}"], "command_interfaces.{gpio}.interfaces": {taken}}}'


def _of_each_family() -> dict[str, CatalogDevice]:
    """Return the devices, one model alone of each family: interfaces and controllers are its family's, not its own."""
    known = {name: _device(name) for name in device_names()}
    first = {device.model.family: name for name, device in reversed(known.items())} | {"ur": "ur5e"}
    return {name: device for name, device in known.items() if device.model.family is None or name in first.values()}


def _offers() -> Iterator[Offer]:
    for name, device in _of_each_family().items():
        for kind in map(_kind, controller_kinds()):
            for text in _written(kind, device):
                yield Offer(kind.kind.value, name, kind.kind, tuple(kind.plugins), text)
        for own, facts in device.model.controllers.items():
            moves = not facts.command_interfaces or facts.command_interfaces in SIMULATED
            moves = moves and facts.behavior is not Behavior.OWN_MOTION
            framed = facts.behavior is Behavior.FORCE_TORQUE_SENSOR_BROADCASTER
            said = ", parameters: {frame_id: world}" if framed else "" if moves else ", active: false"
            yield Offer(own, name, facts.behavior, tuple(facts.plugins), said)


OFFERS = tuple(_offers())


def _spec(offer: Offer, distro: Distro) -> str:
    device = _device(offer.device)
    mount = "" if device.model.kind == "gripper" else ", mount: {parent: world, xyz: 0 0 0 m}"
    unit = "m" if any(joint.type == "prismatic" for joint in device.description.joints) else "rad"
    bounds = f", goal_time: 1 s, path_tolerance: 0.02 {unit}, goal_tolerance: 0.01 {unit}"  # fits a finger of 40 mm
    tested = f"    tested: {{type: {offer.type}, device: dev{offer.written}{bounds if _follows(offer) else ''}}}\n"
    if offer.behavior is Behavior.JOINT_STATE_BROADCASTER:
        tested = ""
    steps = "grip: close}, {grip: open" if offer.behavior in GRIPPERS else "wait: 100 ms"
    control = device.model.control
    rates = () if control is None else control.update_rates
    real = None if control is None else control.hardware.real
    prefix = ', prefix: ""' if real is not None and real.fixed_joint_names else ""
    return (
        f"format: 1\ncell: one\nsummary: one controller\nversions: {{ros: {distro}}}\n"
        f"devices:\n  dev: {{model: {offer.device}{mount}{prefix}}}\n"
        f"control:\n  update_rate: {rates[0].text if rates else '100 Hz'}\n"
        f"  controllers:\n    joints: {{type: joint_state_broadcaster}}\n{tested}"
        f"rehearsals:\n  ready: {{steps: [{{{steps}}}]}}\n"
    )


def _follows(offer: Offer) -> bool:
    return offer.behavior in TRAJECTORIES


def _expected(offer: Offer, distro: Distro) -> Behavior:
    """Return what the plugin of a distribution does, as ros2_controllers and the vendors' packages have it."""
    if offer.behavior is Behavior.PARALLEL_GRIPPER and distro is Distro.HUMBLE:
        return Behavior.POSITION_GRIPPER
    # The UR's own is deprecated on Kilted and gone on Lyrical, where upstream's scales by a state interface.
    if offer.type == "scaled_joint_trajectory" and distro in (Distro.HUMBLE, Distro.JAZZY):
        return Behavior.SCALED_JOINT_TRAJECTORY
    return offer.behavior


def _runs() -> Iterator[tuple[Offer, Distro]]:
    """Yield each controller with a distribution for each behavior that its plugins have."""
    for offer in OFFERS:
        yield from {_expected(offer, distro): (offer, distro) for distro in offer.distros}.values()


@pytest.mark.parametrize(("offer", "distro"), tuple(_runs()), ids=str)
def test_controller_of_the_catalogue_runs_on_the_mock(offer: Offer, distro: Distro, tmp_path: Path) -> None:
    cell = load(build_into(tmp_path / "built", written(tmp_path, _spec(offer, distro))))
    (manager,) = cell.contract.managers.values()
    name = "joints" if offer.behavior is Behavior.JOINT_STATE_BROADCASTER else "tested"
    controller = manager.controllers[name]
    result = cell.run("ready")
    assert result.outcome == "succeeded", result.bringup[-1]
    assert cell.contract.plugin_behaviors[controller.plugin] is controller.behavior
    if "mock" in controller.targets:
        assert controller.behavior is _expected(offer, distro)


def test_every_kind_is_offered_by_a_device() -> None:
    assert {offer.type for offer in OFFERS} >= set(controller_kinds())


def test_every_behavior_is_named_by_the_catalogue() -> None:
    run = {_expected(offer, distro) for offer in OFFERS for distro in offer.distros}
    assert run | PASSIVE == set(Behavior)


# A gpio that the driver exports and no description lists, and joints by effort alone, which GenericSystem refuses.
BEYOND_THE_MOCK = {
    "a command of a gpio": ("ur5e", "gpio_command", "command", "standard_digital_output_cmd_0"),
    "a state of a gpio": ("ur5e", "gpio_command", "state", "digital_output_0"),
    "joints by effort": ("franka_fr3", "forward_command", "effort", ""),
}


@pytest.mark.parametrize("taken", BEYOND_THE_MOCK)
def test_controller_that_takes_what_mock_hardware_lacks_is_started_on_the_real_target_alone(
    taken: str, tmp_path: Path
) -> None:
    device, kind, what, gpio = BEYOND_THE_MOCK[taken]
    named = f'{{gpios: ["{{prefix}}gpio"], "{what}_interfaces.{{prefix}}gpio.interfaces": [{gpio}]}}'
    said = f", parameters: {named}" if gpio else f", command_interfaces: [{what}]"
    offer = Offer(kind, device, Behavior(kind), (Distro.JAZZY,), said)
    cell = load(build_into(tmp_path / "built", written(tmp_path, _spec(offer, Distro.JAZZY))))
    (manager,) = cell.contract.managers.values()
    assert manager.controllers["tested"].targets == ("real",)
    assert cell.run("ready").outcome == "succeeded"
