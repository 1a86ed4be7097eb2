"""The description that a user names: a file, the folder of a ROS package, or an installed Python package."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from cellc.contract.diagnostics import Outcome
from cellc.contract.errors import CellcError
from cellc.contract.limits import limits
from cellc.contract.store.regular_file import read_regular
from cellc.robot.description.meshes import MeshError
from cellc.robot.description.model import Description, Mesh
from cellc.robot.description.packages import MANIFEST, declared_name, folders_elsewhere, root_of
from cellc.robot.description.read_description import text_under
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.xacro_expansion import expand_xacro
from cellc.robot.description.xml_tree import read_xml, with_values
from cellc.tools.importing.gaps import assumed_limits, with_limits
from cellc.tools.importing.merge import Facts
from cellc.tools.importing.meshes import PACKAGE, located, package_of

_SUFFIXES = (".urdf", ".urdf.xacro", ".xacro")
_LONGEST_LICENSE = 100


class ImportRefusedError(CellcError):
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
        assumed: the limits in ``description`` that the text leaves out.
    """

    file: Path
    text: str
    description: Description
    meshes: Mapping[str, Path]
    missing: tuple[str, ...]
    license: str
    assumed: Facts


def the_description(named: str) -> Path:
    """Return the one description that a file, a folder or an installed package holds.

    Raises:
        ImportRefusedError: it holds no description, or several.
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
    files = descriptions_in(place)
    if not files:
        raise ImportRefusedError(f"`{named}` holds no URDF or xacro file")
    return files


def descriptions_in(folder: Path) -> tuple[Path, ...]:
    """Return the files below a folder that are descriptions by their names, without parts where there are others."""
    files = sorted(file for file in folder.rglob("*") if file.name.endswith(_SUFFIXES) and file.is_file())
    tops = [file for file in files if not re.search(r"macro|inc|materials|gazebo|transmission", file.name)]
    return tuple(tops or files)


def read_robot(file: Path, arguments: Mapping[str, str]) -> Outcome[Robot]:
    """Read a description with the packages that lie beside it or above it.

    Raises:
        ImportRefusedError: its links are no tree, have names that ROS does not take, or name meshes that may not be
            copied.
    """
    root = root_of(file)
    expanded = _text(file, arguments, root)
    if expanded.value is None:
        return Outcome(None, expanded.diagnostics)
    read = read_urdf(expanded.value, file.as_posix(), from_user=True)
    if read.value is None:
        return Outcome(None, read.diagnostics)
    text = with_values(expanded.value, "mesh", "filename", lambda name: _packaged(name, file))
    read = read_urdf(text, file.as_posix(), from_user=True)
    if read.value is None:
        return Outcome(None, read.diagnostics)
    _refuse(read.value)
    meshes = tuple(mesh for link in read.value.links for mesh in link.collision_meshes())
    try:
        files = located(meshes, file, root)
    except MeshError as fault:
        raise ImportRefusedError(f"{fault}; {fault.help_text}") from None
    missing = tuple(name for name in dict.fromkeys(mesh.filename for mesh in meshes) if name not in files)
    assumed = assumed_limits(read.value)
    robot = with_limits(read.value, assumed)
    return Outcome(Robot(file, text, robot, files, missing, _license(file), assumed))


def _text(file: Path, arguments: Mapping[str, str], root: Path) -> Outcome[str]:
    """Return the text of a URDF; one that is xacro by its name or by its elements is expanded."""
    read = text_under(file, root) if file.suffix != ".xacro" else None
    if read is not None and "<xacro:" not in (read.value or ""):
        return read
    expanded = expand_xacro(file, arguments, root)
    return Outcome(None if expanded.value is None else expanded.value.text, expanded.diagnostics)


def _packaged(name: str, file: Path) -> str:
    """Name a mesh by a package: one beside the description becomes one of a package of the description's own."""
    scheme, separator, path = name.partition("://")
    if separator and scheme != "file":
        # `package:///PKG/…` is in vendors' files, and their loaders take it; so do `//` and `..` within a package.
        return PACKAGE + posixpath.normpath(path.lstrip("/")) if scheme in ("package", "model") else name
    here = Path(os.path.normpath(file.absolute().parent))
    absolute = Path(os.path.normpath(here / (path if separator else name)))
    for above in absolute.parents:
        if (above / MANIFEST).is_file():
            package = declared_name((above / MANIFEST).as_posix()) or above.name
            return f"{PACKAGE}{package}/{absolute.relative_to(above).as_posix()}"
    below = absolute.relative_to(here if here in absolute.parents else absolute.parent)
    return f"{PACKAGE}meshes/{below.as_posix().removeprefix('meshes/')}"


def packages_elsewhere(robot: Robot, folder: Path) -> tuple[str, ...]:
    """Return where the packages lie that a description names and its device folder does not hold, for `packages:`."""
    links = robot.description.links
    shapes = [shape.geometry for link in links for shape in link.visuals]
    shapes += [shape.geometry for link in links for shape in link.collisions]
    named = {shape.filename for shape in shapes if isinstance(shape, Mesh)}
    packages = (name for name in map(package_of, named) if name and not (folder / name).is_dir())
    return folders_elsewhere(packages, folder.parent.as_posix(), (root_of(robot.file).as_posix(),))


def _license(file: Path) -> str:
    """Return the first license that the manifest of a description's package names; empty without one."""
    manifest = next((above / MANIFEST for above in file.parents if (above / MANIFEST).is_file()), None)
    if manifest is None:
        return ""
    try:
        text = read_regular(manifest, limits().xml_bytes).decode("utf-8", "replace")
    except OSError:
        return ""
    package = read_xml(text, manifest.as_posix()).value
    tag = None if package is None else package.first("license")
    return "" if tag is None else " ".join(tag.text.split())[:_LONGEST_LICENSE]


def _refuse(description: Description) -> None:
    roots = description.roots()
    if len(roots) != 1:
        raise ImportRefusedError(f"the links must have one root, got {', '.join(roots) or 'none'}")
    named = [
        *(("link", link.name) for link in description.links),
        *(("joint", joint.name) for joint in description.joints),
    ]
    for kind, name in named:
        if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_./-]*", name) is None:
            rule = "names of links and joints must begin with a letter and hold letters, digits and `_./-`"
            allowed = re.sub(r"[^A-Za-z0-9_./-]", "_", name)
            better = allowed if re.match(r"[A-Za-z_]", allowed) else f"{kind}_{allowed}"
            raise ImportRefusedError(f"{rule}, got `{name}`; rename it in the description, to `{better}` for one")
