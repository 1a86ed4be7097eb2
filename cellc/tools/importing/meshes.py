"""The mesh files that an imported description names: where they lie, and where they stand in the device folder."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from cellc.compiler.output.plan import unusable
from cellc.contract.limits import MIB, limits
from cellc.robot.description.meshes import MALFORMED_MESH, MESH_TOO_LARGE, MeshError, MeshFile, identify, too_large
from cellc.robot.description.model import Mesh
from cellc.robot.description.packages import is_package_name, lies_under, package_folders

PACKAGE = "package://"


def package_of(name: str) -> str:
    """Return the package of a mesh that is named by one; empty where it is not."""
    package = name.removeprefix(PACKAGE).partition("/")[0] if name.startswith(PACKAGE) else ""
    return package if is_package_name(package) else ""


def path_in_folder(name: str) -> str:
    """Return where a mesh is in the device folder."""
    return name.removeprefix(PACKAGE)


def located(meshes: Iterable[Mesh], file: Path, root: Path) -> Mapping[str, Path]:
    """Return the file of each mesh, by its name; those that are not there are left out.

    Args:
        file: the description.
        root: the folder in which it and its packages lie.

    Raises:
        MeshError: a file is too large, is not a mesh, or has a name that no folder can hold.
    """
    located, together, most = dict[str, Path](), 0, limits().mesh_bytes_together
    for number, name in enumerate(dict.fromkeys(mesh.filename for mesh in meshes)):
        if number == limits().mesh_shapes:
            raise too_large(f"must be one of at most {number} meshes, got more", "mesh-shapes").about(name)
        mesh = _file_of(name, file, root) if package_of(name) else None
        if mesh is None:
            continue
        if (reason := unusable(path_in_folder(name))) != "":
            raise MeshError(MALFORMED_MESH, f"cannot be copied: its path {reason}", "rename the file").about(name)
        together += mesh.size
        if together > most:
            message = f"must have at most {most / MIB:g} MiB with the meshes before it, got more"
            raise too_large(message, "mesh-bytes-together").about(name)
        located[name] = Path(mesh.path)
    return located


def _file_of(name: str, file: Path, root: Path) -> MeshFile | None:
    """Return the file of a mesh: on the package path, in its package, or in a folder around the description.

    What is copied becomes public with the device folder. A link on the package path leads where the user lets it; one
    of a package must stay in that package; elsewhere no link is followed.
    """
    package, _, rest = path_in_folder(name).partition("/")
    if (mesh := _identified(name, ())) is not None or not rest:
        return mesh
    below = (Path(folder) for folder in package_folders(package, root.as_posix()))
    packages = [folder for folder in below if lies_under(folder.as_posix(), root.as_posix())]
    here = file.absolute().parent
    around = [folder for folder in file.resolve().parents if folder.name == package]
    around += [here, here.parent, here / "meshes"]
    places = [folder for folder in packages if lies_under((folder / rest).as_posix(), folder.as_posix())]
    places += [folder for folder in around if (folder / rest).resolve() == folder.resolve() / rest]
    files = (_identified(f"file://{folder.absolute() / rest}", (folder,)) for folder in places)
    return next((mesh for mesh in files if mesh is not None), None)


def _identified(name: str, roots: Sequence[Path]) -> MeshFile | None:
    try:
        return identify(name, roots)
    except MeshError as error:
        if error.code in (MESH_TOO_LARGE, MALFORMED_MESH):
            raise
        return None
