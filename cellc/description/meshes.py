"""Where the mesh files of a robot description lie, and what an answer that rests on them is kept under.

Planning is given the files that are found here under their full paths, so that nothing else is searched for.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree

SELF_CONTAINED = (".stl", ".dae", ".obj", ".ply", ".off")
"""Formats whose shape is in the one file; others, such as glTF, may read further ones that nobody sees from here."""

_PIECE = 1 << 20


class MeshError(Exception):
    """A mesh file cannot be read; the text says which one and why."""


def find_mesh(name: str, environment: Mapping[str, str] = os.environ) -> Path:
    """Return the full path of a mesh file that a description names.

    ``package://``, ``model://`` and relative names are looked up in the folders of ``ROS_PACKAGE_PATH`` and the
    ``share`` folders of ``AMENT_PREFIX_PATH``, as pinocchio does; the first that holds the file counts.

    Raises:
        MeshError: no file is found, or the scheme is not known.
    """
    scheme, separator, path = name.partition("://")
    if not separator:
        scheme, path = "file" if os.path.isabs(name) else "package", name
    if scheme not in ("file", "package", "model"):
        raise MeshError(f"mesh `{name}` has the scheme `{scheme}`, expected `package` or `file`")
    folders = [Path()] if scheme == "file" else _search_folders(environment)
    for folder in folders:
        # Not normalized: `..` behind a link is where the system finds it. An absolute path would replace the folder.
        file = Path.cwd() / folder / (path if scheme == "file" else path.lstrip("/"))
        if os.path.isfile(file):
            return file
    raise MeshError(f"mesh `{name}` could not be found")


def _search_folders(environment: Mapping[str, str]) -> Iterator[Path]:
    for folder in filter(None, environment.get("ROS_PACKAGE_PATH", "").split(os.pathsep)):
        yield Path(folder)
        if (Path(folder) / "package.xml").exists():
            yield Path(folder) / ".."
    for prefix in filter(None, environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        yield Path(prefix) / "share"


def with_mesh_files(urdf: str) -> str:
    """Return the description with the full path of every mesh of its collision shapes.

    Raises:
        MeshError: one of them is not found.
    """
    if "<mesh" not in urdf:
        return urdf
    root = ElementTree.fromstring(urdf)
    for mesh in _collision_meshes(root):
        mesh.set("filename", str(find_mesh(mesh.get("filename", ""))))
    return ElementTree.tostring(root, encoding="unicode")


def mesh_contents(urdf: str) -> str | None:
    """Return what every mesh of the collision shapes is now: its place and the hash of its content, or its absence.

    Returns:
        None where the shapes may rest on files that the description does not name, so that no answer can be kept.
    """
    if "<mesh" not in urdf:
        return ""
    names = sorted({mesh.get("filename", "") for mesh in _collision_meshes(ElementTree.fromstring(urdf))})
    contents = [_content(name) for name in names]
    return None if None in contents else "\n".join(filter(None, contents))


def _content(name: str) -> str | None:
    try:
        file = find_mesh(name)
        kept = file.suffix.lower() in SELF_CONTAINED
        return f"{name}\n{file}\n{_sha256(file)}" if kept else None
    except (MeshError, OSError) as error:
        return f"{name}\n{error}"


def _collision_meshes(root: ElementTree.Element) -> Iterator[ElementTree.Element]:
    for collision in root.iter("collision"):
        yield from collision.iter("mesh")


def _sha256(file: Path) -> str:
    digest = hashlib.sha256()
    with file.open("rb") as stream:
        while piece := stream.read(_PIECE):
            digest.update(piece)
    return digest.hexdigest()
