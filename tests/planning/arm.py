"""A six-joint arm on a table, written here so that the planner's tests need no device description."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from cellc.robot.planning import JointLimits, PlanningGroup

JOINTS = ("pan", "lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
HOME = (0.0, -1.57, 1.57, -1.57, -1.57, 0.0)

# Classic DH of the UR5e: a, alpha, d (facts/robots.md, section 1).
DH = (
    (0.0, math.pi / 2, 0.1625),
    (-0.425, 0.0, 0.0),
    (-0.3922, 0.0, 0.0),
    (0.0, math.pi / 2, 0.1333),
    (0.0, -math.pi / 2, 0.0997),
    (0.0, 0.0, 0.0996),
)

GROUP = PlanningGroup("arm", JOINTS, "base", "tool")
LIMITS = JointLimits(
    JOINTS,
    lower=(-2 * math.pi, -2 * math.pi, -math.pi, -2 * math.pi, -2 * math.pi, -2 * math.pi),
    upper=(2 * math.pi, 2 * math.pi, math.pi, 2 * math.pi, 2 * math.pi, 2 * math.pi),
    velocity=(math.pi,) * 6,
    acceleration=(5.0,) * 6,
    jerk=(50.0,) * 6,
)
ADJACENT = (
    ("base", "link_1"),
    ("link_1", "link_2"),
    ("link_2", "link_3"),
    ("link_3", "link_4"),
    ("link_4", "link_5"),
    ("link_5", "link_6"),
)


def dh_tool_to_base(configuration: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Multiply the six DH matrices: the oracle of forward kinematics, without pinocchio."""
    transform = np.eye(4)
    for angle, (a, alpha, d) in zip(configuration, DH, strict=True):
        ct, st, ca, sa = math.cos(angle), math.sin(angle), math.cos(alpha), math.sin(alpha)
        link = [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d], [0, 0, 0, 1]]
        transform = transform @ np.array(link)
    return transform


def dh_singular_values(configuration: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the singular values of a numeric Jacobian of the DH matrices, largest first; rows in m and rad."""
    columns = []
    for joint in range(6):
        shift = np.zeros(6)
        shift[joint] = 1e-6
        before, after = dh_tool_to_base(configuration - shift), dh_tool_to_base(configuration + shift)
        turn = (after[:3, :3] - before[:3, :3]) @ dh_tool_to_base(configuration)[:3, :3].T / 2e-6
        columns.append([*((after - before)[:3, 3] / 2e-6), turn[2, 1], turn[0, 2], turn[1, 0]])
    return np.asarray(np.linalg.svd(np.array(columns).T, compute_uv=False), dtype=np.float64)


def _cylinder(length: float, radius: float, xyz: str, rpy: str = "0 0 0") -> str:
    return (
        f'<collision><origin xyz="{xyz}" rpy="{rpy}"/>'
        f'<geometry><cylinder length="{length}" radius="{radius}"/></geometry></collision>'
    )


def _joint(index: int, parent: str, xyz: str, rpy: str) -> str:
    limit = math.pi if index == 2 else 2 * math.pi
    return (
        f'<joint name="{JOINTS[index]}" type="revolute"><parent link="{parent}"/><child link="link_{index + 1}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>'
        f'<limit lower="{-limit}" upper="{limit}" velocity="{math.pi}" effort="150"/></joint>'
    )


def arm_urdf(extra: str = "") -> str:
    """Write the arm: URDF joint origins from DH as in facts/robots.md, cylinders for links, a table under the base.

    Args:
        extra: further links and joints, as XML.
    """
    half = math.pi / 2
    links = {
        "table": '<collision><origin xyz="0 0 -0.1"/><geometry><box size="1.6 1.2 0.2"/></geometry></collision>',
        "base": _cylinder(0.08, 0.07, "0 0 0.04"),
        "link_1": _cylinder(0.14, 0.06, "0 0 0.0"),
        "link_2": _cylinder(0.425, 0.05, "-0.2125 0 0.13", f"0 {half} 0"),
        "link_3": _cylinder(0.36, 0.045, "-0.1961 0 0.01", f"0 {half} 0"),
        "link_4": _cylinder(0.1, 0.04, "0 0 -0.02"),
        "link_5": _cylinder(0.1, 0.04, "0 0 -0.01"),
        "link_6": _cylinder(0.04, 0.04, "0 0 -0.02"),
        "tool": "",
    }
    body = "".join(f'<link name="{name}">{shape}</link>' for name, shape in links.items())
    joints = (
        '<joint name="mount" type="fixed"><parent link="table"/><child link="base"/></joint>'
        + _joint(0, "base", "0 0 0.1625", "0 0 0")
        + _joint(1, "link_1", "0 0 0", f"{half} 0 0")
        + _joint(2, "link_2", "-0.425 0 0", "0 0 0")
        + _joint(3, "link_3", "-0.3922 0 0.1333", "0 0 0")
        + _joint(4, "link_4", "0 -0.0997 0", f"{half} 0 0")
        + _joint(5, "link_5", "0 0.0996 0", f"{half} {math.pi} {math.pi}")
        + '<joint name="tip" type="fixed"><parent link="link_6"/><child link="tool"/></joint>'
    )
    return f'<robot name="test_arm">{body}{joints}{extra}</robot>'
