"""Memory of a cell of many arms: what pinocchio computes in grows with the third power of its joints."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytest.importorskip("resource", reason="peak memory is asked of a POSIX system")

_PEAK_KB = """
import resource, sys
from cellc.contract.control_law import LinkMass
from cellc.robot.planning import CollisionScene, JointLimits, Planner, PlanningGroup, RobotModel, Weights

names = [f"arm_{number}" for number in range(int(sys.argv[1]))]
links = ['<link name="world"/>']
for arm in names:
    for index in range(7):
        links.append(f'<link name="{arm}_{index}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" '
                     f'ixz="0" iyz="0"/></inertial></link>')
        fixed = index == 0
        parent = "world" if fixed else f"{arm}_{index - 1}"
        limit = '' if fixed else '<limit lower="-1" upper="1" velocity="1" effort="1"/><axis xyz="0 1 0"/>'
        links.append(f'<joint name="{arm}_joint_{index}" type="{"fixed" if fixed else "revolute"}"><parent '
                     f'link="{parent}"/><child link="{arm}_{index}"/><origin xyz="0 0 0.3"/>{limit}</joint>')
robot = RobotModel.from_urdf(f'<robot name="many">{"".join(links)}</robot>')
scene = CollisionScene(robot)
kept = []
for arm in names:
    joints = tuple(f"{arm}_joint_{index}" for index in range(1, 7))
    bounds = JointLimits(joints, lower=(-1.0,) * 6, upper=(1.0,) * 6, velocity=(1.0,) * 6, acceleration=(1.0,) * 6,
                         jerk=(1.0,) * 6)
    kept.append(Planner(robot, PlanningGroup(arm, joints, f"{arm}_0", f"{arm}_6"), bounds, scene))
    kept.append(Weights(robot, joints, [LinkMass(link=f"{arm}_6", mass_kg=1.0, center=(0.0, 0.0, 0.1))]))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def _peak_kb(arms: int) -> int:
    done = subprocess.run([sys.executable, "-c", _PEAK_KB, str(arms)], capture_output=True, text=True, check=True)
    return int(done.stdout)


def test_twenty_arms_take_less_than_three_times_the_memory_of_one() -> None:
    assert _peak_kb(20) < 3 * _peak_kb(1)
