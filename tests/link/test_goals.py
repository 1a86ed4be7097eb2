"""A goal belongs to a group: to the one that it names, or to the only one of the cell."""

from __future__ import annotations

from pathlib import Path

from cellc.contract.diagnostics import Diagnostic
from tests.cells import linked, linking, spec_text, written

PUT = "put: {group: load, frame: nest"


def _refused(folder: Path, put: str) -> Diagnostic:
    (problem,) = linking(written(folder, spec_text("dual_ur").replace(PUT, put))).diagnostics
    return problem


def test_the_only_group_of_a_cell_is_that_of_its_goals(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert "group:" not in text.partition("goals:")[2].partition("\n\n")[0]
    assert {goal.group for goal in linked(written(tmp_path, text)).goals} == {"manipulator"}


def test_a_goal_of_several_groups_must_name_its_own(tmp_path: Path) -> None:
    assert PUT in spec_text("dual_ur")
    problem = _refused(tmp_path, "put: {frame: nest")
    assert (problem.code, problem.yaml_path) == ("unknown-group", ("motion", "goals", "put"))
    assert problem.message == "goal `put` must name its group: the cell has 2"
    assert problem.help == "write `group:` with one of `load`, `unload`"


def test_a_group_that_is_misspelt_is_named_with_the_nearest(tmp_path: Path) -> None:
    problem = _refused(tmp_path, "put: {group: laod, frame: nest")
    assert problem.message == "there is no group `laod`"
    assert problem.help.startswith("did you mean `load`")
