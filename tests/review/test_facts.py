"""What a review knows of a spec beside the files of its package, against the complete cell by hand."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from cellc.tools.review.facts import _of_spec
from cellc.tools.review.leaves import Leaf
from tests.cells import COMPLETE, CORPUS, graph_of


@cache
def _facts(spec: Path) -> dict[str, Leaf]:
    return {"/".join(keys): value for keys, value in _of_spec(graph_of(spec).cell)}


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("spec/safety/stop/authority", "safety_plc"),
        ("spec/bringup/first_motion/arm/direction", "+"),
        ("spec/network/domain_id", 42),
        ("spec/targets/mock/hardware", "mock"),
        ("frame/fixture_A/reference_points", 3),
        ("spec/hosts/control_pc/scheduling", "preempt_rt"),
        ("spec/nodes//perception/lifecycle", True),
        ("spec/nodes//task/executable", "pick_place"),
    ],
)
def test_fact_of_the_complete_cell(path: str, value: Leaf) -> None:
    assert _facts(COMPLETE)[path] == value


def test_recorded_topics_and_statements_are_facts() -> None:
    facts = _facts(CORPUS / "valid" / "more_fields.yaml")
    assert facts["spec/recording/topics"] == ("/object_pose", "/diagnostics", "/camera/camera/color/image_raw")
    assert facts["spec/mock_statements/demo_simulation/Hardware/by"] == "controls"
    assert facts["spec/mock_statements/demo_simulation/status/date"] == "2026-07-01"
