"""Where the mesh files of a robot description lie, which of them may be read, and how much of them.

A name leads to a regular file in the folder of the spec, in those of its `packages:`, or on the package path, and
nowhere else. What is in the file is read by a child process (`mesh_numbers`); here its bytes are counted and hashed.
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass
from cellc.contract.limits import MIB, limits, option
from cellc.contract.store.regular_file import open_regular
from cellc.contract.transforms import Vector3
from cellc.robot.description.model import Mesh
from cellc.robot.description.packages import lies_under, package_folders, package_path, repository_of

FORMATS = (".stl", ".dae", ".obj", ".ply", ".off", ".glb")
"""Formats whose shape is in the one file."""
MAX_COORDINATE_M = 1e6
"""Beyond it the arithmetic of collision checks has no millimeters left."""

MESH_NOT_FOUND = "mesh-not-found"
MESH_OUTSIDE_ROOT = "mesh-outside-root"
MESH_TOO_LARGE = "mesh-too-large"
MALFORMED_MESH = "malformed-mesh"

_PIECE = 1 << 20
_OF_THE_SYSTEM = ("/proc", "/sys", "/dev")
_SHELVES = "`--package-path`"
_SHOWN = 200


class MeshError(CellcError):
    """A mesh cannot be used; ``code`` is that of a rule, and the text says why.

    Attributes:
        certain: whether it follows from the file alone, and not from others or from what the machine had left.
    """

    def __init__(self, code: str, message: str, help_text: str = "", certain: bool = True) -> None:
        super().__init__(message)
        self.code, self.message, self.help_text, self.certain = code, message, help_text, certain

    def about(self, name: str) -> MeshError:
        """Return the same about the mesh that a description names."""
        return MeshError(self.code, f"mesh `{name[:_SHOWN]}` {self.message}", self.help_text, self.certain)


def too_large(message: str, limit: str, certain: bool = True) -> MeshError:
    """Return what is said of a mesh beyond a row of the limits."""
    advice = f"name a coarser mesh in `<collision>`, and leave the fine one to `<visual>`; {option(limit)}"
    return MeshError(MESH_TOO_LARGE, message, advice, certain)


@dataclass(frozen=True, slots=True)
class MeshFile:
    """A mesh file with the hash of its content and its size in bytes."""

    path: str
    suffix: str
    digest: str
    size: int


@dataclass(frozen=True, slots=True)
class MeshFacts:
    """What is known of a mesh file once it was read.

    Attributes:
        triangles: their number.
        reach: largest distance from the origin along each axis, in the unit of the file.
        fault: code, message and help where it cannot be used.
        certain: whether this follows from the file alone; see `MeshError`.
    """

    triangles: int = 0
    reach: Vector3 = (0.0, 0.0, 0.0)
    fault: tuple[str, str, str] | None = None
    certain: bool = True


def identify_all(meshes: Iterable[Mesh], roots: Sequence[Path]) -> dict[str, MeshFile | MeshError]:
    """Return the file of each mesh, or why it is missing, by the name that the description gives it; see `identify`."""
    files: dict[str, MeshFile | MeshError] = {}
    together, most = 0, limits().mesh_bytes_together
    for name in dict.fromkeys(mesh.filename for mesh in meshes):
        try:
            files[name] = file = identify(name, roots)
            together += file.size
            if together > most:
                message = f"must have at most {most / MIB:g} MiB with the meshes before it, got more"
                raise too_large(message, "mesh-bytes-together").about(name)
        except MeshError as error:
            files[name] = error
        if len(files) > limits().mesh_shapes or together > most:
            break
    return files


def absent(meshes: Iterable[Mesh], roots: Sequence[Path]) -> frozenset[str]:
    """Return the names of the meshes that are not there; what is wrong with others is not asked."""
    files = identify_all(meshes, roots)
    return frozenset(
        name for name, file in files.items() if isinstance(file, MeshError) and file.code == MESH_NOT_FOUND
    )


def without_shapes(urdf: str, names: Container[str]) -> str:
    """Return a description without the collision shapes that are of some meshes: such a link touches nothing there."""
    root = ElementTree.fromstring(urdf)
    for link in root.iter("link"):
        for collision in link.findall("collision"):
            if any(mesh.get("filename", "") in names for mesh in collision.iter("mesh")):
                link.remove(collision)
    return ElementTree.tostring(root, encoding="unicode")


def with_links(urdf: str, parts: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield parts of a description: each has some links, the joints to them, and all materials."""
    root = ElementTree.fromstring(urdf)
    shared = [element for element in root if element.tag not in ("link", "joint", "ros2_control")]
    links = {link.get("name", ""): link for link in root.findall("link")}
    joints = {child.get("link", ""): joint for joint in root.findall("joint") for child in joint.findall("child")}
    for names in parts:
        part = ElementTree.Element(root.tag, root.attrib)
        part.extend([*shared, *(links[name] for name in names), *(joints[name] for name in names if name in joints)])
        yield ElementTree.tostring(part, encoding="unicode")


