"""What a device offers: joints and their interfaces, plugins, drivers, topics, services, actions and cameras."""

import re
from collections.abc import Iterable, Iterator
from typing import Annotated, Literal, Union

from pydantic import Field

from cellc.catalog.catalog_model import (
    BareName,
    BehaviourName,
    CatalogModel,
    DistroName,
    FileName,
    GraphName,
    MomentName,
    NeedName,
    NodeName,
    ParameterFact,
    Text,
    Token,
)
from cellc.catalog.effects import EffectFacts, StartFacts, ToldFacts
from cellc.catalog.programs import EndpointFacts, InnerNodeFacts
from cellc.pins import same_version
from cellc.spec.base import MOST
from cellc.spec.quantity import Duration, FieldAngle, Frequency, Length, PositiveDuration
from cellc.vocabulary import Distro

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
    """Command and state interfaces of a joint."""

    command: tuple[InterfaceName, ...] = ()
    state: tuple[InterfaceName, ...] = ()


class HardwareRelease(CatalogModel):
    """What is so with some releases of the driver alone; ``drivers`` are versions.

    ``parameters`` are given to the plugin beside those of all releases, ``exports`` are further interfaces of gpios.
    """

    distro: DistroName
    drivers: tuple[Text, ...] = Field(min_length=1)
    parameters: dict[Text, Text] = Field(default_factory=dict)
    exports: dict[Token, JointInterfaces] = Field(default_factory=dict)
    source: Text


class CommandFacts(CatalogModel):
    """What a kind of controller claims of each joint of this hardware, and is told, where a spec states nothing.

    ``because`` is what the hardware does with commands of another interface.
    """

    interfaces: tuple[InterfaceName, ...] = Field(min_length=1)
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)
    because: Text
    source: Text


class CommandModes(CatalogModel):
    """Ways of commanding a device of which its plugin takes one at a time.

    ``names`` are interfaces of joints, such as ``position``, and gpios that a controller claims something of; a gpio is
    named without prefix. The plugin refuses a switch to two of them unless they are a pair of ``together``.
    """

    names: tuple[Token, ...] = Field(min_length=2)
    together: tuple[tuple[Token, Token], ...] = ()
    source: Text


class HardwareFacts(CatalogModel):
    """A hardware plugin, the ``<param>`` values that it is given, and what it does in the world.

    ``component`` is what of ros2_control it is: the manager looks for a plugin of that kind alone.
    ``left_out_when_empty`` are parameters that the plugin has a default for: an empty ``<param>`` makes the reader
    of ros2_control complain. ``commands`` is what a kind of controller claims on this hardware. ``command_timeout``
    is the longest silence of the controller manager before the device ends what it does. ``nodes`` are those that the
    plugin makes in the manager's process. ``modes`` exclude each other. ``fixed_joint_names`` where the plugin makes
    the names of its joints in its code: what the description calls them is nothing to it.
    """

    plugin: BareName
    component: Literal["system", "sensor", "actuator"] = "system"
    parameters: dict[Text, Text] = Field(default_factory=dict)
    left_out_when_empty: tuple[Text, ...] = ()
    releases: tuple[HardwareRelease, ...] = ()
    commands: dict[BehaviourName, CommandFacts] = Field(default_factory=dict)
    effects: dict[MomentName, EffectFacts] = Field(default_factory=dict)
    start: StartFacts | None = None
    told: dict[NeedName, ToldFacts] = Field(default_factory=dict)
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
    """The plugin that moves metal, and the one that pretends; no ``real`` where the driver's own nodes move it."""

    real: HardwareFacts | None = None
    mock: HardwareFacts


class GroupInterfaces(CatalogModel):
    """Interfaces of a ``<sensor>`` or ``<gpio>``; ``initial`` values are what a mock starts from.

    ``fixed_name`` where the hardware exports them under this very name, whatever prefix the device has. ``undeclared``
    where it exports them although no description lists them.
    """

    command: tuple[InterfaceName, ...] = ()
    state: tuple[InterfaceName, ...] = ()
    initial: dict[InterfaceName, Annotated[float, Field(allow_inf_nan=False)]] = Field(default_factory=dict)
    real_only: bool = False
    fixed_name: bool = False
    undeclared: bool = False


class ControlFacts(CatalogModel):
    """One ``<ros2_control>`` tag.

    ``component`` is the tag's name, which is a node name too from Jazzy on; ``update_rates`` are those that the device
    accepts, none for any; ``joints`` are named without prefix, ``*`` stands for every joint that moves on its own.
    ``enforce_command_limits`` is what the vendor tells its controller manager where that can enforce limits.
    """

    component: NodeName
    update_rates: tuple[Frequency, ...] = ()
    enforce_command_limits: bool | None = None
    hardware: HardwareByTarget
    joints: dict[Text, JointInterfaces]
    sensors: dict[Token, GroupInterfaces] = Field(default_factory=dict)
    gpios: dict[Token, GroupInterfaces] = Field(default_factory=dict)


