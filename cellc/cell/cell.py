"""The cell: everything that the spec and the catalogue say, bound and in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.cell.control import Controller, ControllerManager
from cellc.cell.device import Device
from cellc.cell.frame import Frame, SceneBox
from cellc.cell.interface import Interface, Node
from cellc.cell.motion import CartesianGoal, NamedPose, PlanningGroup
from cellc.cell.rehearsal import Rehearsal
from cellc.diagnostics import Span
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """A linked cell; every tuple is sorted as the user wrote it, derived entities after written ones.

    Args:
        spec: sections that hold nothing to bind: versions, hosts, network, owners, safety, bringup, kpis, recording.
        document: the text behind the spec, for places.
        distro: the pinned distribution, or UNKNOWN.
        behaviours: controller plugin type string → neutral behaviour, for the plugins in use.
    """

    name: str
    spec: CellSpec
    document: SourceDocument
    distro: str
    devices: tuple[Device, ...]
    frames: tuple[Frame, ...]
    scene: tuple[SceneBox, ...]
    nodes: tuple[Node, ...]
    interfaces: tuple[Interface, ...]
    managers: tuple[ControllerManager, ...]
    groups: tuple[PlanningGroup, ...]
    poses: tuple[NamedPose, ...]
    goals: tuple[CartesianGoal, ...]
    rehearsals: tuple[Rehearsal, ...]
    behaviours: Mapping[str, str]

    def locate(self, *path: str | int) -> Span:
        """Return the place of a YAML path, or of its nearest ancestor that the user wrote.

        Where a whole section is missing that is the cell's own name, not the first line of the file.
        """
        return self.document.locate(path if self.document.has(path[:1]) else ("cell",))

    def states(self, *path: str | int) -> bool:
        """Tell whether the user wrote something at a YAML path."""
        return self.document.has(path)

    @property
    def controllers(self) -> tuple[Controller, ...]:
        """Controllers of all managers, in order."""
        return tuple(controller for manager in self.managers for controller in manager.controllers)

    def device(self, name: str) -> Device:
        """Return a device by its name in the spec.

        Raises:
            KeyError: there is none of that name.
        """
        for device in self.devices:
            if device.name == name:
                return device
        raise KeyError(name)
