"""Where arms of the catalog hold their tips, against poses computed from their vendors' own descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cellc.compiler.catalog.load import CatalogDevice, load_device
from tests.catalog.chains import transform
from tests.foreign_yaml import safe_load

PUBLISHED: dict[str, Any] = safe_load(Path(__file__).with_name("published_poses.yaml").read_text(encoding="utf-8"))
SAME_ARM = {"kinova_gen3_2f_85": "kinova_gen3", "kinova_gen3_6dof_2f_85": "kinova_gen3_6dof"}
"""Models that are another one with fingers."""
ARMS = {name: name for name in PUBLISHED} | SAME_ARM
# By hand from the origins in the vendor's description: shoulder to flange, stretched out, m.
GEN3_UPPER_M = 2 * 0.21038 + 0.20843
WRIST_M = 2 * 0.10593 + 0.061525
OPENARM_M = 0.06625 + 0.15375 + 0.0955 + 0.1205
REACH_M = {
    "kinova_gen3": GEN3_UPPER_M + WRIST_M,
    "kinova_gen3_6dof": 0.41 + 0.20843 + WRIST_M,
    "openarm_v2_left": OPENARM_M,
    "openarm_v2_right": OPENARM_M,
}


def _device(name: str) -> CatalogDevice:
    device = load_device(name).value
    assert device is not None
    return device


@pytest.mark.parametrize("name", ARMS)
def test_the_tip_is_where_the_vendor_s_description_has_it(name: str) -> None:
    told, description = PUBLISHED[ARMS[name]], _device(name).description
    for pose in told["poses"]:
        positions = dict(zip(told["joints"], pose["at"], strict=True))
        actual = transform(description, told["root"], told["tip"], positions)
        np.testing.assert_allclose(actual[:3], pose["tip"], atol=1e-6)


@pytest.mark.parametrize("name", ARMS)
def test_joints_stand_in_the_order_of_the_driver(name: str) -> None:
    told, device = PUBLISHED[ARMS[name]], _device(name)
    fingers = device.model.gripper
    own = [joint.name for joint in device.description.joints if joint.movable and joint.mimic is None]
    assert own == [*told["joints"], *([] if fingers is None else [fingers.joint])]
    assert device.model.home is not None
    assert set(device.model.home) == set(own)


@pytest.mark.parametrize("name", REACH_M)
def test_the_arm_reaches_as_far_as_its_links_are_long(name: str) -> None:
    told, description = PUBLISHED[name], _device(name).description
    shoulder = transform(description, told["root"], description.joints[1].child, {})[:3, 3]
    generator, farthest = np.random.default_rng(3), 0.0
    for configuration in generator.uniform(-2.0, 2.0, size=(200, len(told["joints"]))):
        positions = dict(zip(told["joints"], configuration, strict=True))
        tip = transform(description, told["root"], told["tip"], positions)[:3, 3]
        farthest = max(farthest, float(np.linalg.norm(tip - shoulder)))
    assert 0.85 * REACH_M[name] < farthest <= REACH_M[name] + 0.03  # offsets of some millimetres beside the axis
