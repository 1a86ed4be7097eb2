"""What says the same in other words is no change, and nothing that differs is passed over."""

from __future__ import annotations

import json
import re
from pathlib import Path

import yaml

from cellc.tools.review.facts import facts_of
from cellc.tools.review.sides import Package, Side, packages
from tests.cells import generated
from tests.review.edits import changes_between
from tests.review.revisions import changes_of, edited, reviewed, told


def _package(path: Path, name: str = "after") -> Package:
    with packages(Side(name, path.as_posix())) as ((package, _),):
        return package


def _configuration(package: Package) -> str:
    return str(json.loads(package.files["contract.json"])["configuration_id"])


def _turned(value: object) -> object:
    if not isinstance(value, dict):
        return value
    return {key: _turned(inner) for key, inner in reversed(list(value.items()))}


def test_comments_order_and_spelling_of_units_say_nothing(tmp_path: Path, main: Package) -> None:
    text = edited(
        ("0 0 162 mm", "0 0 0.162 m"),
        ("mass: 1.0 kg, center_of_mass: 0 0 58 mm", "mass: 1000 g, center_of_mass: 0 0 5.8 cm"),
        (
            "0 -90 90 -90 -90 0 deg",
            "0 -1.5707963267948966 1.5707963267948966 -1.5707963267948966 -1.5707963267948966 0 rad",
        ),
        ("timeout: 90 s", "timeout: 90000 ms"),
        ("max_delta: 5 deg, velocity: 5 deg/s, timeout: 5 s", "max_delta: 5 deg, velocity: 5 deg/s, timeout: 5000 ms"),
        ("update_rate: 500 Hz", "update_rate: 0.5 kHz"),
    )
    bare = yaml.load(re.sub(r"(?m)\s#.*$", "", text), Loader=yaml.BaseLoader)
    spec = tmp_path / "cell.yaml"
    turned = yaml.safe_dump(_turned(bare), sort_keys=False, allow_unicode=True)
    # BaseLoader read all as text: whole numbers and truth values lose their quotes again.
    spec.write_text(re.sub(r"'(\d+|true|false)'", r"\1", turned), encoding="utf-8")
    after = _package(spec)
    assert changes_of(main, after) == []
    assert reviewed(main, after).files != ()
    assert _configuration(after) == _configuration(main)


def test_a_spec_and_what_was_generated_of_it_are_the_same(main: Package) -> None:
    folder = _package(generated("ur5e_pick"), "folder")
    assert changes_of(main, folder) == []
    assert changes_of(folder, main) == []


def test_a_folder_from_before_the_cell_was_hashed_is_the_same_but_for_its_id(main: Package) -> None:
    older = dict(main.files)
    own = _configuration(main)
    for path in ("contract.json", "manifest.json"):
        text = re.sub(r',\s*"cell_sha256": "[0-9a-f]{64}"', "", older[path])
        older[path] = text.replace(own, "cfg-0123456789ab")
    assert "cell_sha256" not in older["manifest.json"]
    assert changes_between(facts_of(older), main.facts) == ()
    assert changes_between(main.facts, facts_of(older)) == ()


def test_an_edit_by_hand_is_told_wherever_it_is(main: Package) -> None:
    folder = _package(generated("ur5e_pick"), "folder")
    for path, old, new, expected in (
        ("launch/cell.launch.xml", 'output="both"', 'output="log"', "review start order"),
        ("scripts/bring_up", "import sys", "import os", "review start order"),
        (
            "security/policy.xml",
            "<topic>/pipeline_state</topic>",
            "<topic>/all</topic>",
            "review network | /move_group",
        ),
        (
            "security/common.xml",
            "<topic>/display_planned_path",
            "<topic>/all",
            "review network | /commissioning, /people",
        ),
        ("gates/promotion.md", "Check that no person and no loose", "Check that a person and no loose", "review gates"),
        ("README.md", "generated from the spec", "not generated from the spec", "review documents"),
        ("graph/responsibility.svg", "<svg ", "<svg onload='' ", "review documents"),
        ("config/bring_up.json", '"phase": "claim"', '"phase": "start"', "dangerous start order"),
        (
            "config/controllers.yaml",
            "enforce_command_limits: false",
            "enforce_command_limits: true",
            "dangerous limits",
        ),
        ("config/drivers.yaml", "enable_depth: true", "enable_depth: false", "review devices"),
        ("urdf/ur5e_pick.mock.urdf", "mock_components/GenericSystem", "ur/Real", "dangerous control"),
        ("urdf/ur5e_pick.real.urdf", '<mass value="4"/>', '<mass value="5"/>', "review model"),
        ("config/moveit/ur5e_pick.srdf", 'tip_link="tcp"', 'tip_link="world"', "review motion"),
        ("package.xml", "<version>", "<version> ", ""),
    ):
        text = folder.files[path]
        assert old in text, (path, old)
        facts = facts_of({**folder.files, path: text.replace(old, new)})
        found = [told(change) for change in changes_between(folder.facts, facts)]
        assert [finding.startswith(expected) for finding in found] == ([True] if expected else []), (path, found)


def test_a_mount_that_moves_by_a_millimetre_changes_few_files_and_lines(tmp_path: Path, main: Package) -> None:
    spec = tmp_path / "cell.yaml"
    spec.write_text(edited(("mount: {parent: arm/tool0, xyz: 0 0 11 mm", "mount: {parent: arm/tool0, xyz: 0 0 12 mm")))
    after = _package(spec)
    differing = [path for path in after.files if after.files[path] != main.files[path]]
    lines = sum(len(set(after.files[path].split("\n")) - set(main.files[path].split("\n"))) for path in differing)
    assert len(differing) <= 8
    assert (
        lines <= 20
    )  # two of the description for the simulator, three of them of the scene: the body, and two loops that carry it
    mounted, told, *moved = changes_of(main, after)
    assert mounted == (
        "dangerous calibration | gripper_base_link | pose in its parent | xyz 0 0 11 mm, rpy 0 0 90 deg -> "
        "xyz 0 0 12 mm, rpy 0 0 90 deg | moves 1 mm"
    )
    assert told.startswith("dangerous payload | arm | robot TCP xyz | 0.00 0.00 173.00 mm")
    assert "-> 0.00 0.00 174.00 mm" in told
    assert moved == [
        "review motion | manipulator in home | tip | xyz 491.9 133.3 1114.9 mm, rpy 180 0 180 deg -> "
        "xyz 491.9 133.3 1113.9 mm, rpy 180 0 180 deg | moves 1 mm",
    ]
