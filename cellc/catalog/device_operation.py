"""How a device is reached, stopped and kept at versions that work together."""


from typing import Literal

from pydantic import Field

from cellc.catalog.catalog_model import CatalogModel, Date, Distro, Text, Token


class PortFacts(CatalogModel):
    """One port; ``direction`` tells who opens the connection."""

    port: int = Field(ge=1, le=65535)
    protocol: Literal["tcp", "udp"]
    direction: Literal["host_to_device", "device_to_host"]
    service: Text


class NetworkFacts(CatalogModel):
    """What the device asks of its network."""

    ports: tuple[PortFacts, ...] = ()
    default_subnet: Text | None = None
    dedicated_link: bool
    realtime: Literal["required", "recommended", "not_needed"]
    source: Text


class SafetyStateFacts(CatalogModel):
    """A state of the device's own safety controller and how its driver reports it."""

    name: Token
    stops: bool
    reported: Text | None = None


class RecoveryFacts(CatalogModel):
    """The way out of one state: steps in order, the human ones first."""

    state: Token
    steps: tuple[Text, ...] = Field(min_length=1)


class SafetyFacts(CatalogModel):
    """The vendor's safety boundary; no software of the cell is part of it."""

    stop_authority: Text
    states: tuple[SafetyStateFacts, ...] = ()
    modes: tuple[Text, ...] = ()
    recovery: tuple[RecoveryFacts, ...] = ()
    watchdog: Text | None = None
    source: Text


class VersionRow(CatalogModel):
    """Versions that go together on one distribution; ``known`` are those that the source names."""

    part: Literal["driver", "sdk", "description", "firmware"]
    distro: Distro | None = None
    product: Text | None = None
    known: tuple[Text, ...] = ()
    minimum: Text | None = None
    below: Text | None = None
    note: Text | None = None
    source: Text
    as_of: Date
