"""A layout of Foxglove for the bags of a cell: robot and scene, joints, what controllers miss, diagnostics, outcomes.

Foxglove has no schema of layouts; panels and their settings are those of its open source release (Foxglove Studio 1.87,
`packages/studio-base/src/panels`), which later releases read: "Import from file..." in the list of layouts.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from cellc.contract.contract import Contract
from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.vocabulary import TRAJECTORIES, Behavior
from cellc.mock.evidence.topics import (
    ATTEMPTS,
    DIAGNOSTICS,
    LOG,
    controller_state_topic,
    description_topic,
    joint_states_topic,
)

Json = Mapping[str, object]


def to_layout(contract: Contract) -> str:
    """Return the layout as the text of a file."""
    broadcasters = list(_controllers(contract, (Behavior.JOINT_STATE_BROADCASTER,)))
    followers = list(_controllers(contract, TRAJECTORIES))
    positions = dict.fromkeys(
        f"{joint_states_topic(contract, *broadcaster).name}.position[:]" for broadcaster in broadcasters
    )
    errors = dict.fromkeys(
        f"{controller_state_topic(contract, *follower).name}.error.positions[:]" for follower in followers
    )
    panels = {
        "3D!cell": _scene(contract),
        "Plot!positions": _plot("Joint positions, rad and m", positions),
        "Plot!errors": _plot("Path errors, rad and m", errors),
        "DiagnosticSummary!all": {"topicToRender": DIAGNOSTICS.name, "minLevel": 0, "pinnedIds": []},
        "RawMessages!attempts": {"topicPath": f"{ATTEMPTS.name}.data"},
        "RosOut!log": {"topicToRender": LOG, "minLogLevel": 1, "searchTerms": []},
    }
    right = _split("column", ["Plot!positions", "Plot!errors", "DiagnosticSummary!all", "RawMessages!attempts"])
    left = _split("column", ["3D!cell", "RosOut!log"], 75)
    layout: Json = {
        "configById": panels,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": {"direction": "row", "first": left, "second": right, "splitPercentage": 60},
    }
    return json_document(layout)


def _controllers(contract: Contract, behaviors: Iterable[str]) -> Iterable[tuple[str, str]]:
    for name, manager in contract.managers.items():
        for controller, facts in manager.controllers.items():
            if facts.behavior in behaviors:
                yield name, controller


def _scene(contract: Contract) -> Json:
    """Return the panel with the robot: its shapes are those that it collides with where it has no others."""
    return {
        "followTf": contract.root_frame,
        "followMode": "follow-none",
        "layers": {"grid": {"layerId": "foxglove.Grid", "instanceId": "grid", "visible": True, "size": 4}},
        "topics": {description_topic(contract).name: {"visible": True, "displayMode": "auto"}},
        "cameraState": {"distance": 3, "phi": 60, "thetaOffset": 45, "target": [0, 0, 0], "perspective": True},
    }


def _plot(title: str, values: Iterable[str]) -> Json:
    paths = [{"value": value, "enabled": True, "timestampMethod": "receiveTime"} for value in values]
    return {"title": title, "paths": paths, "showXAxisLabels": True, "xAxisVal": "timestamp", "isSynced": True}


def _split(direction: str, panels: Sequence[str], share: float | None = None) -> Json | str:
    """Return panels beside or below each other, each as large as the others where no share is given, in percent."""
    if len(panels) == 1:
        return panels[0]
    rest = _split(direction, panels[1:])
    return {
        "direction": direction,
        "first": panels[0],
        "second": rest,
        "splitPercentage": share or round(100 / len(panels)),
    }
