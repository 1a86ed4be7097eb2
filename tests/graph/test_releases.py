"""What was released together is no question, the newest or not; what never was is one, with the nearest release.

Expected versions are those of `distribution.yaml` at the tags of rosdistro, and of `dependency.repos` of the vendor.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.graph.releases import release_sets
from cellc.compiler.graph.versions import Answer, compatibility
from cellc.compiler.pipeline import check
from tests.cells import spec_text, there, written

_UR = ("ur_robot_driver 3.8.0", "ur_client_library 2.14.1", "ur_description 3.5.1")
_FRANKA = ("franka_ros2 2.5.0", "libfranka 0.20.4", "franka_description 2.8.0")
_OF_VERSIONS = {"version-not-in-matrix", "version-outside-matrix", "package-of-another-distribution"}


def _found(folder: Path, cell: str, changes: dict[str, str]) -> list[tuple[str, str, str]]:
    text = spec_text(cell)
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    found = check(written(folder, text)).diagnostics
    lines = text.splitlines()
    return [
        (finding.code, lines[finding.span.line - 1].strip(), finding.message)
        for finding in found
        if finding.code in _OF_VERSIONS
    ]


def _ur(driver: str, sdk: str, description: str) -> dict[str, str]:
    return dict(
        zip(
            _UR, (f"ur_robot_driver {driver}", f"ur_client_library {sdk}", f"ur_description {description}"), strict=True
        )
    )


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param(_ur("3.4.0", "2.3.0", "3.3.0"), id="jazzy-2025-09-19"),
        pytest.param(_ur("2.4.13", "1.4.0", "2.4.5"), id="jazzy-2024-11-21-of-a-line-that-humble-has-today"),
        pytest.param(
            {"ros2_control: 4.47.0": "ros2_control: 4.11.0", "moveit: 2.12.4": "moveit: 2.9.0"}, id="jazzy-2024-05-23"
        ),
    ],
)
def test_versions_of_one_sync_are_in_the_matrix(tmp_path: Path, changes: dict[str, str]) -> None:
    assert _found(tmp_path, "ur5e_pick", changes) == []


def test_what_a_release_of_the_vendor_is_built_with_is_in_the_matrix(tmp_path: Path) -> None:
    older = ("franka_ros2 2.2.0", "libfranka 0.19.0", "franka_description 1.3.0")
    assert _found(tmp_path, "fr3_hand", dict(zip(_FRANKA, older, strict=True))) == []


def test_versions_of_two_syncs_are_one_finding_that_names_the_nearest(tmp_path: Path) -> None:
    ((code, line, message),) = _found(tmp_path, "ur5e_pick", _ur("3.4.0", "2.1.0", "3.3.0"))
    assert (code, line) == ("version-not-in-matrix", "sdk: ur_client_library 2.1.0")
    assert "driver 3.4.0, sdk 2.3.0 and description 3.3.0 in jazzy of 2025-09-19" in message


def test_three_versions_that_nobody_released_are_one_finding(tmp_path: Path) -> None:
    ((code, line, _),) = _found(tmp_path, "ur5e_pick", _ur("3.99.0", "2.99.0", "3.99.0"))
    assert (code, line) == ("version-not-in-matrix", "driver: ur_robot_driver 3.99.0")


def test_line_of_another_distribution_remains_an_error(tmp_path: Path) -> None:
    (found,) = _found(tmp_path, "ur5e_pick", {"moveit: 2.12.4": "moveit: 2.5.9"})
    assert found[0] == "package-of-another-distribution"


def test_package_holds_from_the_day_on_which_it_changed() -> None:
    sets = {release.name: release.packages for release in release_sets("jazzy")}
    assert sets["jazzy of 2025-10-14"]["ur_robot_driver"] == "3.4.0"
    assert sets["jazzy of 2025-11-19"]["ur_robot_driver"] == "3.6.0"
    assert "realsense2_camera" not in sets["jazzy of 2024-05-23"]


def test_audit_says_which_release_the_packages_of_a_device_are_of(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    for old, new in _ur("3.4.0", "2.3.0", "3.3.0").items():
        text = text.replace(old, new)
    graph = there(check(written(tmp_path, text)).graph)
    judged = {(requirement.pin.holder, requirement.pin.part): requirement for requirement in compatibility(graph.cell)}
    assert judged["arm", "sdk"].answer is Answer.OK
    assert "jazzy of 2025-09-19" in judged["arm", "sdk"].evidence
