"""Who loses a claim when a robot no longer follows set points."""

from __future__ import annotations

import pytest

from cellc.compiler.deploy.bringup import bring_up
from tests.cells import linked, spec_of


@pytest.mark.parametrize(
    ("cell", "watched"),
    [
        ("ur5e_pick", ["arm_trajectory"]),
        # Nobody has named what moves the rail on real hardware: the one controller of rail and arm is the mock's alone.
        ("rail_arm", ["trajectory"]),
    ],
)
def test_controllers_of_a_robot_with_a_program_are_watched_on_either_target(cell: str, watched: list[str]) -> None:
    (watch,) = bring_up(linked(spec_of(cell))).watches
    assert list(watch.controllers) == watched
