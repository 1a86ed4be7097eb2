"""What the vendors' sources say, release by release, as it lies in the shared folder beside the checkout.

A source in the catalog reads ``REPOSITORY@REF FILE:LINES``; ``; @REF :LINES`` after it is the same in another release.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from tests.foreign_yaml import safe_load
from tests.oracles import UPSTREAM

VENDORS = UPSTREAM / "vendors"


@dataclass(frozen=True, slots=True)
class Release:
    """The sources of one release of a driver.

    Args:
        device: the device of the catalog that it drives.
        folder: where its facts lie.
        distro: the distribution that it is for.
        driver: the pin that chooses it.
        repository, ref: where it was read.
    """

    device: str
    folder: str
    distro: str
    driver: str
    repository: str
    ref: str

    def __str__(self) -> str:
        return f"{self.device}-{self.distro}-{self.driver.split()[-1]}"

    def text(self, file: str) -> str:
        """Return a file of the release; empty where the shared folder is absent."""
        path = VENDORS / self.folder / f"{file}.yaml"
        return path.read_text(encoding="utf-8") if path.exists() else ""


_UR = "Universal_Robots_ROS2_Driver"
_ROBOTIQ = "ros2_robotiq_gripper"
_KORTEX = "ros2_kortex"
_OPENARM = "openarm_ros2"
_KNUCKLE = ("robotiq_85_left_knuckle_joint",)
_ALL = (
    Release("ur5e", "universal_robots/2.14.0_humble", "humble", "ur_robot_driver 2.14.0", _UR, "2.14.0"),
    Release("ur5e", "universal_robots/3.8.0_jazzy", "jazzy", "ur_robot_driver 3.8.0", _UR, "3.8.0"),
    Release("ur5e", "universal_robots/4.8.0_kilted", "kilted", "ur_robot_driver 4.8.0", _UR, "4.8.0"),
    Release("ur5e", "universal_robots/6.0.0_lyrical", "lyrical", "ur_robot_driver 6.0.0", _UR, "6.0.0"),
    Release("franka_fr3", "franka/humble-2.5.0", "humble", "franka_ros2 2.5.0", "franka_ros2", "2.5.0"),
    Release("franka_fr3", "franka/jazzy-3.4.0", "jazzy", "franka_ros2 3.4.0", "franka_ros2", "3.4.0"),
    Release("robotiq_2f_85", "robotiq/0.0.1_2023-07-17", "humble", "robotiq_driver 0.0.1", _ROBOTIQ, "1a9b663"),
    Release("robotiq_2f_85", "robotiq/humble_a29c69b", "humble", "robotiq_driver a29c69b", _ROBOTIQ, "a29c69b"),
    Release("robotiq_2f_85", "robotiq/main_3b6cf8f", "jazzy", "robotiq_driver 3b6cf8f", _ROBOTIQ, "3b6cf8f"),
    Release("robotiq_2f_85", "robotiq/main_3b6cf8f", "kilted", "robotiq_driver 3b6cf8f", _ROBOTIQ, "3b6cf8f"),
    Release("robotiq_2f_85", "robotiq/main_3b6cf8f", "lyrical", "robotiq_driver 3b6cf8f", _ROBOTIQ, "3b6cf8f"),
    Release("kinova_gen3_2f_85", "kinova/humble", "humble", "ros2_kortex 116d87a", _KORTEX, "humble"),
    Release("kinova_gen3_2f_85", "kinova/jazzy", "jazzy", "ros2_kortex 0.2.6", _KORTEX, "jazzy"),
    Release("openarm_v2_left", "openarm/v2.0", "humble", "openarm_ros2 492b307", _OPENARM, "73ef898"),
    Release("openarm_v2_right", "openarm/v2.0", "humble", "openarm_ros2 492b307", _OPENARM, "73ef898"),
)
RELEASES = _ALL if VENDORS.exists() else ()
"""Every release that was read, where the shared folder is there; a test over none of them is skipped."""


@cache
def facts(release: Release, file: str) -> Any:
    """Return the data of a file of a release."""
    return safe_load(release.text(file))


def lines_of(source: str, release: Release) -> set[str]:
    """Return the lines that a source names in the repository of a release at its ref."""
    repository = ""
    found: set[str] = set()
    for part in source.split("; "):
        named = re.match(r"([\w-]*)@(\S+) (.*)", part)
        if named is None:
            continue
        repository = named[1] or repository
        if (repository, named[2]) == (release.repository, release.ref):
            found |= set(re.findall(r":([\d,]*\d)(?!-)\b", named[3]))
    return found


@dataclass(frozen=True, slots=True)
class Demands:
    """What a plugin wants of the joints of its component; ``exactly`` where further state interfaces are refused."""

    joints: tuple[str, ...]
    command: tuple[str, ...]
    state: tuple[str, ...]
    further_command: tuple[str, ...] = ()
    exactly: bool = False


def parameters(release: Release) -> dict[str, Any]:
    """Return the parameters that the plugin of a release reads; ``kp1..kp7`` and ``a, b`` are several alike."""
    read: dict[str, Any] = {}
    for key, told in facts(release, "hardware_parameters")["parameters"].items():
        first, _, last = key.partition("..")
        stem = first.rstrip("0123456789")
        ends = [int(one[len(stem) :]) for one in (first, last) if last]
        numbered = [f"{stem}{number}" for number in range(ends[0], ends[1] + 1)] if last else []
        read |= dict.fromkeys(numbered or key.split(", "), told)
    return read


def demands(release: Release) -> Demands:
    """Return what the plugin of a release wants; the wording of each vendor's facts is read here and nowhere else."""
    told = facts(release, "hardware_interfaces")
    if release.repository == _OPENARM:
        assert "names are made in code, openarm_<arm_prefix>joint1..7" in told["demanded_of_the_urdf"]
        arm = f"openarm_{release.device.rpartition('_')[2]}_"
        names = (*(f"{arm}joint{number}" for number in range(1, 8)), f"{arm}finger_joint1")
        declared = told["vendor_declares"]
        return Demands(names, tuple(declared["command"]), tuple(declared["state"]))
    if release.repository == _UR:
        joints = told["demanded_of_urdf"]["joints"]
        optional = {name for name, how in joints["command_interfaces"].items() if how.startswith("optional")}
        command = tuple(name for name in joints["command_interfaces"] if name not in optional)
        return Demands(tuple(joints["order"]), command, tuple(joints["state_interfaces"]), tuple(optional))
    if release.repository == _ROBOTIQ:
        joints = told["demanded_of_urdf"]["joints"]
        assert joints["state_interfaces"] == "exactly 2, position and velocity"
        further = ("set_gripper_max_velocity", "set_gripper_max_effort")
        one = joints["command_interfaces"] == "exactly 1, position"
        return Demands(_KNUCKLE, ("position",), ("position", "velocity"), () if one else further, True)
    joints = told["demanded_of_the_urdf"]
    if release.repository == _KORTEX:
        assert joints["joints"].startswith("the arm joints in motor order, then (internal gripper) the gripper joint")
        names = tuple(f"joint_{number}" for number in range(1, 8))
        return Demands((*names, *_KNUCKLE), tuple(joints["vendor_declares"]["command"]), ("position", "velocity"))
    names = tuple(f"fr3_joint{number}" for number in range(1, 8))
    assert joints["joint_names"].startswith("<arm_prefix_><robot_type>_joint1 .. 7, in this order")
    return Demands(names, (), (), tuple(joints["vendor_declares"]))


