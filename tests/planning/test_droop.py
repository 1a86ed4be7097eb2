"""Where joints behind springs come to rest: by hand, by the potential energy that another library computes, by both.

Masses, centers and origins are those of openarm_description 846a82d (2026-05-29) and franka_description 1.0.1; gains
those of openarm_description assets/robot/openarm_v2.0/config/arm/control/control_gains.yaml:16 and of franka_ros2
3.4.0 franka_fr3_moveit_config/config/fr3_ros_controllers.yaml:36.
"""

from __future__ import annotations

import io
import json
import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache

import numpy as np
import pytest
import yourdfpy

from cellc.contract.control_law import ControlLaw, JointLaw, LinkMass
from cellc.contract.vocabulary import Gravity, Loop
from cellc.robot.planning import Load, RobotModel, Springs
from tests.cells import ROOT

G = 9.81
EMPTY = Load()
KP = (70.0, 70.0, 70.0, 60.0, 10.0, 10.0, 10.0)
FR3_P = (600.0, 600.0, 600.0, 600.0, 250.0, 150.0, 50.0)
FR3_HOME = {f"fr3_joint{number}": math.radians(deg) for number, deg in enumerate((0, -45, 0, -135, 0, 90, 45), start=1)}
# Mass, m along the arm from its joint, and m to its front side: of the forearm from joint 4, of the hand from joint 6.
FOREARM = ((0.63485, 0.05746, -0.00310), (0.61566, 0.0955 + 0.04709, -0.00074))
HAND = (
    (0.47520, -0.00005, 0.00002),
    (0.52832, 0.05938, 0.01379),
    (0.12598, 0.068 + 0.02417, -0.00143 - 0.01250),
    (0.11372, 0.068 + 0.02679, -0.00143 - 0.01280),
)
WRIST, ELBOW = 0.216, 0.06625 + 0.15375
UPPER_ARM = ((1.14167, 0.0, 0.00090), (0.27751, 0.03126, -0.02472), (1.07386, 0.06625 + 0.10937, -0.00301))


@cache
def urdf(cell: str) -> str:
    folder = ROOT / "generated" / cell
    contract = json.loads((folder / "contract.json").read_text(encoding="utf-8"))
    return (folder / str(contract["files"]["urdf_mock"])).read_text(encoding="utf-8")


@cache
def robot(cell: str) -> RobotModel:
    return RobotModel.from_urdf(urdf(cell), mesh_roots=[ROOT])


def springs_of_openarm(side: str = "left") -> ControlLaw:
    joints = {f"openarm_{side}_joint{number}": JointLaw(stiffness=kp) for number, kp in enumerate(KP, start=1)}
    return ControlLaw(loop=Loop.SPRING, joints=joints, lags=True)


def springs_of_fr3(part_kg: float) -> ControlLaw:
    joints = {joint: JointLaw(stiffness=p) for joint, p in zip(FR3_HOME, FR3_P, strict=True)}
    part = LinkMass(link="fr3_hand_tcp", mass_kg=part_kg, center=(0.0, 0.0, 0.0))
    return ControlLaw(loop=Loop.SPRING, joints=joints, gravity=Gravity.COMPENSATED, part=part)


def droop(law: ControlLaw, model: RobotModel, at: Mapping[str, float], load: Load = EMPTY) -> dict[str, float]:
    springs = Springs(law, model, load)
    commanded = np.array([at[joint] for joint in springs.joints])
    return dict(zip(springs.joints, (commanded - springs.balance(commanded)).tolist(), strict=True))


def level_forearm() -> dict[str, float]:
    at = {f"openarm_left_joint{number}": 0.0 for number in range(1, 8)}
    return at | {"openarm_left_joint4": math.pi / 2}


def by_hand() -> tuple[float, float, float]:
    """Droop of joints 1, 4 and 6 with the upper arm upright and the forearm level, as three levers in one plane."""
    shoulder = elbow = wrist = 0.0

    def moment(masses: Sequence[tuple[float, float, float]], angle: float) -> float:
        return G * sum(m * (along * math.cos(angle) + front * math.sin(angle)) for m, along, front in masses)

    for _ in range(50):
        hand = moment(HAND, shoulder + elbow + wrist)
        below_wrist = [(sum(m for m, _, _ in HAND), WRIST, 0.0)]
        forearm = hand + moment((*FOREARM, *below_wrist), shoulder + elbow)
        below_elbow = [(sum(m for m, _, _ in (*FOREARM, *HAND)), ELBOW, 0.0)]
        upper = moment((*UPPER_ARM, *below_elbow), shoulder + math.pi / 2)
        shoulder, elbow, wrist = (forearm + upper) / 70.0, forearm / 60.0, hand / 10.0
    return shoulder, elbow, wrist


