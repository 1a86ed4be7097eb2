"""What ros2_control has of a device: joints and their interfaces, plugins, and the driver that replaces them."""

import re
from collections.abc import Iterable, Iterator
from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.compiler.catalog.catalog_model import (
    BareName,
    BehaviorName,
    CatalogModel,
    DistroName,
    GraphName,
    MomentName,
    NeedName,
    NodeName,
    ParameterFact,
    Text,
    Token,
)
from cellc.compiler.catalog.effects import EffectFacts, NeedStatusFacts, StartFacts
from cellc.compiler.catalog.programs import InnerNodeFacts
from cellc.compiler.spec.quantity import Frequency, PositiveDuration
from cellc.contract.pins import same_version
from cellc.contract.vocabulary import Distro

InterfaceName = BareName
"""The part after the slash: ``position``, ``force.x``, ``speed_scaling_factor``."""


_COUNTED = re.compile(r"(.*)\[(\d{1,3})\.\.(\d{1,3})\]")


def counted(names: Iterable[str]) -> Iterator[str]:
    """Yield interfaces with ``name_[0..3]`` written out as four of them; numbers up to 999, else it is a plain name."""
    for name in names:
        match = _COUNTED.fullmatch(name)
        if match is None:
            yield name
        else:
            yield from (f"{match[1]}{number}" for number in range(int(match[2]), int(match[3]) + 1))


class JointInterfaces(CatalogModel):
    """Command and state interfaces of a joint.

    Attributes:
        command: Interfaces that a controller can claim, such as ``[position, velocity]``.
        state: Interfaces that a controller can read, such as ``[position, velocity, effort]``.
    """

    command: tuple[InterfaceName, ...] = ()
    state: tuple[InterfaceName, ...] = ()


class HardwareRelease(CatalogModel):
    """What only some releases of the driver have.

    Attributes:
        distro: Distribution of the releases.
        drivers: Versions of the driver, such as ``["3.8.0"]``; for any other version the first entry of the
            distribution counts.
        parameters: ``<param>`` values besides those of all releases.
        exports: Further interfaces of gpios that these releases export, by gpio.
        source: Line of code or document from which this was read.
    """

    distro: DistroName
    drivers: tuple[Text, ...] = Field(min_length=1)
    parameters: dict[Text, Text] = Field(default_factory=dict)
    exports: dict[Token, JointInterfaces] = Field(default_factory=dict)
    source: Text


ParameterText = Annotated[str, StringConstraints(max_length=1000)]
"""A value of a ``<param>``, which may be empty."""


class CommandFacts(CatalogModel):
    """What a kind of controller claims on this hardware and its parameters, where a spec states nothing.

    Attributes:
        interfaces: Command interfaces that the controller claims of each joint.
        parameters: Parameters of the controller, by name.
        because: What the hardware does with commands of another interface.
        source: Line of code or document from which this was read.
    """

    interfaces: tuple[InterfaceName, ...] = Field(min_length=1)
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)
    because: Text
    source: Text


class CommandModes(CatalogModel):
    """Command modes of a device of which its plugin takes one at a time.

    Attributes:
        names: Interfaces of joints, such as ``position``, and names of gpios without prefix that a controller may
            claim.
        together: Pairs that the plugin takes at the same time; it refuses every other switch to two of them.
        source: Line of code from which this was read.
    """

    names: tuple[Token, ...] = Field(min_length=2)
    together: tuple[tuple[Token, Token], ...] = ()
    source: Text


class HardwareFacts(CatalogModel):
    """A hardware plugin, its ``<param>`` values, and what it does in the world.

    Attributes:
        plugin: Name of the plugin as pluginlib knows it, such as ``mock_components/GenericSystem``.
        component: Type of the component; the controller manager looks for a plugin of that type alone.
        parameters: ``<param>`` values by name; placeholders such as ``{address}`` are filled.
        left_out_when_empty: Parameters that are left out if their value is empty, since the plugin has a default for
            them.
        releases: What only some releases of the driver have.
        commands: What a kind of controller claims on this hardware, by kind.
        effects: What the plugin does in the world at each moment, such as ``activate``.
        start: How the component must be brought up, if it cannot go to active by itself.
        reported_by: Topics that say whether a need holds, such as ``program_running``.
        command_timeout: Longest silence of the controller manager before the device ends what it does.
        nodes: Nodes that the plugin makes in the process of the controller manager.
        modes: Command modes that exclude each other.
        fixed_joint_names: Whether the plugin has the joint names in its code, so that it ignores those of the
            description.
        source: Package with its version, or line of code.
    """

    plugin: BareName
    component: Literal["system", "sensor", "actuator"] = "system"
    parameters: dict[Text, ParameterText] = Field(default_factory=dict)
    left_out_when_empty: tuple[Text, ...] = ()
    releases: tuple[HardwareRelease, ...] = ()
    commands: dict[BehaviorName, CommandFacts] = Field(default_factory=dict)
    effects: dict[MomentName, EffectFacts] = Field(default_factory=dict)
    start: StartFacts | None = None
    reported_by: dict[NeedName, NeedStatusFacts] = Field(default_factory=dict)
    command_timeout: PositiveDuration | None = None
    nodes: tuple[InnerNodeFacts, ...] = ()
    modes: CommandModes | None = None
    fixed_joint_names: bool = False
    source: Text

    def release(self, distro: Distro, driver: str) -> HardwareRelease | None:
        """Return the release that a cell runs: that of its driver's version, else the first of its distribution."""
        here = [release for release in self.releases if release.distro is distro]
        named = (release for release in here if any(same_version(driver, known) for known in release.drivers))
        return next(named, here[0] if here else None)


