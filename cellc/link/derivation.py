"""What interfaces are derived from, and the ends that derived ones have."""

from __future__ import annotations

from dataclasses import dataclass, replace

from cellc.cell.control import ControllerManager
from cellc.cell.device import Device
from cellc.cell.frame import Frame
from cellc.cell.interface import Endpoint, Qos
from cellc.diagnostics import YamlPath
from cellc.link.endpoints import EndName, EndpointNames
from cellc.link.qos import QosResolver
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec
from cellc.vocabulary import Distro


@dataclass(frozen=True, slots=True)
class Derivation:
    """The linked parts of a cell that bring interfaces along."""

    spec: CellSpec
    document: SourceDocument
    distro: Distro
    managers: tuple[ControllerManager, ...]
    devices: tuple[Device, ...]
    frames: tuple[Frame, ...]
    ends: EndpointNames
    resolver: QosResolver

    def end(self, node: str, interface: str, path: YamlPath, qos: Qos | None = None) -> Endpoint:
        """Return an end by its name in the spec or its full name; one that nothing has is reported elsewhere."""
        known = self.ends.known.get(node, EndName(node, f"/{node.lstrip('/')}", "UNKNOWN"))
        return known.end(interface, path, self.document.locate(path), qos)

    def driver_end(self, device: str, node: str, interface: str, path: YamlPath, qos: Qos | None = None) -> Endpoint:
        """Return the end of a driver's node, which runs on the real target alone."""
        return replace(self.end(device, interface, path, qos), full_name=node, targets=("real",))

    def planners(self) -> tuple[tuple[str, YamlPath], ...]:
        """Return the nodes that command a controller's motion, each with the place where that is written."""
        found: dict[str, YamlPath] = {}
        for manager in self.managers:
            for controller in manager.controllers:
                if controller.client is not None:
                    found.setdefault(controller.client, (*controller.path, "client"))
        return tuple(found.items())