def exports(release: Release, side: str, prefix: str) -> dict[str, set[str]]:
    """Return what the plugin exports, by the name before the slash; ``<joint>`` stands for every joint.

    Args:
        side: ``command`` or ``state``.
        prefix: that of the device in the cell.
    """
    told = facts(release, "hardware_interfaces")
    if release.repository == "franka_ros2":
        return _exports_of_fr3(told, side, prefix)
    if release.repository == _OPENARM:
        return {"<joint>": set(told["exported"][side])}
    if release.repository == _KORTEX:
        return _named(told["exported_whatever_the_urdf_says"][f"{side}s"], {"<gripper_joint_name>": "<joint>"})
    found: dict[str, set[str]] = {}
    for name, listed in told[f"exports_{side}"].items():
        names = listed["interfaces"] if isinstance(listed, dict) else listed
        found[name.replace("<tf_prefix>", prefix)] = set(counted(names))
    return found


def _named(full: Iterable[str], instead: dict[str, str]) -> dict[str, set[str]]:
    """Return full names of interfaces by what stands before the slash."""
    found: dict[str, set[str]] = {}
    for name in full:
        owner, _, interface = name.partition("/")
        found.setdefault(instead.get(owner, owner), set()).add(interface)
    return found


def _exports_of_fr3(told: Any, side: str, prefix: str) -> dict[str, set[str]]:
    joints = told["demanded_of_the_urdf"]
    found = {"<joint>": set(joints["vendor_declares"])}
    if side == "state":
        sensor = told["sensor"] if "sensor" in told else joints["sensor"]
        found[sensor["name"].replace("<p><robot_type>", f"{prefix}fr3")] = set(sensor["state_interfaces"])
        found[f"{prefix}fr3"] = {"robot_state", "robot_model", "robot_time"}
    return found


def counted(names: Iterable[str]) -> Iterator[str]:
    """Yield names with ``_[0..17]`` written out."""
    for name in names:
        counted = re.fullmatch(r"(.*)\[(\d+)\.\.(\d+)\](.*)", name)
        if counted is None:
            yield name
        else:
            yield from (f"{counted[1]}{number}{counted[4]}" for number in range(int(counted[2]), int(counted[3]) + 1))


def update_rate(release: Release) -> int | None:
    """Return the rate at which the vendor runs the controller manager for this device; None where it takes any."""
    rate = (
        facts(release, "hardware_interfaces").get("update_rate_hz")
        or facts(release, "hardware_interfaces")["update_rate"]
    )
    if release.repository == _UR:
        return int(rate["per_type"][release.device])
    return int(rate["hz"]) if "hz" in rate else None
