"""The parameters of nodes that are played, as `ros2 param` finds them: those of the generated folder."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.contract.limits import limits
from cellc.mock.folder import GeneratedFolder
from cellc.mock.nodes.robot_state_publisher import NODE, PUBLISH_FREQUENCY_HZ
from cellc.robot.description.yaml_values import load_values

Parameters = Mapping[str, object]
"""Values by name; one within a group is `group.name`."""


def played_parameters(folder: GeneratedFolder) -> dict[str, Parameters]:
    """Return the parameters of robot_state_publisher, of the managers and of controllers, by full name."""
    found: dict[str, Parameters] = {
        f"/{NODE}": {"robot_description": folder.urdf, "publish_frequency": PUBLISH_FREQUENCY_HZ}
    }
    for manager, text in folder.parameters.items():
        namespace = folder.contract.managers[manager].namespace.rstrip("/")
        nodes = load_values(text, most=limits().folder_values)
        for name, node in nodes.items() if isinstance(nodes, dict) else ():
            if isinstance(node, dict):
                full = name if name.startswith("/") else f"{namespace}/{name}"
                found[full] = dict(_flat(node.get("ros__parameters"), ""))
    return found


def _flat(values: object, name: str) -> Iterator[tuple[str, object]]:
    """Yield values by their full names; ROS has none that is an empty list."""
    if isinstance(values, dict):
        for key, value in values.items():
            yield from _flat(value, f"{name}.{key}" if name else str(key))
    elif values not in ([], None):
        yield name, values
