"""Nodes of a device's driver and what they publish, serve and execute."""


from typing import Literal, Union

from pydantic import Field

from cellc.catalog.catalog_model import CatalogModel, ParameterFact, Text, Token
from cellc.spec.quantity import Duration, Frequency


class QosFacts(CatalogModel):
    """A profile spelt out where none of the named ones fits."""

    reliability: Literal["reliable", "best_effort"]
    durability: Literal["volatile", "transient_local"]
    history: Literal["keep_last", "keep_all"] = "keep_last"
    depth: int = Field(10, ge=1)


QosUse = Union[Token, QosFacts]
"""Name of a profile in ``qos_profiles.yaml``, or the settings themselves."""


class NodeFacts(CatalogModel):
    """A node of the driver for the real target; ``publishes_tf`` where it is an authority for frames."""

    name: Text
    package: Token
    executable: Text
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)
    publishes_tf: bool = False
    provides: Literal["real", "every_target"] = "real"
    source: Text


class TopicFacts(CatalogModel):
    """A topic that the device publishes; ``publisher`` is a node of the driver, or ``driver`` for its controllers."""

    name: Text
    type: Text
    qos: QosUse
    publisher: Text
    rate: Frequency | None = None
    frame: Token | None = None


class ServiceFacts(CatalogModel):
    """A service that the device answers."""

    name: Text
    type: Text
    server: Text


class ActionFacts(CatalogModel):
    """An action that the device executes."""

    name: Text
    type: Text
    server: Text


class StreamFacts(CatalogModel):
    """One image stream of a camera; ``frame`` is a link name without prefix."""

    topic: Text
    type: Text
    info_topic: Text
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
