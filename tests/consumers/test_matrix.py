"""Cells build for every distribution that is supported."""

from __future__ import annotations

import pytest

from tests.cells import DISTROS
from tests.consumers.matrix import SPECS, build, every_build, spec_for


@every_build
def test_cell_builds_and_foreign_parsers_agree(cell: str, distro: str) -> None:
    assert build(cell, distro).graph.cell.distro == distro


@pytest.mark.parametrize("distro", DISTROS)
def test_version_tuple_is_the_one_of_the_distribution(distro: str) -> None:
    text = spec_for("ur5e_pick", distro)
    assert f"  ros: {distro}\n" in text
    driver = {"humble": "2.14.0", "jazzy": "3.8.0", "kilted": "4.8.0", "lyrical": "6.0.0"}[distro]
    assert f"driver: ur_robot_driver {driver}\n" in text


@pytest.mark.parametrize("distro", DISTROS)
def test_two_arms_have_their_own_prefixes_and_namespaces(distro: str) -> None:
    files = build("two_arms", distro).texts
    assert "/left/controller_manager" in files["config/left.controllers.yaml"]
    assert "/right/controller_manager" in files["config/right.controllers.yaml"]
    assert 'name="left_elbow_joint"' in files["urdf/two_arms.mock.urdf"]
    assert 'name="right_elbow_joint"' in files["urdf/two_arms.mock.urdf"]


def test_matrix_holds_every_cell_of_the_repository_and_two_arms() -> None:
    assert len(SPECS) >= 4