def without_meshes(urdf: str) -> str:
    """Return a description with a ball in the place of each mesh that is checked for collisions."""
    if "<mesh" not in urdf:
        return urdf
    root = ElementTree.fromstring(urdf)
    for collision in root.iter("collision"):
        for geometry in collision.iter("geometry"):
            if geometry.find("mesh") is not None:
                geometry[:] = [ElementTree.Element("sphere", {"radius": "1"})]
    return ElementTree.tostring(root, encoding="unicode")


def readable(files: Mapping[str, MeshFile | MeshError]) -> tuple[MeshFile, ...]:
    """Return the files that exist, each once, in a fixed order."""
    usable = {file for file in files.values() if isinstance(file, MeshFile)}
    return tuple(sorted(usable, key=lambda file: (file.digest, file.path)))


def unusable(
    meshes: Sequence[Mesh], files: Mapping[str, MeshFile | MeshError], facts: Mapping[MeshFile, MeshFacts]
) -> Iterator[tuple[Mesh, MeshError]]:
    """Yield the first shape of each file and scale that cannot be used.

    Args:
        files: of ``identify_all``.
        facts: what is in each file, as far as it is known: what is not known is no fault.
    """
    if len(meshes) > (most := limits().mesh_shapes):
        message = f"must be one of at most {most} mesh shapes, got {len(meshes)}"
        yield meshes[most], too_large(message, "mesh-shapes").about(meshes[most].filename)
    together = 0
    for mesh in dict.fromkeys(meshes):
        file = files.get(mesh.filename)
        if isinstance(file, MeshError):
            yield mesh, file
        elif file is not None and file in facts:
            together += facts[file].triangles
            try:
                _judge(mesh, facts[file], together)
            except MeshError as fault:
                yield mesh, fault.about(mesh.filename)


def _judge(mesh: Mesh, facts: MeshFacts, together: int) -> None:
    if facts.fault is not None:
        raise MeshError(*facts.fault)
    if together > limits().mesh_triangles_together:
        most = limits().mesh_triangles_together
        message = f"must have at most {most} triangles with the meshes before it, got {together}"
        raise too_large(message, "mesh-triangles-together")
    if 0.0 in mesh.scale:
        raise MeshError(MALFORMED_MESH, "must have a `scale` without 0", "write how many m a unit of the file is")
    reach = max(abs(factor) * length for factor, length in zip(mesh.scale, facts.reach, strict=True))
    if reach > MAX_COORDINATE_M:
        message = f"must lie within {MAX_COORDINATE_M:g} m of its origin, got {reach:g} m"
        raise MeshError(MALFORMED_MESH, message, "write in `scale` how many m a unit of the file is")


def identify(name: str, roots: Sequence[Path], shelves: Sequence[Path] | None = None) -> MeshFile:
    """Find the file of a mesh that a description names, and hash its content.

    ``package://``, ``model://`` and relative names are looked up in the folders of the package path, which the user
    chose and where links to a workspace are usual; then as packages in the folders of specs, out of which no link may
    lead. An absolute name must lie in one of these folders.

    Args:
        roots: folders of the specs that bring the descriptions; none where only packages count.
        shelves: folders of packages; those of the package path if None.

    Raises:
        MeshError: there is no such file, or it may not be read, or it is too large.
    """
    try:
        chosen = tuple(map(Path, package_path())) if shelves is None else tuple(shelves)
        file, suffix = _find(name, roots, chosen), Path(name).suffix.lower()
        if suffix not in FORMATS:
            message = f"must be a file of {', '.join(FORMATS)}, got `{suffix[:20]}`"
            raise MeshError(MALFORMED_MESH, message, "export the shape as STL")
        digest, size = hashlib.sha256(), 0
        for piece in read_pieces(file):
            digest.update(piece)
            size += len(piece)
    except OSError as error:
        raise MeshError(MESH_NOT_FOUND, f"mesh `{name[:_SHOWN]}` cannot be read: {error.strerror}") from None
    except MeshError as error:
        raise error.about(name) from None
    return MeshFile(file.as_posix(), suffix, digest.hexdigest(), size)


