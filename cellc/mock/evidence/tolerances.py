"""Path tolerances of joints, as the parameter files state them for the controllers."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

from cellc.mock.folder import GeneratedFolder


def path_tolerances(folder: GeneratedFolder) -> dict[str, float]:
    """Return `constraints.<joint>.trajectory` of each joint that has one above zero; zero is no tolerance."""
    return dict(found for text in folder.parameters.values() for found in _tolerances(text))


def _tolerances(text: str) -> Iterator[tuple[str, float]]:
    try:
        nodes = yaml.safe_load(text)
    except yaml.YAMLError:
        return  # the controller manager says what is wrong with it
    for node in nodes.values() if isinstance(nodes, dict) else ():
        parameters = node.get("ros__parameters") if isinstance(node, dict) else None
        constraints = parameters.get("constraints") if isinstance(parameters, dict) else None
        for joint, constraint in constraints.items() if isinstance(constraints, dict) else ():
            value = constraint.get("trajectory") if isinstance(constraint, dict) else None
            if isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0.0:
                yield str(joint), float(value)
