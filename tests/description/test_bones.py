"""Lines through limbs, held against figures by hand."""

from __future__ import annotations

import pytest

from cellc.robot.description.bones import bones
from cellc.robot.description.posture import posture
from cellc.robot.description.urdf_reader import read_urdf

_ARM = """<robot name="r">
  <link name="base"/>
  <link name="upper"><collision><origin xyz="0 0.2 0.5"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0 0 1"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>"""

_SLIDE = """<robot name="r"><link name="rail"/><link name="carriage"/>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="carriage"/><origin xyz="0 0 0.1"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="2" effort="1" velocity="1"/></joint>
</robot>"""


def _bones(text: str, positions: dict[str, float]) -> list[tuple[tuple[float, ...], ...]]:
    description = read_urdf(text, "r.urdf").value
    assert description is not None
    lines = bones(description, posture(description, positions))
    return [tuple(tuple(round(value, 6) + 0.0 for value in end) for end in line) for line in lines]


def test_line_runs_through_a_limb_beside_its_frames() -> None:
    """The upper arm is 200 mm beside the plane of the frames, the lower one in it."""
    assert _bones(_ARM, {}) == [
        ((0, 0, 0), (0, 0.2, 0)),
        ((0, 0.2, 0), (0, 0.2, 1)),
        ((0, 0.2, 1), (0, 0, 1)),
    ]


@pytest.mark.parametrize("way", [0.5, 1.5])
def test_line_follows_a_slide_from_its_zero(way: float) -> None:
    assert _bones(_SLIDE, {"slide": way}) == [((0, 0, 0), (0, 0, 0.1)), ((0, 0, 0.1), (way, 0, 0.1))]
