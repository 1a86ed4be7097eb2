"""What every entity of a cell carries, its name and where the user wrote it, and the places of everything written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import PurePosixPath

from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Entity:
    """A named thing of the cell.

    Args:
        name: name in the ROS graph, prefix applied.
        path: where the spec speaks of it; for a derived thing, the path of what it was derived from.
        span: the place of ``path`` in the user's files.
    """

    name: str
    path: YamlPath
    span: Span


ELSEWHERE = "shown elsewhere"
"""Marks a field, ``Annotated[…, ELSEWHERE]``, that people find in the catalog or in another field."""
STATED = "stated"
"""Marks a field that people see as the user wrote it, under the key of its name; what is used where nothing is."""


class Part:
    """Fields of an entity that are read together; people see them as its own fields, so no two parts share a name."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Places:
    """Where the user wrote each value of the spec, and the scalars as written.

    Args:
        file: the root spec as the user named it.
        spans: by YAML path; a list or mapping has the place of its key.
        texts: scalars by YAML path, quotes removed, in the order of the files.
    """

    file: str
    spans: Mapping[YamlPath, Span] = field(default_factory=dict)
    texts: Mapping[YamlPath, str] = field(default_factory=dict)

    @property
    def file_name(self) -> str:
        """Name of the root spec without its folders."""
        return PurePosixPath(self.file).name

    def has(self, path: YamlPath) -> bool:
        """Return whether the user wrote a value at ``path``."""
        return path in self.spans

    def locate(self, path: YamlPath) -> Span:
        """Return the place of ``path``, or of its nearest ancestor that the user wrote."""
        while path and path not in self.spans:
            path = path[:-1]
        return self.spans[path] if path else Span(self.file, 1, 1, 1, 1)
