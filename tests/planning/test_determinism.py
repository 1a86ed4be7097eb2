"""The same plan, to the last bit, in processes of different hash seeds."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]

SCRIPT = """
import sys
sys.path.insert(0, {tests!r})
from planning.arm import ADJACENT, GROUP, HOME, LIMITS, arm_urdf
from cellc.robot.planning import CollisionScene, Planner, RobotModel, disabled_collisions, time_parameterize
from cellc.contract.transforms import Pose

model = RobotModel.from_urdf(arm_urdf())
disabled = [pair.links for pair in disabled_collisions(model, samples=20, rng_seed=1, margin_m=0.005)]
wall = Pose((-0.5, 0.0, 0.25), (0.0, 0.0, 0.0, 1.0))
scene = CollisionScene(model, disabled_collisions=disabled).attach("wall", "table", (0.5, 0.02, 0.5), wall)
planner = Planner(model, GROUP, LIMITS, scene)
down = (0.5**0.5, 0.5**0.5, 0.0, 0.0)
start, goal = (
    planner.inverse_kinematics(Pose((-0.45, y, 0.25), down), HOME, seeds=8, rng_seed=2).configuration
    for y in (-0.35, 0.35)
)
path = planner.plan_to_configuration(start, goal, rng_seed=3)
line = planner.plan_cartesian(goal, Pose((-0.45, 0.35, 0.15), down))
assert len(path.sections) > 1
print(disabled, repr(time_parameterize(path.then(line), LIMITS)))
"""


def _run(**settings: str) -> str:
    script = SCRIPT.format(tests=str(REPOSITORY / "tests"))
    environment = {**os.environ, **settings}
    result = subprocess.run(
        [sys.executable, "-c", script], cwd=REPOSITORY, env=environment, capture_output=True, text=True, check=True
    )
    return result.stdout


def test_two_processes_plan_bit_identically() -> None:
    first = _run(PYTHONHASHSEED="1")
    assert "TrajectoryPoint" in first
    assert _run(PYTHONHASHSEED="2") == first


def test_plan_does_not_carry_the_last_bits_of_a_linear_algebra_library() -> None:
    # Kernels of an older processor multiply in another order, as those of another release do; without OpenBLAS on a
    # processor of this family the setting does nothing.
    assert _run(OPENBLAS_CORETYPE="Prescott") == _run()
