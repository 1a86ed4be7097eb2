"""Everything that is wrong with one tag of ros2_control is told, each on its own."""

from __future__ import annotations

from pathlib import Path

from tests.rules.examples import Example, diagnose_example

TAGS = """
<link name="tool"/>
<ros2_control name="stage" type="system">
  <hardware><plugin>stage_driver/Hardware</plugin></hardware>
  <joint name="turn">
    <command_interface name="positon"/><state_interface name="position"/><state_interface name="position"/>
  </joint>
  <joint name="slide">
    <command_interface name="position"><param name="min">2</param><param name="max">1</param></command_interface>
    <state_interface name="velocity"><param name="initial_value">fast</param></state_interface>
  </joint>
</ros2_control>
<ros2_control name="second" type="system">
  <hardware><plugin>second_driver/Hardware</plugin></hardware>
  <joint name="turn"><command_interface name="effort"/></joint>
  <joint name="slide"/>
</ros2_control>
"""


def test_each_fault_of_a_tag_is_named(folder: Path) -> None:
    found = diagnose_example(Example("xml", TAGS), folder)
    assert sorted(one.message for one in found if one.code == "unusable-ros2-control") == [
        "`position` of `slide` must have `min` at most `max`, got 2 and 1",
        "`slide` of `second` has no interface",
        "`turn` has the command interface `positon`, which is not `position`",
        "`turn` has the state interface `position` twice",
        "`turn` is commanded by `stage` and `second`",
        "`velocity` of `slide` must have a number in `initial_value`, got `fast`",
    ]