def test_openarm_with_its_usual_gains_droops_as_worked_out_by_hand() -> None:
    shoulder, elbow, wrist = by_hand()
    assert 0.066 < elbow < 0.075  # 4.4 Nm at 60 Nm/rad
    found = droop(springs_of_openarm(), robot("openarm_bimanual"), level_forearm())
    assert abs(found["openarm_left_joint4"]) == pytest.approx(elbow, rel=0.01)
    assert abs(found["openarm_left_joint6"]) == pytest.approx(wrist, rel=0.01)
    assert abs(found["openarm_left_joint1"]) == pytest.approx(shoulder, rel=0.01)


def test_part_of_100_g_that_the_arm_was_not_told_of_moves_its_joints_as_worked_out_by_hand() -> None:
    # Upper arm 316 mm leaning back by 45 deg, elbow 82.5 mm aside, forearm level: the tool hangs below the flange.
    elbow_x = 0.0825 * math.cos(math.radians(45)) - 0.316 * math.sin(math.radians(45))
    tip_x = elbow_x + 0.384 + 0.088
    found = droop(springs_of_fr3(0.1), robot("fr3_hand"), FR3_HOME, Load(holds=True))
    assert abs(found["fr3_joint4"]) == pytest.approx(0.1 * G * (tip_x - elbow_x) / 600.0, rel=0.01)
    assert abs(found["fr3_joint6"]) == pytest.approx(0.1 * G * 0.088 / 150.0, rel=0.01)
    assert abs(found["fr3_joint2"]) == pytest.approx(0.1 * G * tip_x / 600.0, rel=0.01)
    assert set(droop(springs_of_fr3(0.1), robot("fr3_hand"), FR3_HOME).values()) == {0.0}


def test_part_of_100_g_lowers_the_tip_by_most_of_a_millimeter() -> None:
    model, below = robot("fr3_hand"), droop(springs_of_fr3(0.1), robot("fr3_hand"), FR3_HOME, Load(holds=True))
    at = {joint: value - below[joint] for joint, value in FR3_HOME.items()}
    wanted, real = (model.link_pose("fr3_hand_tcp", each, base_link="world") for each in (FR3_HOME, at))
    # Of the three joints in the plane: each turns the tip by its droop, at its lever.
    levers_m = {"fr3_joint2": 0.3069, "fr3_joint4": 0.472, "fr3_joint6": 0.088}
    by_hand_m = sum(abs(below[joint]) * lever for joint, lever in levers_m.items())
    assert wanted.position[2] - real.position[2] == pytest.approx(by_hand_m, rel=0.01)
    assert 0.5e-3 < by_hand_m < 0.9e-3


class Energy:
    """Torques from the potential energy of links that yourdfpy places, by the principle of virtual work."""

    def __init__(self, text: str, carried: tuple[LinkMass, ...], *, robot_too: bool) -> None:
        self.model = yourdfpy.URDF.load(io.StringIO(text), load_meshes=False, load_collision_meshes=False)
        links = self.model.robot.links if robot_too else []
        self.masses = [(link.name, link.inertial.mass, link.inertial.origin) for link in links if link.inertial]
        self.carried = carried

    def at(self, positions: Mapping[str, float]) -> float:
        self.model.update_cfg({joint: positions.get(joint, 0.0) for joint in self.model.actuated_joint_names})
        total = 0.0
        for link, mass, origin in self.masses:
            place = self.model.get_transform(link, "world") @ (np.eye(4) if origin is None else origin)
            total += mass * G * place[2, 3]
        for one in self.carried:
            total += one.mass_kg * G * (self.model.get_transform(one.link, "world") @ np.array([*one.center, 1.0]))[2]
        return float(total)

    def torque(self, joint: str, positions: Mapping[str, float]) -> float:
        step = 1e-5
        up, down = ({**positions, joint: positions[joint] + sign * step} for sign in (1.0, -1.0))
        return (self.at(up) - self.at(down)) / (2.0 * step)


