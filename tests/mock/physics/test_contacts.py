"""What a plan did not have: a post in the way, and drives that give all they have."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.mock.cell import cell_of, load, read_to_run
from cellc.mock.physics.dynamics import Seen, pressed
from cellc.mock.result import RehearsalResult
from cellc.robot.physics.scene import Scene, Touch
from tests.cells import built, diagnose, generated, spec_text, written

_WORLD = "  <worldbody>\n"
_POST = '    <body name="post" pos="0.45 -0.02 1.05"><geom type="box" size="0.02 0.02 0.25"/></body>\n'


def _run(*changes: tuple[str, str]) -> RehearsalResult:
    text = built("ur5e_pick").texts["sim/scene.xml"]
    for before, after in changes:
        assert text.count(before) == 1
        text = text.replace(before, after)
    return cell_of(replace(read_to_run(generated("ur5e_pick"), physics=True), scene=Scene(text, {}))).run(
        "pick_and_place"
    )


def test_a_post_that_no_plan_knows_ends_the_motion_that_meets_it() -> None:
    result = _run((_WORLD, _WORLD + _POST))
    assert result.outcome == "tolerance_violation"
    found = re.search(r"contact: (\S+) and post press on each other from (\S+) s on, with up to (\S+) N", result.reason)
    assert found is not None, result.reason
    assert found[1].startswith(("arm_", "gripper_"))
    assert float(found[3]) > 10.0
    assert any(line.startswith(f"contact: {found[1]} and post press") for line in result.findings)


@pytest.mark.parametrize("fold", [True, False])
def test_the_check_tells_of_the_contact_that_masses_show(fold: bool, tmp_path: Path) -> None:
    """Arms of `openarm_bimanual` hang through by 30 mrad: from `hang` right to `reach` hands pass the bench with less.

    The check has pinocchio's weights at rest, and the run MuJoCo's dynamics. Joints arrive within their tolerances.
    """
    text, folder = spec_text("openarm_bimanual"), shutil.copytree(generated("openarm_bimanual"), tmp_path / "package")
    rehearsals = json.loads((folder / "rehearsals.json").read_text(encoding="utf-8"))
    (steps,) = (each["steps"] for each in rehearsals["rehearsals"] if each["name"] == "both_reach")
    if not fold:
        for spaces in (" ", "\n"):
            assert text.count(f"{{move: fold, together: true}},{spaces}") == 1
            text = text.replace(f"{{move: fold, together: true}},{spaces}", spaces)
        steps[:] = [step for step in steps if step["target"] != "fold"]
    (folder / "rehearsals.json").write_text(json.dumps(rehearsals), encoding="utf-8")
    told = [found for found in diagnose(written(tmp_path, text)) if found.code == "droop-into-contact"]
    result = load(folder, physics=True, edited=True).run("both_reach")
    assert (result.outcome == "succeeded", bool(told)) == (fold, not fold), result.reason
    if not fold:
        assert "between `hang` and `reach` the arm droops until `bench` and `openarm_" in told[0].message
        assert result.reason.startswith("step 2 `move: together reach`: contact: bench and openarm_")


def test_a_drive_that_is_too_weak_is_named_with_its_torque() -> None:
    """The elbow carries 3 kg of forearm and wrists at 0.2 to 0.4 m, and the gripper: more than 10 N m to speed up."""
    weak = 'ctrlrange="-3.141592653589793 3.141592653589793" forcerange="-150 150"'
    result = _run((weak, weak.replace("-150 150", "-2 2")))
    assert any(
        line.startswith("torque: the drive of arm_elbow_joint gives all its 2 N m for ") for line in result.findings
    )


@pytest.mark.parametrize(("since_ns", "first", "most"), [(0, 1, 7.0), (1, 2, 7.0), (2, 3, 5.0)])
def test_a_contact_is_told_with_its_first_instant_and_its_largest_force(since_ns: int, first: int, most: float) -> None:
    forces = ((1, "a", "b", 2.0), (2, "b", "a", 7.0), (3, "a", "b", 5.0))
    seen = [Seen(stamp, Touch(one, other, force, (1.0, 0.0, 0.0))) for stamp, one, other, force in forces]
    (found,) = pressed(seen, since_ns)
    assert (found.one, found.other, found.first_ns, found.most_n) == ("a", "b", first, most)
