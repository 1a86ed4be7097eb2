"""A part heavier than stated sinks the tip of a compliant arm: by hand from its stiffness, with another FK."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping

import numpy as np
import pytest
import yourdfpy

from cellc.mock import load
from cellc.mock.plant import Plant
from cellc.mock.reality import AS_STATED, Reality
from tests.cells import generated

# franka_ros2 3.4.0 franka_fr3_moveit_config/config/fr3_ros_controllers.yaml:36
STIFFNESS = dict(
    zip((f"fr3_joint{n}" for n in range(1, 8)), (600.0, 600.0, 600.0, 600.0, 250.0, 150.0, 50.0), strict=True)
)
MORE_KG, STEP = 0.1, 1e-5


def _at_place(reality: Reality) -> dict[str, float]:
    """Return where the joints are as the part arrives at the press, rad and m."""
    cell, plants = load(generated("fr3_hand")), list[Plant]()
    assert cell.rehearse(cell.entry("tray_to_press"), watch=plants.append, reality=reality).passed
    (arrival,) = [each for each in plants[-1].arrivals if each.goal == "place"]
    joints: dict[str, float] = {}
    for history in plants[-1].control.histories.values():
        row = history.positions[np.searchsorted(history.stamps, arrival.stamp_ns, side="right") - 1]
        joints |= dict(zip(history.names, row.tolist(), strict=True))
    return joints


def test_more_mass_sinks_the_tip_by_weight_over_stiffness() -> None:
    folder = generated("fr3_hand")
    urdf = json.loads((folder / "contract.json").read_text(encoding="utf-8"))["files"]["urdf_mock"]
    robot = yourdfpy.URDF.load(io.StringIO((folder / urdf).read_text(encoding="utf-8")), load_meshes=False)

    def height(joints: Mapping[str, float]) -> float:
        robot.update_cfg({name: at for name, at in joints.items() if name in robot.joint_map})
        return float(robot.get_transform("fr3_hand_tcp", "world")[2, 3])

    stated, heavier = _at_place(AS_STATED), _at_place(Reality(part_more_kg={"arm": MORE_KG}))
    slopes = {
        name: (height(stated | {name: stated[name] + STEP}) - height(stated | {name: stated[name] - STEP})) / 2.0 / STEP
        for name in STIFFNESS
    }
    sunk = sum(MORE_KG * 9.81 * slope**2 / STIFFNESS[name] for name, slope in slopes.items())
    assert 0.5e-3 < sunk < 1.5e-3
    assert height(stated) - height(heavier) == pytest.approx(sunk, rel=0.01)