def _find(name: str, roots: Sequence[Path], shelves: Sequence[Path]) -> Path:
    scheme, separator, path = name.partition("://")
    if not separator:
        scheme, path = "file" if os.path.isabs(name) else "package", name
    if scheme not in ("file", "package", "model"):
        message = f"has the scheme `{scheme[:20]}`, expected `package` or `file`"
        raise MeshError(MESH_NOT_FOUND, message, "write `package://PACKAGE/FILE`")
    parts = [part for part in path.split("/") if part]
    if ".." in parts:
        raise MeshError(MESH_OUTSIDE_ROOT, "must not leave its folder with `..`", "name the file without `..`")
    if scheme == "file":
        return _regular(_absolute(Path(path), roots, shelves))
    on_shelves = (folder.joinpath(*parts[1:]) for _, folder in _packages(parts, shelves))
    for file in (*(shelf.joinpath(*parts) for shelf in shelves), *on_shelves):
        if os.path.lexists(file):
            return _regular(Path(os.path.realpath(file)))
    for root, folder in _packages(parts, roots):
        if os.path.lexists(file := folder.joinpath(*parts[1:])):
            return _regular(_within(file, root))
    places = (
        f"the folder of the spec, in its `packages:` or in those of {_SHELVES}" if roots else f"folders of {_SHELVES}"
    )
    raise MeshError(MESH_NOT_FOUND, f"could not be found in {places}")


def _packages(parts: Sequence[str], roots: Iterable[Path]) -> Iterator[tuple[Path, Path]]:
    """Yield each root with each folder below it that may be the package."""
    for root in roots if parts else ():
        yield from ((root, Path(folder)) for folder in package_folders(parts[0], root.as_posix()))


def _absolute(file: Path, roots: Sequence[Path], shelves: Sequence[Path]) -> Path:
    if not file.is_absolute():
        message = "must have an absolute path behind `file://`"
        raise MeshError(MESH_OUTSIDE_ROOT, message, "write `package://PACKAGE/FILE`")
    real = os.path.realpath(file)
    chosen = any(file.is_relative_to(os.path.abspath(shelf)) for shelf in shelves)  # links of such packages are usual
    if chosen or any(lies_under(real, root.as_posix()) for root in (*roots, *shelves)):
        return Path(real)
    message = f"must lie in the folder of the spec or in one of {_SHELVES}"
    raise MeshError(MESH_OUTSIDE_ROOT, message, "put the file in a package beside the spec, and name it `package://…`")


def _within(file: Path, root: Path) -> Path:
    # Links are followed once: one that changes after this look is not followed again.
    real = os.path.realpath(file)
    if not lies_under(real, repository_of(root.as_posix())):
        message = "must lie in the folder of the spec, and is a link that leads out of it"
        raise MeshError(MESH_OUTSIDE_ROOT, message, "put a copy of the file in its place")
    return Path(real)


def _regular(real: Path) -> Path:
    """Return the real path of a regular file outside the folders of the operating system; None for anything else."""
    if any(real.is_relative_to(folder) for folder in _OF_THE_SYSTEM):
        raise MeshError(MESH_OUTSIDE_ROOT, "must not be a file of the operating system", "name a mesh file")
    mode = os.lstat(real).st_mode
    if not stat.S_ISREG(mode):
        got = "a folder" if stat.S_ISDIR(mode) else "something else"
        raise MeshError(MESH_NOT_FOUND, f"must be a regular file, got {got}", "name a mesh file")
    return real


def read_pieces(file: Path) -> Iterator[bytes]:
    """Yield the bytes of a regular file, as many as may be read; whatever takes its place meanwhile, nothing waits.

    Raises:
        OSError: it cannot be read, or it is a link or something else by now.
        MeshError: it is too large.
    """
    with open_regular(file, follow=False) as stream:
        room = limits().mesh_bytes
        while piece := stream.read(_PIECE):
            room -= len(piece)
            if room < 0:
                message = f"must have at most {limits().mesh_bytes / MIB:g} MiB, got more"
                raise too_large(message, "mesh-bytes")
            yield piece
