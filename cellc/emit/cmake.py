"""``CMakeLists.txt``: installs the package's folders, read by colcon through ament_cmake.

There is nothing to compile. Left out: tests and targets of the user's own, which belong into a package beside this one.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.formats.header import Header
from cellc.graph.cell_graph import CellGraph

_FOLDERS = ("config", "launch", "security", "urdf")
_ON_HOSTS = "middleware"
_FILES = ("contract.json", "manifest.json", "rehearsals.json")


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the build file."""
    lines = [
        "cmake_minimum_required(VERSION 3.8)",
        f"project({graph.cell.name} NONE)",
        "",
        "find_package(ament_cmake REQUIRED)",
        "",
        *_install("DIRECTORY", (*_FOLDERS, *((_ON_HOSTS,) if graph.cell.spec.hosts else ()))),
        *_install("FILES", _FILES),
        "",
        "ament_package()",
    ]
    yield Artifact("CMakeLists.txt", header.commented("#") + "\n".join(lines) + "\n")


def _install(kind: str, names: tuple[str, ...]) -> list[str]:
    return [f"install({kind}", *(f"  {name}" for name in names), "  DESTINATION share/${PROJECT_NAME}", ")"]
