"""The real targets of the repository's cells, as each is emitted for every release of a driver that was read."""

from __future__ import annotations

import re
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.deployment import plan_deployment
from cellc.compiler.emit import description, package, parameters
from cellc.compiler.emit.launch import launch
from cellc.compiler.emit.security import policy
from tests.cells import CELLS, EVERY_CELL, graph_of, spec_text
from tests.foreign_yaml import safe_load
from tests.vendors.oracle import RELEASES, Release


@dataclass(frozen=True, slots=True)
class RealTarget:
    """What is written for one cell with one release of the driver of one of its devices."""

    cell: Cell
    device: str
    release: Release
    texts: dict[str, str]

    def yaml(self, path: str) -> Any:
        """Return the data of a parameter file."""
        return safe_load(self.texts[path])

    @property
    def component(self) -> ElementTree.Element:
        """The ``<ros2_control>`` tag of the device in the description."""
        root = ElementTree.fromstring(self.texts[f"urdf/{self.cell.name}.real.urdf"])
        hardware = self.cell.device(self.device).control.hardware
        assert hardware is not None
        (tag,) = (tag for tag in root.findall("ros2_control") if tag.get("name") == hardware.name)
        return tag

    @property
    def prefix(self) -> str:
        """What stands before the ROS names of the device."""
        return self.cell.device(self.device).body.prefix


_EMITTERS = (description.emit, parameters.emit, launch.emit, policy.emit, package.emit)


def _written(text: str, model: str, release: Release) -> str:
    """Return a spec for the distribution of a release, with the driver of the device pinned to it."""
    text = re.sub(r"\bros: \w+", f"ros: {release.distro}", text)
    block = re.compile(rf"(model: {model}\n(?:    .*\n)*?    driver: ).*\n")
    return block.sub(rf"\g<1>{release.driver}\n", text)


@dataclass(frozen=True, slots=True)
class Case:
    """A cell, a release of the driver of one of its devices, and controllers that are left out of the cell or added."""

    cell: str
    release: Release
    without: str = ""
    added: str = ""

    def __str__(self) -> str:
        return f"{self.cell}-{self.release}"


def _cells_with(device: str) -> tuple[str, ...]:
    """Return the cells that a device is held in: a further one only where those that go through everything lack it.

    Where an adapter on the library of its vendor drives it, no release of the driver is loaded.
    """
    loaded = re.compile(rf"model: {device}\n(?!(?:    .*\n)*?    architecture: direct_sdk)")
    having = [cell for cell in EVERY_CELL if loaded.search(spec_text(cell))]
    return tuple(cell for cell in having if cell in CELLS) or tuple(having)


CASES = tuple(Case(cell, release) for release in RELEASES for cell in _cells_with(release.device))
"""Cells with every release of every driver in them; none where the shared folder is absent."""


@cache
def real_target(case: Case) -> RealTarget:
    """Return the files of a case; the rules are not asked, because a pin may be one that no distribution releases."""
    release = case.release
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cell.yaml"
        text = re.sub(rf"\n    {case.without}: .*", "", spec_text(case.cell)) if case.without else spec_text(case.cell)
        text = text.replace("  controllers:\n", f"  controllers:\n{case.added}", 1)
        path.write_text(_written(text, release.device, release), encoding="utf-8")
        graph = graph_of(path)
    plan = plan_deployment(graph)
    texts = {artifact.path: artifact.text for emit in _EMITTERS for artifact in emit(graph, plan)}
    (device,) = (device.name for device in graph.cell.devices if device.model == release.device)
    return RealTarget(graph.cell, device, release, texts)
