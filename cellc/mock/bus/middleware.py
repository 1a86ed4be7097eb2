"""What the pinned middleware does with QoS: the rules of DDS, or those of one that has none of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cellc.contract.contract import Contract, ContractQos
from cellc.mock.bus.qos import Incompatibility, incompatibilities

ZENOH_PREFIX = "rmw_zenoh"


@dataclass(frozen=True, slots=True)
class Middleware:
    """Rules of one middleware.

    Attributes:
        compare: returns every policy that keeps an offering and a requesting endpoint apart.
        tells: it tells of missed deadlines and lost liveliness.
    """

    compare: Callable[[ContractQos, ContractQos], tuple[Incompatibility, ...]]
    tells: bool


def _any_two_match(offered: ContractQos, requested: ContractQos) -> tuple[Incompatibility, ...]:
    return ()


DDS = Middleware(incompatibilities, tells=True)
ZENOH = Middleware(_any_two_match, tells=False)
"""Endpoints on one key always match; rmw_zenoh_cpp has no events for deadlines and leases."""


def middleware_of(contract: Contract) -> Middleware:
    """Return the rules of the middleware that a cell pins; those of DDS where it pins none."""
    return ZENOH if contract.version_tuple.get("rmw", "").startswith(ZENOH_PREFIX) else DDS
