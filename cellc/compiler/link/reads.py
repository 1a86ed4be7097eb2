"""Which files a cell reads, there or not yet, so that nothing else counts as a change of it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import replace

from cellc.compiler.catalog.compiled import DEVICE_FILE, FAMILY_FILE
from cellc.compiler.source import read
from cellc.compiler.source.compose import compose
from cellc.compiler.source.document import Node
from cellc.compiler.source.include import include_lines
from cellc.compiler.source.text import as_yaml
from cellc.contract.frozen import dataclass
from cellc.robot.description.meshes import FORMATS
from cellc.robot.description.packages import MANIFEST

_MODELS = (".urdf", ".xacro", ".srdf", *FORMATS)
"""How names of files end that any description may name, by a package too."""
_VALUES = (".yaml", ".yml")
"""How names of files end that a xacro reads from a package or from the folder of its device."""


@dataclass(frozen=True, slots=True)
class Reads:
    """What a cell reads; all paths are absolute.

    Attributes:
        files: the spec, what it includes, and whatever its texts may name, there or not.
        devices: folders of devices.
        around: the folder of the spec and those of packages, below which descriptions lie.
    """

    files: frozenset[str]
    devices: frozenset[str] = frozenset()
    around: frozenset[str] = frozenset()

    def has(self, file: str) -> bool:
        """Tell whether the cell reads a file, or would as soon as a description named it."""
        if file in self.files:
            return True
        if not is_below(file, self.around | self.devices):
            return False
        name = os.path.basename(file)
        if name == MANIFEST or name.lower().endswith((*_MODELS, FAMILY_FILE)):
            return True
        return name.endswith(_VALUES) and (is_below(file, self.devices) or _in_package(file, self.around))

    def with_more(self, other: Reads) -> Reads:
        """Return what either reads."""
        return Reads(self.files | other.files, self.devices | other.devices, self.around | other.around)


def reads_of(spec: str, packages: Iterable[str], before: Reads | None = None) -> Reads:
    """Return what a spec reads.

    Args:
        packages: folders of packages that it names.
        before: what it read before, which it may still read where it has an error of YAML now.
    """
    source, folder = read(spec), os.path.dirname(os.path.abspath(spec))
    around = frozenset((folder, *map(os.path.abspath, packages)))
    named = {os.path.abspath(spec)}
    if source.value is not None:
        named |= {os.path.abspath(file) for file in source.value.texts}
        named |= set(_named(source.value.root))
        for file, text in source.value.texts.items():
            named |= set(_included(file, text))
    devices = frozenset(name for name in named if os.path.isfile(os.path.join(name, DEVICE_FILE)))
    reads = Reads(frozenset(named), devices, around)
    if before is None or source.ok:
        return reads
    return replace(reads.with_more(before), around=around)


def _named(node: Node) -> Iterator[str]:
    """Yield each path that a text of a document may be, relative to the file that holds it."""
    if node.text and ("/" in node.text or "." in node.text):
        yield _beside(node.span.file, node.text)
    for child in node.children.values():
        yield from _named(child.node)


def _included(file: str, text: str) -> Iterator[str]:
    root = compose(file, as_yaml(text, file).value or "").value
    lines = () if root is None else include_lines(root)
    if isinstance(lines, tuple):
        yield from (_beside(file, line.path) for line in lines)


def _beside(file: str, path: str) -> str:
    return os.path.abspath(os.path.join(os.path.dirname(file), path))


def _in_package(file: str, roots: Iterable[str]) -> bool:
    folder = os.path.dirname(file)
    while is_below(os.path.join(folder, ""), roots):
        if os.path.isfile(os.path.join(folder, MANIFEST)):
            return True
        folder = os.path.dirname(folder)
    return False


def is_below(file: str, folders: Iterable[str]) -> bool:
    """Tell whether a file lies in one of some folders."""
    return any(file.startswith(os.path.join(folder, "")) for folder in folders)