class HardwareByTarget(CatalogModel):
    """The plugin of each target.

    Attributes:
        real: Plugin that moves the device; absent if nodes of the driver move it.
        mock: Plugin that pretends to.
    """

    real: HardwareFacts | None = None
    mock: HardwareFacts


class GroupInterfaces(CatalogModel):
    """Interfaces of a ``<sensor>`` or ``<gpio>``.

    Attributes:
        command: Interfaces that a controller can claim; ``name_[0..3]`` counts for four of them.
        state: Interfaces that a controller can read; ``name_[0..3]`` counts for four of them.
        initial: Values from which the mock starts, by interface.
        real_only: Whether only the real plugin has the group.
        fixed_name: Whether the plugin exports the group under this very name, whatever prefix the device has.
        undeclared: Whether the plugin exports the group although no description lists it.
    """

    command: tuple[InterfaceName, ...] = ()
    state: tuple[InterfaceName, ...] = ()
    initial: dict[InterfaceName, Annotated[float, Field(allow_inf_nan=False)]] = Field(default_factory=dict)
    real_only: bool = False
    fixed_name: bool = False
    undeclared: bool = False


class ControlFacts(CatalogModel):
    """One ``<ros2_control>`` tag.

    Attributes:
        component: Name of the tag, such as ``{device}_hardware``; from Jazzy on it is also the name of a node.
        update_rates: Update rates that the device accepts; empty for any.
        enforce_command_limits: Whether the vendor has the controller manager enforce joint limits; ``false`` turns it
            off.
        hardware: Plugin of the real target and of the mock.
        joints: Interfaces of each joint, named without prefix; ``*`` is every joint that moves by itself.
        sensors: Groups of state interfaces, by name without prefix.
        gpios: Groups of interfaces that belong to no joint, by name without prefix.
    """

    component: NodeName
    update_rates: tuple[Frequency, ...] = ()
    enforce_command_limits: bool | None = None
    hardware: HardwareByTarget
    joints: dict[Text, JointInterfaces]
    sensors: dict[Token, GroupInterfaces] = Field(default_factory=dict)
    gpios: dict[Token, GroupInterfaces] = Field(default_factory=dict)


class PluginUse(CatalogModel):
    """A controller plugin in one distribution.

    Attributes:
        type: Type of the controller, such as ``joint_trajectory_controller/JointTrajectoryController``.
        package: ROS package that has the plugin.
        claims: Full names of interfaces that the controller claims in this distribution besides its ``claims`` in all.
        reads: Full names of interfaces that the controller reads in this distribution besides its ``reads`` in all.
        behavior: What the plugin does in this distribution, if that is not the behavior of its kind.
        parameters: Parameters of the controller in this distribution, by name.
    """

    type: BareName
    package: Token
    claims: tuple[Text, ...] = ()
    reads: tuple[Text, ...] = ()
    behavior: BehaviorName | None = None
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)


class DriverFacts(CatalogModel):
    """What moves the device on the real target where ``hardware`` names no plugin for it.

    Attributes:
        node: Name of the node that moves the device, one of ``nodes``.
        joint_states: Topic of the node that has the joint states; it is remapped to ``/joint_states``.
        actions: Action of the driver that takes the goals of a kind of controller, by kind.
        goal_unit: Meaning and unit of the figures of a goal, such as ``m of one finger``.
        source: Package with its version, or line of code.
    """

    node: NodeName
    joint_states: GraphName | None = None
    actions: dict[Token, GraphName] = Field(default_factory=dict)
    goal_unit: Text | None = None
    source: Text


class SpeedScalingFacts(CatalogModel):
    """How the device reports how far it slows trajectories down.

    Attributes:
        state_interface: Full name of the state interface, such as ``{prefix}speed_scaling/speed_scaling_factor``.
        source: Line of code or document from which this was read.
    """

    state_interface: Text
    source: Text
