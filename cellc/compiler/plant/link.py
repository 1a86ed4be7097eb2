"""From the spec of a plant to the plant: its cells read and checked where they lie, and every reference bound."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from cellc.compiler.cell.frame import WORLD
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import pose, vector
from cellc.compiler.plant.findings import finding
from cellc.compiler.plant.plant import Crossing, Part, Plant, PlantArea
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.source.findings import finding as unread
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.parse import parse_as
from cellc.compiler.spec.plant import PART_KEY, PartSpec, PlantSpec, spec_model
from cellc.contract.diagnostics import Diagnostic, Related, Severity, YamlPath
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.contract.transforms import Pose, identity
from cellc.robot.description.packages import lies_under, repository_of


@dataclass(frozen=True, slots=True)
class CheckedPart:
    """What checking the spec of a cell gave; no graph where it has errors."""

    findings: Findings
    graph: CellGraph | None
    document: SourceDocument | None


Check = Callable[[str], CheckedPart]
"""Reads, links and checks one cell."""


def is_plant(document: SourceDocument | None) -> bool:
    """Tell whether a document is the spec of a plant."""
    return document is not None and spec_model(document.data) is PlantSpec


@dataclass(frozen=True, slots=True)
class LinkedPlant:
    """A plant with the texts of the specs of its cells; no plant where something could not be bound."""

    plant: Plant | None
    texts: Mapping[str, str]
    diagnostics: tuple[Diagnostic, ...]


def link_plant(document: SourceDocument, check: Check) -> LinkedPlant:
    """Check the cells of a plant, and bind what its spec says of them."""
    unsupported = tuple(_unsupported(document))
    for found in unsupported:
        document = document.without(found.yaml_path)
    spec = parse_as(PlantSpec, document)
    if spec.value is None:
        return LinkedPlant(None, {}, (*unsupported, *spec.diagnostics))
    linker = _Linker(spec.value, document, check)
    plant = linker.plant()
    every = tuple(dict.fromkeys((*unsupported, *spec.diagnostics, *linker.findings)))
    stops = any(found.severity is Severity.ERROR for found in every)
    return LinkedPlant(None if stops else plant, linker.texts, every)


def _unsupported(document: SourceDocument) -> Iterator[Diagnostic]:
    """Yield the sections that a cell may have and a plant does not, and interfaces that no bridge carries."""
    for key in document.root.children:
        if key in CellSpec.model_fields and key not in PlantSpec.model_fields:
            span, message = document.locate_key((key,)), f"not supported in a plant yet: `{key}`"
            yield finding("unsupported-in-plant", message, span, (key,), "write it in the spec of one of its cells")
    interfaces = document.child(("interfaces",))
    for name, child in interfaces.node.children.items() if interfaces is not None else ():
        for kind in ("service", "action"):
            if kind in child.node.children:
                path = ("interfaces", name)
                message, advice = f"not supported in a plant yet: a {kind} from cell to cell", "let topics cross"
                yield finding("unsupported-in-plant", message, document.locate((*path, kind)), path, advice)


class _Linker:
    """One plant while its references are bound, and what was found so far."""

    def __init__(self, spec: PlantSpec, document: SourceDocument, check: Check) -> None:
        self.findings: list[Diagnostic] = []
        self.texts: dict[str, str] = {}
        self._spec, self._document, self._check = spec, document, check
        self._parts: dict[str, Part] = {}

    def plant(self) -> Plant | None:
        """Return the plant; what it lacks is found."""
        self._read()
        if self.findings:
            return None
        self._place()
        spec, document = self._spec, self._document
        return Plant(
            name=spec.cell,
            named_at=document.locate(("cell",)),
            file=document.file,
            summary=spec.summary,
            parts=self._parts,
            crossings=tuple(self._crossings()),
            areas=tuple(self._areas()),
        )

    def _read(self) -> None:
        if len(self._spec.cells) > limits().plant_cells:
            message = f"the plant has {len(self._spec.cells)} cells; at most {limits().plant_cells} are read"
            span = self._document.locate_key((PART_KEY,))
            self.findings.append(unread("too-many-includes", message, span, path=(PART_KEY,), limit="plant-cells"))
            return
        for key, part in self._spec.cells.items():
            path = (PART_KEY, key, "spec")
            file = self._file(part, path)
            if isinstance(file, Diagnostic):
                self.findings.append(file)
            else:
                self._read_part(key, part, file)

    def _file(self, part: PartSpec, path: YamlPath) -> str | Diagnostic:
        """Return the spec of a cell as the current folder sees it; it lies in the repository of the plant."""
        place = self._document.locate(path)
        if "\0" in part.spec:
            return unread("file-unreadable", f"`{part.spec}` is not a file name", place, path=path)
        file = os.path.normpath(Path(place.file).parent / part.spec).replace(os.sep, "/")
        if os.path.isabs(part.spec) or not lies_under(file, repository_of(os.path.dirname(self._document.file) or ".")):
            message = f"`{part.spec}` leads out of the repository of the plant"
            advice = "name a spec of the repository, relative to this file"
            return unread("include-escape", message, place, path=path, advice=advice)
        if os.path.realpath(file) == os.path.realpath(self._document.file):
            return unread("include-cycle", f"`{part.spec}` is the plant itself", place, path=path)
        if not os.path.isfile(file):
            return unread("file-not-found", f"there is no file `{file}`", place, path=path)
        return file

    def _read_part(self, key: str, part: PartSpec, file: str) -> None:
        path, checked = (PART_KEY, key), self._check(file)
        span = self._document.locate_key(path)
        named = Related(f"cell `{key}` of the plant", span)
        errors = [found for found in checked.findings.diagnostics if found.severity is Severity.ERROR]
        self.texts.update(checked.findings.texts)
        if errors or checked.graph is None or checked.document is None:
            self.findings += (replace(found, related=(*found.related, named)) for found in errors)
            return
        self._parts[key] = Part(
            key=key,
            path=path,
            span=span,
            file=file,
            spec=part.spec,
            owner=part.owner,
            pose=identity(),
            graph=checked.graph,
            document=checked.document,
        )

    def _place(self) -> None:
        """Put each cell where its mount is: in the world, or in a fixed frame of another cell."""
        poses: dict[str, Pose] = {}
        for key in self._parts:
            self._pose(key, poses, ())
        self._parts = {key: replace(part, pose=poses.get(key, part.pose)) for key, part in self._parts.items()}

    def _pose(self, key: str, poses: dict[str, Pose], below: tuple[str, ...]) -> Pose | None:
        if key in poses:
            return poses[key]
        mount, path = self._spec.cells[key].mount, (PART_KEY, key, "mount", "parent")
        if mount.calibration is not None:
            at, message = (*path[:-1], "calibration"), "not supported in a plant yet: a calibration of a mount"
            self._find("unsupported-in-plant", message, at, "state the mount as it was measured, without `calibration`")
        if key in below:
            self._find("frame-cycle", f"`{key}` is mounted on itself", path, "mount it in `world`")
            return None
        frame = self._frame(mount.parent, path)
        if frame is None:
            return None
        of, inside = frame
        parent = identity() if not of else self._pose(of, poses, (*below, key))
        if parent is None:
            return None
        return poses.setdefault(key, parent @ inside @ pose(mount.xyz, mount.rpy))

    def _frame(self, reference: str, path: YamlPath) -> tuple[str, Pose] | None:
        """Return the cell of a frame, and the pose in its world; no cell for the world of the plant."""
        if reference == WORLD:
            return "", identity()
        bound = self._part(reference, path)
        if bound is None:
            return None
        part, name = bound
        frame = part.frame_of(name)
        if frame is None:
            self.findings.append(
                unknown_name("unknown-frame", reference, "frame", self._frames(part), self._document, path)
            )
            return None
        place = part.at_rest(frame)
        if place is None:
            message = f"`{reference}` moves in `{part.key}`"
            self._find("mount-on-dynamic-frame", message, path, "name a frame that is at rest in its cell")
            return None
        return part.key, place

    def _frames(self, part: Part) -> tuple[str, ...]:
        return tuple(f"{part.key}/{name}" for name in part.graph.frames.names())

    def _part(self, reference: str, path: YamlPath) -> tuple[Part, str] | None:
        key, slash, name = reference.partition("/")
        if slash and key in self._parts:
            return self._parts[key], name
        known = ", ".join(f"`{each}`" for each in self._parts)
        message = f"there is no cell `{key}` in this plant" if slash else f"`{reference}` names no cell of this plant"
        self._find(
            "unknown-part", message, path, f"write the key of a cell and a slash before the name; cells: {known}"
        )
        return None

    def _node(self, reference: str, path: YamlPath) -> tuple[Part, str] | None:
        bound = self._part(reference, path)
        if bound is None:
            return None
        part = bound[0]
        ends = {end.node for each in part.cell.interfaces for end in (*each.sources, *each.sinks)}
        known = tuple(f"{part.key}/{each}" for each in sorted({*ends, *(node.name for node in part.cell.nodes)}))
        if reference in known:
            return bound
        self.findings.append(unknown_name("unknown-node", reference, "node", known, self._document, path))
        return None

    def _crossings(self) -> Iterator[Crossing]:
        for name, crossing in self._spec.interfaces.items():
            path = ("interfaces", name)
            source = self._node(crossing.from_, (*path, "from"))
            for number, reference in enumerate(crossing.to):
                receiver = self._node(reference, (*path, "to", number))
                if source is None or receiver is None:
                    continue
                if source[0] is receiver[0]:
                    message, advice = f"`{name}` does not leave `{source[0].key}`", "write it in the spec of that cell"
                    self._find("crossing-not-declared", message, (*path, "to", number), advice)
                    continue
                yield Crossing(
                    name=name,
                    path=path,
                    span=self._document.locate_key(path),
                    type=crossing.topic,
                    owner=crossing.owner,
                    source=source[0],
                    source_node=source[1],
                    receiver=receiver[0],
                    receiver_node=receiver[1],
                )

    def _areas(self) -> Iterator[PlantArea]:
        for name, area in self._spec.areas.items():
            path = ("areas", name)
            frame = self._frame(area.parent, (*path, "parent"))
            if frame is not None:
                of, inside = frame
                parent = self._parts[of].pose if of else identity()
                yield PlantArea(
                    name=name,
                    span=self._document.locate_key(path),
                    pose=parent @ inside @ pose(area.xyz, area.rpy),
                    size=vector(area.box),
                    granted_by=area.granted_by,
                    released=area.released or "",
                )

    def _find(self, code: str, message: str, path: YamlPath, advice: str) -> None:
        self.findings.append(finding(code, message, self._document.locate(path), path, advice))