class PluginUse(CatalogModel):
    """A controller plugin in one distribution; ``behaviour`` where it does otherwise than the kind is called.

    ``claims`` and ``reads`` are what a passive controller of a device takes besides what it takes everywhere.
    """

    type: BareName
    package: Token
    claims: tuple[Text, ...] = ()
    reads: tuple[Text, ...] = ()
    behaviour: BehaviourName | None = None
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)


class DriverFacts(CatalogModel):
    """What moves the device on the real target where ``hardware`` names no plugin for it.

    ``node`` is one of the device's nodes, ``joint_states`` one of its topics, and ``actions`` tell which of its actions
    takes the goals of a kind of controller that is not spawned there; ``goal_unit`` says what their figures are.
    """

    node: NodeName
    joint_states: GraphName | None = None
    actions: dict[Token, GraphName] = Field(default_factory=dict)
    goal_unit: Text | None = None
    source: Text


class SpeedScalingFacts(CatalogModel):
    """Full name of the state interface in which the device reports how far it slows trajectories down."""

    state_interface: Text
    source: Text


class QosFacts(CatalogModel):
    """A profile spelt out where none of the named ones fits."""

    reliability: Literal["reliable", "best_effort"]
    durability: Literal["volatile", "transient_local"]
    history: Literal["keep_last", "keep_all"] = "keep_last"
    depth: int = Field(10, ge=1, le=MOST)


QosUse = Union[Token, QosFacts]
"""Name of a profile in ``qos_profiles.yaml``, or the settings themselves."""


class NodeFacts(CatalogModel):
    """A node of the driver for the real target; ``publishes_tf`` where it is an authority for frames.

    ``remaps`` are names that its program gives to others → the names that they have in the cell. Without a controller
    of the kind ``needs_controller`` on this device, it would wait for ever and is not started; with a firmware older
    than ``firmware`` says for a product, its program ends, and it is not started either. ``effect`` is what the start
    of its process does.
    """

    name: NodeName
    package: Token
    executable: FileName
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)
    remaps: dict[GraphName, GraphName] = Field(default_factory=dict)
    needs_controller: Token | None = None
    firmware: dict[Token, Text] = Field(default_factory=dict)
    endpoints: EndpointFacts | None = None
    publishes_tf: bool = False
    provides: Literal["real", "every_target"] = "real"
    effect: EffectFacts | None = None
    source: Text


class TopicFacts(CatalogModel):
    """A topic that the device publishes; ``publisher`` is a node of the driver, or ``driver`` for its controllers."""

    name: GraphName
    type: Text
    qos: QosUse
    publisher: GraphName
    rate: Frequency | None = None
    frame: Token | None = None


class ServiceFacts(CatalogModel):
    """A service that the device answers."""

    name: GraphName
    type: Text
    server: GraphName
    effect: EffectFacts | None = None


class ActionFacts(CatalogModel):
    """An action that the device executes; ``effect`` where it acts past every controller.

    ``only`` empty means every distribution.
    """

    name: GraphName
    type: Text
    server: GraphName
    only: tuple[DistroName, ...] = ()
    effect: EffectFacts | None = None


class ViewFacts(CatalogModel):
    """What a stream can see: whole angles of the sensor, and the distances between which it is used."""

    horizontal: FieldAngle
    vertical: FieldAngle
    nearest: Length
    farthest: Length
    source: Text


class ImageFacts(CatalogModel):
    """The images of a stream as the node of the device is started."""

    width: int = Field(ge=1, le=100_000)
    height: int = Field(ge=1, le=100_000)
    bytes_per_pixel: int = Field(ge=1, le=64)
    source: Text


class StreamFacts(CatalogModel):
    """One image stream of a camera; ``frame`` is a link name without prefix."""

    topic: GraphName
    type: Text
    info_topic: GraphName
    frame: Token
    rate: Frequency
    qos: QosUse
    info_qos: QosUse
    view: ViewFacts | None = None
    image: ImageFacts | None = None


class CameraFacts(CatalogModel):
    """A camera: its streams, and what its stamps mean.

    ``exposure_parameters`` of its node are the exposure in the unit given for each, ``auto_exposure_parameters`` hand
    it to the camera; ``serial_parameter`` tells the node which camera is meant, a text with an underscore before it.
    """

    streams: dict[Token, StreamFacts] = Field(min_length=1)
    exposure: Duration | None = None
    exposure_parameters: dict[Text, Duration] = Field(default_factory=dict)
    auto_exposure_parameters: tuple[Text, ...] = ()
    serial_parameter: Text | None = None
    hardware_clock: bool
    source: Text
