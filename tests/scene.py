"""The scene of a package in MuJoCo, for tests that load it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np
import pinocchio

from cellc.compiler.feasibility.question import shapes_and_joints
from cellc.robot.planning import RobotModel
from tests.cells import built

SCENE = "sim/scene.xml"
FREE = 0
"""Type of a free joint."""


@cache
def text_of(cell: str) -> str:
    """Return the scene of a cell of the repository."""
    return built(cell).texts[SCENE]


def loaded(text: str) -> Any:
    """Return the model of a scene, of whose meshes each is a tetrahedron."""
    meshes = (mesh.attrib["file"] for mesh in ElementTree.fromstring(text).findall("asset/mesh"))
    return mujoco.MjModel.from_xml_string(text, {name: _tetrahedron() for name in meshes})


def _tetrahedron() -> bytes:
    """Return one of 10 cm as binary STL, as MuJoCo reads it."""
    corners = 0.1 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.zeros(4, dtype=[("floats", "<f4", 12), ("attribute", "<u2")])
    faces["floats"][:, 3:] = corners[[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]].reshape(4, 9)
    return bytes(80) + len(faces).to_bytes(4, "little") + faces.tobytes()


class Described:
    """The description of a cell in pinocchio: what a scene must agree with."""

    def __init__(self, cell: str) -> None:
        """Read it."""
        self.robot = RobotModel.from_urdf(shapes_and_joints(built(cell).graph))

    def drawn(self, generator: np.random.Generator) -> dict[str, float]:
        """Return a position within its limits for each joint that follows no other."""
        model = self.robot.kinematics
        positions = {}
        for joint in self.robot.joints:
            index = self.robot.joint_of(joint)
            at = model.idx_qs[index]
            turns = model.nqs[index] == 2
            bounds = (-np.pi, np.pi) if turns else (model.lowerPositionLimit[at], model.upperPositionLimit[at])
            positions[joint] = float(generator.uniform(*bounds))
        return positions

    def poses(self, positions: Mapping[str, float]) -> dict[str, tuple[Any, Any]]:
        """Return where every link is: position and rotation matrix in the world."""
        data = self.robot.kinematics.createData()
        pinocchio.framesForwardKinematics(self.robot.kinematics, data, self.robot.configuration(positions))
        links = ((link, data.oMf[self.robot.frame_of(link)]) for link in self.robot.links)
        return {link: (np.array(pose.translation), np.array(pose.rotation)) for link, pose in links}

    def followers(self, positions: Mapping[str, float]) -> dict[str, float]:
        """Return the positions of all joints, those that follow another too."""
        mimics = {m.joint: m.multiplier * positions[m.leader] + m.offset for m in self.robot.mimics}
        return {**positions, **mimics}


def place(model: Any, data: Any, positions: Mapping[str, float]) -> None:
    """Put joints where they are to be, and compute where everything is."""
    for joint, value in positions.items():
        data.joint(joint).qpos = value
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
