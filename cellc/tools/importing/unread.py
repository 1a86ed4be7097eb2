"""What a description states and a device folder does not hold: each kind is counted, and asked about by its name."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from cellc.robot.description.xml_tree import XmlElement, read_xml

_ORIGIN = {"origin": "xyz rpy"}
_GEOMETRY = {"geometry": "", "geometry/box": "size", "geometry/cylinder": "radius length",
             "geometry/sphere": "radius", "geometry/mesh": "filename scale"}  # fmt: skip
_SHAPE = {**_ORIGIN, **_GEOMETRY}


def _below(path: str, parts: Mapping[str, str]) -> dict[str, str]:
    return {f"{path}/{part}": attributes for part, attributes in parts.items()}


_READ: Mapping[str, frozenset[str]] = {
    path: frozenset(attributes.split())
    for path, attributes in {
        "robot": "name version",
        "robot/material": "name",
        "robot/material/color": "rgba",
        "robot/link": "name",
        "robot/link/inertial": "",
        **_below("robot/link/inertial", {**_ORIGIN, "mass": "value", "inertia": "ixx ixy ixz iyy iyz izz"}),
        "robot/link/visual": "name",
        **_below("robot/link/visual", {**_SHAPE, "material": "name", "material/color": "rgba"}),
        "robot/link/collision": "name",
        **_below("robot/link/collision", _SHAPE),
        "robot/joint": "name type",
        **_below("robot/joint", {**_ORIGIN, "parent": "link", "child": "link", "axis": "xyz"}),
        "robot/joint/limit": "lower upper velocity effort",
        "robot/joint/mimic": "joint multiplier offset",
        "robot/joint/dynamics": "damping friction",
        "robot/joint/safety_controller": "soft_lower_limit soft_upper_limit k_position k_velocity",
        "robot/ros2_control": "name type",
        "robot/ros2_control/hardware": "",
        "robot/ros2_control/hardware/plugin": "",
        "robot/ros2_control/hardware/param": "name",
        "robot/ros2_control/joint": "name",
        "robot/ros2_control/joint/command_interface": "name",
        "robot/ros2_control/joint/state_interface": "name",
    }.items()
}
"""Elements and attributes that end in the folder, by their path."""


def unread(text: str) -> Iterator[str]:
    """Yield each kind of element and attribute of a URDF that a device folder does not hold, with how often it is."""
    root = read_xml(text, "robot.urdf").value
    counts = Counter(() if root is None else _unread(root, root.tag))
    for path, count in counts.items():
        yield path.removeprefix("robot/") + (f" ({count} times)" if count > 1 else "")


def _unread(element: XmlElement, path: str) -> Iterator[str]:
    if path not in _READ:
        yield f"<{path.removeprefix('robot/')}>"
        return
    for name in element.attributes:
        if name not in _READ[path] and not name.startswith("xmlns"):
            yield f"{name} of <{path.removeprefix('robot/')}>"
    for child in element.children:
        yield from _unread(child, f"{path}/{child.tag}")
