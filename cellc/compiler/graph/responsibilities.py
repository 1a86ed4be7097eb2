"""The responsibility graph: who is responsible for what."""

from __future__ import annotations

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import NodeSource
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN


@dataclass(frozen=True, slots=True)
class Responsibility:
    """A thing that somebody is responsible for; ``kind`` is responsibility, approval, node, calibration or
    procedure."""

    kind: str
    name: str
    owner: str
    path: YamlPath

    @property
    def open(self) -> bool:
        """Whether it has no owner yet."""
        return self.owner == UNKNOWN


@dataclass(frozen=True, slots=True)
class Responsibilities:
    """Everything of the cell that has an owner, in the order of the spec."""

    items: tuple[Responsibility, ...]

    def of_kind(self, kind: str) -> tuple[Responsibility, ...]:
        """Return the responsibilities of one kind."""
        return tuple(item for item in self.items if item.kind == kind)

    def of_owner(self, owner: str) -> tuple[Responsibility, ...]:
        """Return what one owner is responsible for."""
        return tuple(item for item in self.items if item.owner == owner)

    def owners(self) -> tuple[str, ...]:
        """Name every owner once, without UNKNOWN."""
        return tuple(dict.fromkeys(item.owner for item in self.items if not item.open))


def build_responsibilities(cell: Cell) -> Responsibilities:
    """Gather the owners that the spec names."""
    items = [
        Responsibility("responsibility", name, str(owner), ("owners", "responsibilities", name))
        for name, owner in cell.owners.responsibilities
    ]
    items += [
        Responsibility("approval", name, str(owner), ("owners", "approvals", name))
        for name, owner in cell.owners.approvals
    ]
    items += [
        Responsibility("calibration", name, calibration.owner, ("calibrations", name, "owner"))
        for name, calibration in cell.calibrations.items()
    ]
    items += [
        Responsibility("node", node.name, node.owner, (*node.path, "owner"))
        for node in cell.nodes
        if node.source is NodeSource.SPEC
    ]
    recovery = cell.safety.recovery
    items.append(Responsibility("procedure", "recovery", recovery.owner, ("safety", "recovery", "owner")))
    items.append(Responsibility("procedure", "observer", recovery.observer, ("safety", "recovery", "observer")))
    return Responsibilities(tuple(items))
