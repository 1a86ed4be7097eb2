"""A small cell that the tests of promises spoil: files of a spec and of its device, and private ones beside them."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeAlias

from tests.robustness.fuzz.bases import PARTS, TINY

Content: TypeAlias = "str | bytes | Callable[[Path], object]"
Files: TypeAlias = "Mapping[str, Content]"

SPEC = TINY[1].replace("./parts/stage", "./stage")
_FACTS = (PARTS / "stage/device.yaml").read_text(encoding="utf-8")
_URDF = (PARTS / "stage/stage.urdf").read_text(encoding="utf-8")
_HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="stage">'
SECRET = "the words of a private file"


def new_cell(folder: Path) -> Path:
    """Make a folder with a cell of one axis, and private files beside it."""
    shutil.copytree(PARTS / "stage", folder / "stage")
    (folder / "cell.yaml").write_text(SPEC, encoding="utf-8")
    for name in ("private.xacro", "private.yaml", "private.stl", "private.bin"):
        make(folder.parent, {f"private/{name}": SECRET})
    return folder


def make(folder: Path, files: Files) -> None:
    """Write the files, each with its content or by what makes it."""
    for name, content in files.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        if callable(content):
            place.unlink(missing_ok=True)
            content(place)
        else:
            place.write_bytes(content if isinstance(content, bytes) else content.encode())


def xacro(body: str) -> dict[str, Content]:
    """Return the files of the device with a description in xacro."""
    facts = _FACTS.replace("stage.urdf", "robot.urdf.xacro")
    return {"stage/device.yaml": facts, "stage/robot.urdf.xacro": f"{_HEAD}\n{body}</robot>"}


def shape(geometry: str) -> dict[str, Content]:
    """Return the description of the device with a shape of its arm."""
    found = f"<collision><geometry>{geometry}</geometry></collision>"
    return {"stage/stage.urdf": _URDF.replace('<link name="arm"/>', f'<link name="arm">{found}</link>')}


def mesh(name: str, content: Content | None = None) -> dict[str, Content]:
    """Return the description of the device with a mesh of its arm, and the mesh."""
    named = name if ":" in name or "/" in name else f"package://stage/{name}"
    return shape(f'<mesh filename="{named}"/>') | ({} if content is None else {f"stage/{name}": content})


def sparse(size: int) -> Callable[[Path], object]:
    """Return what makes a file of a size that takes no room on the disk."""

    def make(place: Path) -> None:
        with place.open("wb") as file:
            file.truncate(size)

    return make


_POST = "  post: {parent: world, xyz: 525 0 800 mm, box: 100 100 200 mm}\n"
_BAR = '<origin xyz="0.25 0 0"/><geometry><box size="0.5 0.04 0.04"/></geometry>'
IN_THE_WAY: dict[str, Content] = {
    "cell.yaml": SPEC.replace("scene:\n", f"scene:\n{_POST}"),
    "stage/stage.urdf": _URDF.replace('<link name="arm"/>', f'<link name="arm"><collision>{_BAR}</collision></link>'),
}
