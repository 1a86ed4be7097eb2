"""Named QoS profiles of rmw, what is left open in them, and the profiles of endpoints that every cell has."""


from typing import Literal

from pydantic import Field

from cellc.catalog.catalog_model import CatalogModel, Date, Text, Token
from cellc.spec.quantity import Duration

Rmw = Literal["rmw_fastrtps_cpp", "rmw_cyclonedds_cpp", "rmw_zenoh_cpp"]
RMWS: tuple[Rmw, ...] = ("rmw_fastrtps_cpp", "rmw_cyclonedds_cpp", "rmw_zenoh_cpp")


class QosProfile(CatalogModel):
    """One profile; ``system_default`` and ``best_available`` settings are decided by the middleware."""

    history: Literal["keep_last", "keep_all", "system_default"]
    depth: int = Field(ge=0)
    reliability: Literal["reliable", "best_effort", "system_default", "best_available"]
    durability: Literal["volatile", "transient_local", "system_default", "best_available"]
    lifespan: Duration | None = None


class SystemDefault(CatalogModel):
    """What an RMW makes of ``system_default`` at one kind of endpoint."""

    reliability: Literal["reliable", "best_effort"]
    durability: Literal["volatile", "transient_local"]
    depth: int = Field(ge=1)


class SystemDefaults(CatalogModel):
    """Both ends; they differ with Fast DDS."""

    writer: SystemDefault
    reader: SystemDefault


class KnownEndpoint(CatalogModel):
    """An endpoint whose profile its author fixed; ``overridable`` where a parameter may change it."""

    topic: Text
    type: Text
    node: Text
    direction: Literal["publish", "subscribe"]
    qos: Token
    overridable: bool = False
    source: Text


class QosTable(CatalogModel):
    """``catalog/qos_profiles.yaml``."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    profiles: dict[Token, QosProfile]
    system_default: dict[Rmw, SystemDefaults]
    endpoints: tuple[KnownEndpoint, ...]
    action: dict[Literal["send_goal", "cancel_goal", "get_result", "feedback", "status"], Token]
