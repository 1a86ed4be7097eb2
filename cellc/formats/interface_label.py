"""What an arrow of the cell's graph says about an interface."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.interface import Interface, InterfaceKind
from cellc.formats.numbers import shortest


def interface_facts(interface: Interface) -> Iterator[str]:
    """Yield type, frame, unit, rate, time source, owner and failure behaviour; what is not stated says so."""
    yield f"{interface.kind.value} {interface.type}, {_rate(interface)}"
    frame, unit = interface.frame or "none", interface.unit or "as the type"
    yield f"frame {frame}, unit {unit}, time {interface.time_source or 'not stated'}"
    yield f"owner {interface.owner or 'not stated'}; {', '.join(_failures(interface)) or 'failure not stated'}"


def _rate(interface: Interface) -> str:
    if interface.rate_hz is not None:
        return f"{shortest(interface.rate_hz)} Hz"
    return "rate not stated" if interface.kind is InterfaceKind.TOPIC else "on request"


def _failures(interface: Interface) -> Iterator[str]:
    if interface.on_stale is not None:
        age = "" if interface.max_age_s is None else f" after {shortest(interface.max_age_s)} s"
        yield f"stale{age}: {interface.on_stale}"
    if interface.on_timeout is not None:
        bound = "" if interface.timeout_s is None else f" after {shortest(interface.timeout_s)} s"
        yield f"timeout{bound}: {interface.on_timeout}"
    if interface.cancel_within_s is not None:
        yield f"cancel holds within {shortest(interface.cancel_within_s)} s"
    if interface.on_error is not None:
        yield f"error: {interface.on_error}"
