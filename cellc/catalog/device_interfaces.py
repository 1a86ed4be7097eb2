"""What a device offers: joints and their interfaces, plugins, drivers, topics, services, actions and cameras."""

import re
from typing import Annotated, Literal, Union

from pydantic import Field

from cellc.catalog.catalog_model import (
    BehaviourName,
    CatalogModel,
    DistroName,
    FileName,
    GraphName,
    MomentName,
    NodeName,
    ParameterFact,
    Text,
    Token,
)
from cellc.catalog.effects import EffectFacts, StartFacts
from cellc.spec.base import MOST
from cellc.spec.quantity import Duration, Frequency
from cellc.vocabulary import Distro

InterfaceName = Text
"""The part after the slash: ``position``, ``force.x``, ``speed_scaling_factor``."""


_COMMIT = re.compile(r"(?=.*[a-f])[0-9a-f]{7,40}|[0-9a-f]{40}")


def is_commit(version: str) -> bool:
    """Whether a version is the hash of a commit, in full or cut short: a number alone is none."""
    return _COMMIT.fullmatch(version) is not None


def same_version(pinned: str, known: str) -> bool:
    """Whether a pin names a version of the catalog; a commit may be cut short."""
    return pinned == known or (is_commit(pinned) and is_commit(known) and known.startswith(pinned))


class HardwareRelease(CatalogModel):
    """What the plugin of some releases of the driver is given beside what all are given; ``drivers`` are versions."""

    distro: DistroName
    drivers: tuple[Text, ...] = Field(min_length=1)
    parameters: dict[Text, Text] = Field(default_factory=dict)
    source: Text


class HardwareFacts(CatalogModel):
    """A hardware plugin, the ``<param>`` values that it is given, and what it does in the world.

    ``left_out_when_empty`` are parameters that the plugin has a default for: an empty ``<param>`` makes the reader of
    ros2_control complain. ``command_timeout`` is the longest silence of the controller manager before the device ends
    what it does.
    """

    plugin: Text
    parameters: dict[Text, Text] = Field(default_factory=dict)
    left_out_when_empty: tuple[Text, ...] = ()
    releases: tuple[HardwareRelease, ...] = ()
    effects: dict[MomentName, EffectFacts] = Field(default_factory=dict)
    start: StartFacts | None = None
    command_timeout: Duration | None = None
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


class JointInterfaces(CatalogModel):
    """Command and state interfaces of a joint."""

    command: tuple[InterfaceName, ...] = ()
    state: tuple[InterfaceName, ...] = ()


class GroupInterfaces(CatalogModel):
    """Interfaces of a ``<sensor>`` or ``<gpio>``; ``initial`` values are what a mock starts from.

    ``fixed_name`` where the hardware exports them under this very name, whatever prefix the device has.
    """

    command: tuple[InterfaceName, ...] = ()
    state: tuple[InterfaceName, ...] = ()
    initial: dict[InterfaceName, Annotated[float, Field(allow_inf_nan=False)]] = Field(default_factory=dict)
    real_only: bool = False
    fixed_name: bool = False


class ControlFacts(CatalogModel):
    """One ``<ros2_control>`` tag.

    ``component`` is the tag's name, which is a node name too from Jazzy on; ``update_rates`` are those that the device
    accepts, none for any; ``joints`` are named without prefix, ``*`` stands for every joint that moves on its own.
    """

    component: NodeName
    update_rates: tuple[Frequency, ...] = ()
    hardware: HardwareByTarget
    joints: dict[Text, JointInterfaces]
    sensors: dict[Token, GroupInterfaces] = Field(default_factory=dict)
    gpios: dict[Token, GroupInterfaces] = Field(default_factory=dict)


class PluginUse(CatalogModel):
    """A controller plugin in one distribution; ``behaviour`` where it does otherwise than the kind is called."""

    type: Text
    package: Token
    behaviour: BehaviourName | None = None
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)


class DriverFacts(CatalogModel):
    """What moves the device on the real target where ``hardware`` names no plugin for it.

    ``node`` is one of the device's nodes, ``joint_states`` one of its topics, and ``actions`` tell which of its actions
    takes the goals of a kind of controller that is not spawned there.
    """

    node: NodeName
    joint_states: GraphName | None = None
    actions: dict[Token, GraphName] = Field(default_factory=dict)
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

    ``effect`` is what the start of its process does.
    """

    name: NodeName
    package: Token
    executable: FileName
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)
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
    """An action that the device executes; ``effect`` where it acts past every controller."""

    name: GraphName
    type: Text
    server: GraphName
    effect: EffectFacts | None = None


class StreamFacts(CatalogModel):
    """One image stream of a camera; ``frame`` is a link name without prefix."""

    topic: GraphName
    type: Text
    info_topic: GraphName
    frame: Token
    rate: Frequency
    qos: QosUse
    info_qos: QosUse


class CameraFacts(CatalogModel):
    """A camera: its streams, and what its stamps mean."""

    streams: dict[Token, StreamFacts] = Field(min_length=1)
    exposure: Duration | None = None
    hardware_clock: bool
    source: Text
