"""The descriptions of the catalog against the vendors' own, expanded: where joints are, and what links weigh."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cellc.compiler.catalog.load import load_device
from cellc.contract.transforms import Pose
from cellc.robot.description.model import Description
from tests.foreign_yaml import safe_load
from tests.oracles import here
from tests.vendors.oracle import VENDORS

_SOURCES = {
    "franka_fr3": ("franka/jazzy-3.4.0", "fr3_hand", ""),
    "franka_hand": ("franka/jazzy-3.4.0", "fr3_hand", ""),
    "robotiq_2f_85": ("kinova/jazzy", "gen3_7dof_2f85", "robotiq_85_"),
    "kinova_gen3_2f_85": ("kinova/jazzy", "gen3_7dof_2f85", ""),
    "openarm_v2_left": ("openarm/v2.0", "openarm_v20_bimanual", ""),
    "openarm_v2_right": ("openarm/v2.0", "openarm_v20_bimanual", ""),
    "kinova_gen3_6dof_2f_85": ("kinova/jazzy", "gen3_6dof_2f85", ""),
}
"""Device → folder, model, and what the vendor puts before the name of the base link. None was read for the others."""

every_device = pytest.mark.parametrize("name", here(_SOURCES if VENDORS.exists() else ()))


def _vendor(name: str) -> dict[str, Any]:
    folder, model, _ = _SOURCES[name]
    told: dict[str, Any] = safe_load((VENDORS / folder / "description.yaml").read_text(encoding="utf-8"))[model]
    return told


def _ours(name: str) -> Description:
    device = load_device(name).value
    assert device is not None
    return device.description


def _rotation(rpy: Any) -> Any:
    roll, pitch, yaw = (float(angle) for angle in rpy)
    cr, sr, cp, sp, cy, sy = (f(angle) for angle in (roll, pitch, yaw) for f in (np.cos, np.sin))
    x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return z @ y @ x


@every_device
def test_joints_are_where_the_vendor_has_them(name: str) -> None:
    told = _vendor(name)["joints"]
    for joint in _ours(name).joints:
        if joint.name not in told:
            continue
        vendor = told[joint.name]
        assert joint.type == vendor["type"], joint.name
        np.testing.assert_allclose(joint.pose.position, vendor["xyz"], atol=1e-9, err_msg=joint.name)
        np.testing.assert_allclose(_turned(joint.pose), _rotation(vendor["rpy"]), atol=1e-9, err_msg=joint.name)
        if "axis" in vendor:
            np.testing.assert_allclose(joint.axis, vendor["axis"], atol=1e-12, err_msg=joint.name)
        if "mimic" in vendor:
            assert joint.mimic is not None
            assert (joint.mimic.joint, joint.mimic.multiplier) == (
                vendor["mimic"]["joint"],
                vendor["mimic"]["multiplier"],
            )


def _turned(pose: Pose) -> Any:
    """Return the rotation of a pose as a matrix: what it makes of the three axes."""
    axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return np.array([np.subtract(pose.apply(axis), pose.position) for axis in axes]).T


@every_device
def test_links_weigh_what_the_vendor_s_weigh_and_turn_as_hard(name: str) -> None:
    told, (_, _, base) = _vendor(name)["links"], _SOURCES[name]
    compared = 0
    for link in _ours(name).links:
        vendor = told.get(base + link.name) or told.get(link.name)
        if vendor is None or "mass" not in vendor:
            continue
        ours, inertia = link.inertial, vendor["inertia"]
        assert ours is not None, link.name
        assert ours.mass == pytest.approx(vendor["mass"], rel=1e-9), link.name
        np.testing.assert_allclose(ours.pose.position, [float(x) for x in vendor["com"]], atol=1e-9, err_msg=link.name)
        for moment in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
            assert getattr(ours, moment) == pytest.approx(float(inertia[moment]), rel=1e-9, abs=1e-12), link.name
        compared += 1
    assert compared >= 3
