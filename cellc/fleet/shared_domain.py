"""Cells of one call that discover each other without meaning to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.diagnostics import Diagnostic, Related, Severity
from cellc.fleet.discovery import way_between
from cellc.fleet.presence import Presence


def shared_domains(cell: Presence, earlier: Sequence[Presence]) -> Iterator[Diagnostic]:
    """Report the first earlier cell of the call whose nodes would talk to this one's."""
    for other in earlier:
        way = way_between(other, cell)
        if way is not None:
            yield Diagnostic(
                "shared-domain-id",
                Severity.ERROR,
                f"`{cell.name}` and `{other.name}` use domain {cell.domain_id} and discover each other {way}",
                cell.domain_at,
                ("network", "domain_id"),
                "give each cell a domain of its own, from 0 to 101",
                (Related(f"`{other.name}` has it here", other.domain_at),),
            )
            return