def by_energy(
    torque: Callable[[str, Mapping[str, float]], float], gains: Mapping[str, float], at: Mapping[str, float]
) -> dict[str, float]:
    found = dict.fromkeys(gains, 0.0)
    for _ in range(12):
        real = {**at, **{joint: at[joint] - found[joint] for joint in gains}}
        found = {joint: torque(joint, real) / gain for joint, gain in gains.items()}
    return found


@pytest.mark.parametrize("pose", [(0, -10, 0, 10, 0, 0, 0), (-25, -10, 0, 90, 0, 0, 0), (-35, -40, 0, 70, 0, 0, 0)])
def test_droop_of_openarm_is_that_of_its_potential_energy(pose: tuple[float, ...]) -> None:
    law = springs_of_openarm()
    at = dict(zip(law.joints, map(math.radians, pose), strict=True))
    energy = Energy(urdf("openarm_bimanual"), (), robot_too=True)
    expected = by_energy(energy.torque, dict(zip(law.joints, KP, strict=True)), at)
    found = droop(law, robot("openarm_bimanual"), at)
    worst = max(map(abs, expected.values()))
    for joint, value in expected.items():
        assert found[joint] == pytest.approx(value, rel=0.01, abs=1e-4 * worst), joint


def test_poses_of_the_shipped_cell_droop_by_a_tenth_of_a_radian_with_the_usual_gains() -> None:
    law = springs_of_openarm()
    worst = 0.0
    for pose in ((-25, -10, 0, 90, 0, 0, 0), (-35, -40, 0, 70, 0, 0, 0)):
        at = dict(zip(law.joints, map(math.radians, pose), strict=True))
        worst = max(worst, *map(abs, droop(law, robot("openarm_bimanual"), at).values()))
    assert 0.094 < worst < 0.102


@pytest.mark.parametrize(
    "pose", [(0, -45, 0, -135, 0, 90, 45), (60, -30, 0, -120, 0, 100, 45), (20, 10, 30, -80, 5, 70, 0)]
)
def test_droop_of_fr3_is_that_of_the_energy_of_its_part(pose: tuple[float, ...]) -> None:
    law = springs_of_fr3(0.7)
    assert law.part is not None
    at = dict(zip(FR3_HOME, map(math.radians, pose), strict=True))
    energy = Energy(urdf("fr3_hand"), (law.part,), robot_too=False)
    expected = by_energy(energy.torque, dict(zip(FR3_HOME, FR3_P, strict=True)), at)
    found = droop(law, robot("fr3_hand"), at, Load(holds=True))
    for joint, value in expected.items():
        assert found[joint] == pytest.approx(value, rel=0.01, abs=1e-6), joint


def test_device_that_compensates_too_much_lifts_its_arm() -> None:
    law = springs_of_fr3(0.1)
    found = droop(law, robot("fr3_hand"), FR3_HOME, Load(compensation=0.02))
    whole = Energy(urdf("fr3_hand"), (), robot_too=True).torque("fr3_joint4", FR3_HOME)
    assert found["fr3_joint4"] == pytest.approx(-0.02 * whole / 600.0, rel=0.01)


def test_integral_takes_what_it_may_and_leaves_the_rest_to_the_spring() -> None:
    joints = {"fr3_joint4": JointLaw(stiffness=600.0, integral=10.0, integral_most=0.3)}
    part = LinkMass(link="fr3_hand_tcp", mass_kg=0.1, center=(0.0, 0.0, 0.0))
    law = ControlLaw(loop=Loop.SPRING, joints=joints, gravity=Gravity.COMPENSATED, part=part)
    springs = Springs(law, robot("fr3_hand"), Load(holds=True), FR3_HOME)
    commanded = np.array([FR3_HOME["fr3_joint4"]])
    left = 0.1 * G * 0.472 - 0.3
    assert abs(float((commanded - springs.balance(commanded))[0])) == pytest.approx(left / 600.0, rel=0.01)


def test_joint_whose_spring_is_weaker_than_gravity_ends_far_from_its_command() -> None:
    joints = {"openarm_left_joint4": JointLaw(stiffness=0.5)}
    springs = Springs(ControlLaw(loop=Loop.SPRING, joints=joints), robot("openarm_bimanual"), Load(), level_forearm())
    commanded = np.array([math.pi / 2])
    assert abs(float((springs.balance(commanded) - commanded)[0])) > 0.9
