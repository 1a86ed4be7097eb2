"""What the joints behind springs hold: the weight of their arm, a part while a tool is closed, and what a run draws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from cellc.contract.contract import Contract
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.errors import MockError
from cellc.mock.nodes.motion_model import MotionModel
from cellc.mock.reality import Reality
from cellc.mock.world.world import LinkTree
from cellc.robot.planning import Load, ModelError, Springs


class Loads:
    """Binds the law of each device to its joints; a device whose joints are where they are commanded costs nothing."""

    def __init__(self, contract: Contract, control: ControlStack, motion: MotionModel) -> None:
        """Take the devices whose joints are behind springs, of which no tool holds anything."""
        self._control = control
        self._motion, links = motion, motion.links
        self._devices = {
            name: (device, device.law)
            for name, device in contract.devices.items()
            if device.law is not None and device.law.joints
        }
        self._loads = dict.fromkeys(self._devices, Load())
        self._carriers = {
            tool: tuple(
                name
                for name, (arm, law) in self._devices.items()
                if law.part is not None and (name == tool or _is_below(links, device.root_link, arm.root_link))
            )
            for tool, device in contract.devices.items()
        }

    def begin(self) -> None:
        """Bind every law as its device starts."""
        for name in self._devices:
            self._bind(name, Load())

    def draw(self, reality: Reality) -> None:
        """Let devices hold and compensate what one run draws."""
        more_kg, too_much = reality.part_more_kg, reality.compensation
        for name in self._devices.keys() & (more_kg.keys() | too_much.keys()):
            part_kg, share = more_kg.get(name, 0.0), too_much.get(name, 0.0)
            self._bind(name, replace(self._loads[name], part_more_kg=part_kg, compensation=share))

    def hold(self, tool: str, *, holds: bool) -> None:
        """Let the arm of a tool hold its part from now on, or no part."""
        for name in self._carriers[tool]:
            if self._loads[name].holds != holds:
                self._bind(name, replace(self._loads[name], holds=holds))

    def _bind(self, name: str, load: Load) -> None:
        device, law = self._devices[name]
        self._loads[name] = load
        try:
            robot = self._motion.part_of(next(iter(law.joints))).robot
            springs = Springs(law, robot, load, self._positions())
        except ModelError as error:
            raise MockError("contract.json", f"law of `{name}`: {error}") from None
        if name in self._control.adapters:
            self._control.adapters[name].adapter.bind(law, springs)
            return
        for manager in self._control.managers_of_component(device.hardware_component or ""):
            manager.bind(device.hardware_component or "", law, springs)

    def _positions(self) -> Mapping[str, float]:
        servers = self._control.managers.values()
        return {joint: at for server in servers for joint, at in server.joint_positions().items()}


def _is_below(links: LinkTree, link: str, root: str) -> bool:
    """Return whether a link is what a device carries that begins with another."""
    return any(joint.child == root for joint in links.chain(link)) and link != root
