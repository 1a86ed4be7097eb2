"""Topics, services and actions of the contract."""

from __future__ import annotations

from dataclasses import asdict

from cellc.cell.cell import Cell
from cellc.cell.interface import Endpoint, Interface, Qos
from cellc.contract.contract import ContractEndpoint, ContractInterface, ContractQos
from cellc.contract.network import ContractNetwork


def interfaces(cell: Cell) -> dict[str, ContractInterface]:
    """Return every interface by its full name."""
    return {interface.name: _interface(interface) for interface in cell.interfaces}


def _interface(interface: Interface) -> ContractInterface:
    return ContractInterface(
        kind=interface.kind.value,
        type=interface.type,
        sources=tuple(map(_endpoint, interface.sources)),
        sinks=tuple(map(_endpoint, interface.sinks)),
        frame=interface.frame,
        unit=interface.unit,
        time_source=interface.time_source,
        owner=interface.owner,
        wants=interface.wants,
        rate_hz=interface.rate_hz,
        max_age_s=interface.max_age_s,
        transport_s=interface.transport_s,
        on_stale=interface.on_stale,
        timeout_s=interface.timeout_s,
        on_timeout=interface.on_timeout,
        on_error=interface.on_error,
        cancel_within_s=interface.cancel_within_s,
        simulated=None if interface.simulated is None else ContractNetwork(**asdict(interface.simulated)),
    )


def _endpoint(end: Endpoint) -> ContractEndpoint:
    # Through validation, because the cell's words are plain text and the contract's are fixed.
    return ContractEndpoint.model_validate(
        {"node": end.node, "full_name": end.full_name, "targets": end.targets, "qos": _qos(end.qos)}
    )


def _qos(qos: Qos) -> ContractQos:
    return ContractQos.model_validate(
        {
            "reliability": qos.reliability,
            "durability": qos.durability,
            "history": qos.history,
            "depth": qos.depth,
            "deadline_s": qos.deadline_s,
            "lifespan_s": qos.lifespan_s,
            "liveliness": qos.liveliness,
            "lease_duration_s": qos.lease_duration_s,
        }
    )
