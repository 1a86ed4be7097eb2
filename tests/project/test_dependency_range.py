"""Lower bounds of the dependencies are versions that can be taken, and the script that takes them reads all."""

from __future__ import annotations

import re

import pytest

from tests.cells import ROOT
from tests.project.dependency_range import lowest


def test_every_requirement_states_a_lower_bound_and_no_upper_one() -> None:
    # What is installed may be older than the file.
    section = (ROOT / "pyproject.toml").read_text().partition("\ndependencies")[2].partition("[project.scripts]")[0]
    stated = re.findall(r'"([^"]+)"', section)
    assert {line.partition("==")[0] for line in lowest(stated)} >= {"click", "pin", "xmlschema", "mkdocs", "mcap"}
    assert [one for one in stated if any(sign in one.partition(";")[0] for sign in ("<", "!=", "~="))] == []


def test_lower_bounds_are_taken_as_versions_with_their_markers() -> None:
    stated = [
        "numpy>=2.0; python_version < '3.13'",
        "mcap>=1.1; extra == 'evidence'",
        "mcap>=1.1; extra == 'test'",
        "lxml>=5.3; (python_version >= '3.13') and extra == 'test'",
        "ros-kilted-rclpy[fastrtps]==9.1.2; (sys_platform == 'linux') and extra == 'ros'",
    ]
    assert lowest(stated) == (
        "lxml==5.3; (python_version >= '3.13')",
        "mcap==1.1",
        "numpy==2.0; python_version < '3.13'",
    )


def test_a_requirement_without_a_lower_bound_is_refused() -> None:
    with pytest.raises(ValueError, match="`click` states no lower bound"):
        lowest(["click"])
