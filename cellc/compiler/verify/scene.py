"""Hold the scene of a simulator against the cell: MuJoCo loads it, and has its frames, limits and masses.

A small body takes the place of each mesh, so that no file is opened.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from pathlib import PurePosixPath
from typing import Any

from cellc.compiler.artifact import Artifact
from cellc.compiler.verify.disagreement import Disagreement
from cellc.compiler.verify.meant import Limits, Meant
from cellc.contract.extras import PHYSICS, gate
from cellc.contract.printing import overheard
from cellc.contract.transforms import Pose, apart, quaternion_of

CODE = "verify-scene"
_TOLERANCE = 1e-8
"""As of descriptions: files write 12 significant digits."""
_LOCKED = 1e-5
"""A joint that may not move has a range nevertheless."""
_CORNERS = ((0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.0, 0.01, 0.0), (0.0, 0.0, 0.01))
_FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def is_read() -> bool:
    """Tell whether the library that reads a scene is installed."""
    return find_spec(PHYSICS.modules[0]) is not None


def check_scene(artifact: Artifact, meant: Meant) -> Iterator[Disagreement]:
    """Yield what in a scene does not fit; nothing where MuJoCo is not installed."""
    if not is_read():
        return
    with gate(PHYSICS):
        import mujoco
    try:
        with overheard():
            model = mujoco.MjModel.from_xml_string(artifact.text, _stand_ins(artifact.text))
    except ValueError as error:
        yield Disagreement(CODE, artifact.path, f"MuJoCo refuses it: {' '.join(str(error).split())}")
        return
    if model.nsite == 0:
        return  # what is too deep for parsers is left out
    data = mujoco.MjData(model)
    data.qpos[_joints_of(model)] = 0.0
    mujoco.mj_kinematics(model, data)
    for reason in (*_frame_reasons(model, data, meant.frames), *_limit_reasons(model, meant.joints)):
        yield Disagreement(CODE, artifact.path, reason)


def _stand_ins(text: str) -> dict[str, bytes]:
    """Return a small body for each mesh that a scene names."""
    names = (mesh.get("file", "") for mesh in ElementTree.fromstring(text).findall("asset/mesh"))
    return {name: _body(PurePosixPath(name).suffix.lower()) for name in names}


def _body(suffix: str) -> bytes:
    if suffix == ".obj":
        lines = [f"v {x} {y} {z}" for x, y, z in _CORNERS]
        lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in _FACES]
        return "\n".join(lines).encode()
    import numpy as np

    faces = np.zeros(len(_FACES), dtype=[("floats", "<f4", 12), ("attribute", "<u2")])
    faces["floats"][:, 3:] = [[value for corner in face for value in _CORNERS[corner]] for face in _FACES]
    return bytes(80) + len(_FACES).to_bytes(4, "little") + faces.tobytes()


def _joints_of(model: Any) -> list[int]:
    """Return the places of the positions of joints; those of free bodies are their poses."""
    return [int(at) for at, kind in zip(model.jnt_qposadr, model.jnt_type, strict=True) if kind in (2, 3)]


def _frame_reasons(model: Any, data: Any, frames: Mapping[str, Pose]) -> Iterator[str]:
    import numpy as np

    sites = {model.site(index).name: index for index in range(model.nsite)}
    for name in sorted(set(frames) - set(sites) - {"world"}):
        yield f"frame `{name}` of the cell is no site"
    for name in sorted(set(frames) & set(sites)):
        matrix = np.asarray(data.site_xmat[sites[name]]).reshape(3, 3)
        meters, radians = apart(frames[name], _pose(data.site_xpos[sites[name]], matrix))
        if max(meters, radians) > _TOLERANCE:
            yield f"frame `{name}` lies {meters:.6g} m and {radians:.6g} rad apart for the cell and MuJoCo"


def _pose(position: Any, matrix: Any) -> Pose:
    x, y, z = (float(value) for value in position)
    return Pose((x, y, z), quaternion_of([[float(value) for value in row] for row in matrix]))


def _limit_reasons(model: Any, stated: Mapping[str, Limits]) -> Iterator[str]:
    names = {model.joint(index).name: index for index in range(model.njnt) if model.jnt_type[index] in (2, 3)}
    for name in sorted(set(stated) ^ set(names)):
        yield f"joint `{name}` is not in both, the cell and the scene"
    for name in sorted(set(stated) & set(names)):
        index, limits = names[name], stated[name]
        lower, upper = (float(value) for value in model.jnt_range[index])
        if model.jnt_limited[index] and not (_are_near(lower, limits.lower) and _are_near(upper, limits.upper)):
            ours = f"{limits.lower} to {limits.upper}"
            yield f"joint `{name}` moves from {lower} to {upper} for MuJoCo, from {ours} in the cell"
        effort = float(model.jnt_actfrcrange[index][1]) if model.jnt_actfrclimited[index] else None
        if (effort or None) != (limits.effort or None):
            yield f"joint `{name}` gives {effort} for MuJoCo and {limits.effort} in the cell"


def _are_near(read: float, stated: float | None) -> bool:
    return stated is not None and math.isclose(read, stated, abs_tol=_LOCKED)
