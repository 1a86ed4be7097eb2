"""The emitted description has the forward kinematics of the published Denavit-Hartenberg parameters.

Neither side is our code: the parameters come from the table of facts, and the description is read by ElementTree and
multiplied out here.
"""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
import pytest

from tests.cells import ROOT, there

Matrix = npt.NDArray[np.float64]

FACTS = ROOT.parent / "shared/facts/robots.md"
# Universal Robots, "DH Parameters for calculations of kinematics and dynamics", UR5e, in m.
TYPED = {"d1": 0.1625, "a2": -0.425, "a3": -0.3922, "d4": 0.1333, "d5": 0.0997, "d6": 0.0996}
ALPHA = (np.pi / 2, 0.0, 0.0, np.pi / 2, -np.pi / 2, 0.0)
JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")


def _published() -> dict[str, float]:
    if not FACTS.exists():
        return TYPED
    text = FACTS.read_text(encoding="utf-8").replace("−", "-")
    names = there(re.search(r"^\| type \|(.+)\|$", text, re.MULTILINE))
    values = there(re.search(r"^\| ur5e \|(( -?[\d.]+ \|){6})$", text, re.MULTILINE))
    columns = [name.strip() for name in names[1].split("|")]
    return dict(zip(columns, map(float, values[1].strip(" |").split("|")), strict=True))


def _published_pose(angles: Matrix) -> Matrix:
    """Return the transform of the tool in the robot's base by the classic convention: Rz(θ) Tz(d) Tx(a) Rx(α)."""
    of = _published()
    d = (of["d1"], 0.0, 0.0, of["d4"], of["d5"], of["d6"])
    a = (0.0, of["a2"], of["a3"], 0.0, 0.0, 0.0)
    pose = np.eye(4)
    for at, angle in enumerate(angles):
        pose = pose @ _turn("z", angle) @ _shift(0.0, 0.0, d[at]) @ _shift(a[at], 0.0, 0.0) @ _turn("x", ALPHA[at])
    return pose


class _Chain:
    """The joints of a URDF from each link to its parent."""

    def __init__(self, urdf: Path) -> None:
        joints = ElementTree.parse(urdf).getroot().findall("joint")
        self._above = {_link(joint, "child"): joint for joint in joints}

    def pose(self, link: str, angles: dict[str, float]) -> Matrix:
        pose = np.eye(4)
        while (joint := self._above.get(link)) is not None:
            origin = joint.find("origin")
            xyz = _numbers(origin, "xyz")
            roll, pitch, yaw = _numbers(origin, "rpy")
            here = _shift(*xyz) @ _turn("z", yaw) @ _turn("y", pitch) @ _turn("x", roll)
            if joint.get("type") != "fixed" and joint.get("name") in angles:
                assert _numbers(joint.find("axis"), "xyz") == (0.0, 0.0, 1.0)
                here = here @ _turn("z", angles[str(joint.get("name"))])
            pose = here @ pose
            link = _link(joint, "parent")
        return pose


@pytest.mark.parametrize("target", ["mock", "real"])
def test_emitted_description_has_the_published_forward_kinematics(target: str, pick: Path) -> None:
    chain = _Chain(pick / f"urdf/ur5e_pick.{target}.urdf")
    for angles in np.random.default_rng(20260701).uniform(-2 * np.pi, 2 * np.pi, (100, 6)):
        named = {f"arm_{joint}_joint": float(angle) for joint, angle in zip(JOINTS, angles, strict=True)}
        # The DH base is the frame `base`, which REP-199 keeps apart from `base_link`.
        ours = np.linalg.inv(chain.pose("arm_base", named)) @ chain.pose("arm_tool0", named)
        published = _published_pose(angles)
        assert np.abs(ours[:3, 3] - published[:3, 3]).max() < 1e-6
        assert np.abs(ours[:3, :3] - published[:3, :3]).max() < 1e-6


def test_table_of_facts_agrees_with_the_vendors_page() -> None:
    assert _published() == TYPED


def _link(joint: ElementTree.Element, end: str) -> str:
    found = there(joint.find(end))
    return str(found.get("link"))


def _numbers(element: ElementTree.Element | None, name: str) -> tuple[float, float, float]:
    text = "0 0 0" if element is None else element.get(name, "0 0 0")
    x, y, z = map(float, text.split())
    return x, y, z


def _shift(x: float, y: float, z: float) -> Matrix:
    pose = np.eye(4)
    pose[:3, 3] = (x, y, z)
    return pose


def _turn(axis: str, angle: float) -> Matrix:
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    pose = np.eye(4)
    pose[first, first] = pose[second, second] = np.cos(angle)
    pose[first, second], pose[second, first] = -np.sin(angle), np.sin(angle)
    return pose
