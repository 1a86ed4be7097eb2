"""The description that a user names: a file, the folder of a ROS package, or an installed Python package."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from cellc.description.meshes import MeshError, identify
from cellc.description.model import Description
from cellc.description.packages import MANIFEST, declared_name, folders_elsewhere, root_of
from cellc.description.urdf_reader import read_urdf
from cellc.description.xacro_expansion import expand_xacro
from cellc.diagnostics import Outcome, Span
from cellc.source.text import read_text

_SUFFIXES = (".urdf", ".urdf.xacro", ".xacro")
_FILENAME = re.compile(r"""(<mesh\b[^>]*?\bfilename\s*=\s*)(["'])(.*?)\2""", re.DOTALL)
_PACKAGE = "package://"


class ImportRefusedError(Exception):
    """Nothing can be imported, for one reason that the text says."""


@dataclass(frozen=True, slots=True)
class Robot:
    """A description that was read.

    Attributes:
        file: where it was read from.
        text: URDF, expanded, every mesh named by its package.
        meshes: the file of each mesh of a collision shape, by the name in ``text``; those that are there.
        missing: names of meshes that are not.
        license: as ``package.xml`` says, or empty.
    """

    file: Path
    text: str
    description: Description
    meshes: Mapping[str, Path]
    missing: tuple[str, ...]
    license: str


def the_description(named: str) -> Path:
    """Return the one description that a file, a folder or an installed package holds.

    Raises:
        ImportRefusedError: there is none, or there are several.
    """
    files = _candidates(named)
    if len(files) > 1:
        shown = ", ".join(file.as_posix() for file in files[:12])
        raise ImportRefusedError(f"`{named}` holds {len(files)} descriptions, name one: {shown}")
    return files[0]


def _candidates(named: str) -> tuple[Path, ...]:
    place = Path(named)
    if not place.exists() and re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", named):
        installed = find_spec(named)
        folders = [] if installed is None else list(installed.submodule_search_locations or ())
        place = Path(folders[0]) if folders else place
    if place.is_file():
        return (place,)
    if not place.is_dir():
        raise ImportRefusedError(f"`{named}` is not a file, a folder or an installed package")
    found = sorted(file for file in place.rglob("*") if file.name.endswith(_SUFFIXES) and file.is_file())
    tops = [file for file in found if not re.search(r"macro|inc|materials|gazebo|transmission", file.name)]
    if not found:
        raise ImportRefusedError(f"`{named}` holds no URDF or xacro file")
    return tuple(tops or found)


def read_robot(file: Path, arguments: Mapping[str, str]) -> Outcome[Robot]:
    """Read a description with the packages that lie beside it or above it.

    Raises:
        ImportRefusedError: its links are no tree, or have names that ROS does not take.
    """
    root = root_of(file)
    expanded = _text(file, arguments, root)
    if expanded.value is None:
        return Outcome(None, expanded.diagnostics)
    text = _FILENAME.sub(lambda match: f"{match[1]}{match[2]}{_packaged(match[3], file)}{match[2]}", expanded.value)
    read = read_urdf(text, file.as_posix(), from_user=True)
    if read.value is None:
        return Outcome(None, read.diagnostics)
    _refuse(read.value)
    found, missing = dict[str, Path](), list[str]()
    for name in _collision_meshes(read.value):
        path = _located(name, file, root)
        if path is None:
            missing.append(name)
        else:
            found[name] = path
    return Outcome(Robot(file, text, read.value, found, tuple(missing), _license(file)))


def _text(file: Path, arguments: Mapping[str, str], root: Path) -> Outcome[str]:
    if file.suffix == ".xacro":
        expanded = expand_xacro(file, arguments, root)
        return Outcome(None if expanded.value is None else expanded.value.text, expanded.diagnostics)
    return read_text(file, file.as_posix(), Span(file.as_posix(), 1, 1, 1, 1))


def _packaged(name: str, file: Path) -> str:
    """Name a mesh by a package: one beside the description becomes one of a package of the description's own."""
    scheme, separator, path = name.partition("://")
    if separator and scheme == "package":
        return _PACKAGE + path.lstrip("/")  # `package:///PKG/…` stands in vendors' files, and their loaders take it
    absolute = Path(path) if scheme == "file" and separator else file.parent / name
    for above in absolute.parents:
        if (above / MANIFEST).is_file():
            package = declared_name((above / MANIFEST).as_posix()) or above.name
            return f"{_PACKAGE}{package}/{absolute.relative_to(above).as_posix()}"
    inside = Path(os.path.normpath(absolute)).name
    return f"{_PACKAGE}meshes/{inside}" if not separator or scheme == "file" else name


def _collision_meshes(description: Description) -> Iterator[str]:
    yield from dict.fromkeys(mesh.filename for link in description.links for mesh in link.collision_meshes())


def _located(name: str, file: Path, root: Path) -> Path | None:
    package, _, rest = name.removeprefix(_PACKAGE).partition("/")
    if ".." in rest.split("/"):
        return None
    above = [folder.parent for folder in file.resolve().parents if folder.name == package]
    found = next((mesh for folder in (*above, root) if (mesh := _identified(name, folder))), None)
    if found is not None:
        return found
    beside = [folder / rest for folder in (file.parent, file.parent.parent, file.parent / "meshes")]
    return next((place for place in beside if rest and place.is_file()), None)


def _identified(name: str, root: Path) -> Path | None:
    try:
        return Path(identify(name, (root,)).path)
    except MeshError:
        return None


def packages_elsewhere(robot: Robot, folder: Path) -> tuple[str, ...]:
    """Return where the packages lie that a description names and its device folder does not hold, for `packages:`."""
    named = re.findall(rf"{_PACKAGE}([^/\"']+)/", robot.text)
    own = (name for name in named if not (folder / name).is_dir())
    return folders_elsewhere(own, folder.parent.as_posix(), (root_of(robot.file).as_posix(),))


def _license(file: Path) -> str:
    manifest = next((above / MANIFEST for above in file.parents if (above / MANIFEST).is_file()), None)
    text = "" if manifest is None else manifest.read_text(encoding="utf-8", errors="replace")
    found = re.search(r"<license[^>]*>\s*([^<]{1,100}?)\s*</license>", text)
    return "" if found is None else found[1]


def _refuse(description: Description) -> None:
    roots = description.roots()
    if len(roots) != 1:
        raise ImportRefusedError(f"the links must have one root, got {', '.join(roots) or 'none'}")
    names = [*(link.name for link in description.links), *(joint.name for joint in description.joints)]
    wrong = next((name for name in names if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_./-]*", name) is None), None)
    if wrong is not None:
        raise ImportRefusedError(f"names of links and joints must be letters, digits and `_./-`, got `{wrong}`")
