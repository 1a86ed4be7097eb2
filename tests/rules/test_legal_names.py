"""The name that a finding on an illegal ROS name suggests is legal itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rules.examples import Example, diagnose_example

_INTERFACE = """
interfaces:
  "{name}": {{topic: geometry_msgs/msg/PoseStamped, from: perception, to: {{task: {{depth: 1}}}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}}
"""


@pytest.mark.parametrize(
    ("written", "suggested"),
    [
        ("/camera-markers", "/camera_markers"),
        ("markers", "/markers"),
        ("/2d/markers", "/_2d/markers"),
        ("/markers//left/", "/markers/left"),
        ("/$(id)", "/id"),
        ("/-", "/name"),
    ],
)
def test_suggested_name_is_legal(written: str, suggested: str, tmp_path: Path) -> None:
    def found(name: str) -> list[str]:
        example = Example("yaml", _INTERFACE.format(name=name))
        return [one.help for one in diagnose_example(example, tmp_path) if one.code == "illegal-ros-name"]

    assert found(written) == [f"write `{suggested}`, as the nodes do"]
    assert found(suggested) == []
