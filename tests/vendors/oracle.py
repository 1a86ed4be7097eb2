"""What the vendors' sources say, release by release, as it lies in the shared folder beside the checkout.

A source in the catalog reads ``REPOSITORY@REF FILE:LINES``; ``; @REF :LINES`` after it is the same in another release.
"""

from __future__ import annotations

import re
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
