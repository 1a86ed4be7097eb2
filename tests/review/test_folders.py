"""Generated folders: other names are found without a spec, and what is not there is told with what writes it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.printing import as_text
from cellc.contract.review import Review
from cellc.tools.review.facts import facts_of
from cellc.tools.review.folder_names import facts_with_names, renames_between_folders
from cellc.tools.review.groups import groups_of
from cellc.tools.review.review import review
from cellc.tools.review.short import render_short
from cellc.tools.review.sides import Package, package_of
from tests.cells import spec_of, spec_text
from tests.cli.run import run
from tests.review.revisions import edited, new_repository


def _as_folder(name: str, text: str, cell: str) -> Package:
    """Return what is left of a cell where only its folder is there."""
    file = spec_of(cell).as_posix()
    checked = check(file, {file: text})
    assert checked.ok, [found.message for found in checked.diagnostics]
    package = package_of(name, checked)
    return replace(package, facts=facts_of(package.files), document=None, is_spec=False, findings=(), excused=())


@cache
def _before(cell: str) -> Package:
    return _as_folder("before", spec_text(cell), cell)


def _renamed(cell: str, names: Mapping[str, str], *edits: tuple[str, str]) -> Review:
    lines = spec_text(cell).split("\n")
    for old, new in names.items():
        word = re.compile(rf"(?<![\w-]){re.escape(old)}(?![\w-])")
        lines = [word.sub(new, code) + sign + rest for code, sign, rest in (line.partition("#") for line in lines)]
    text = "\n".join(lines)
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return review(_before(cell), _as_folder("after", text, cell))


def _titles(found: Review) -> list[str]:
    return [f"{group.grade} {group.title}" for group in groups_of(found)]


def test_a_frame_and_a_node_with_another_name_are_a_line_each() -> None:
    found = _renamed("ur5e_pick", {"fixture_A": "fixture_B", "task": "picker"})
    assert _titles(found) == [
        "review renamed: node task -> picker",
        "review renamed: TF frame fixture_A -> fixture_B (1 name follows)",
    ]
    assert [change.breaking for change in found.changes] == [False, True]


def test_a_device_takes_its_links_joints_and_controllers_with_it() -> None:
    # The link `arm_upper_arm_link` has the name of the device twice, of which one is the word for a limb.
    found = _renamed("ur5e_pick", {"arm": "robot"})
    assert _titles(found) == ["review renamed: device arm -> robot (27 names follow)"]


def test_what_else_changed_is_compared_under_the_new_names() -> None:
    edit = ("xyz: 450 100 850 mm", "xyz: 450 100 870 mm")
    found = _renamed("ur5e_pick", {"fixture_A": "fixture_B"}, edit)
    told = {(change.subjects[0], change.quantity): change.delta for change in found.changes}
    assert told["fixture_B", "pose in its parent"] == "moves 20 mm"
    assert not [change for change in found.changes if " added" in change.quantity or " removed" in change.quantity]


def test_another_part_is_none_that_was_renamed() -> None:
    before, after = _before("ur5e_pick").facts.contract, _before("fr3_hand").facts.contract
    assert "device" not in {rename.noun for rename in renames_between_folders(before, after)}


def test_a_folder_whose_names_make_no_package_is_compared_as_it_is() -> None:
    before, after = _before("ur5e_pick"), _before("minimal")
    renames = renames_between_folders(before.facts.contract, after.facts.contract)
    assert renames
    assert facts_with_names(replace(before, files={}), after, renames) is None


def test_one_change_that_is_left_is_told_and_more_of_one_area_by_what_they_are() -> None:
    text = spec_text("ur5e_pick").replace("summary: UR5e", "summary: The UR5e")
    found = review(_before("ur5e_pick"), _as_folder("after", text, "ur5e_pick"))
    lines = as_text(render_short(found), color=False).splitlines()
    assert [line for line in lines if line.startswith("  documents  summary UR5e with a Robotiq")]
    assert not [line for line in lines if "more: documents" in line]
    of_many = review(_before("ur5e_pick"), _before("minimal"))
    left = [
        line
        for line in as_text(render_short(of_many), color=False).splitlines()
        if re.match(r"  \d+ (more|chan)", line)
    ]
    assert not [line for line in left if re.search(r": (model|interfaces|documents) \d+$", line)]


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a repository with one cell and no generated folder."""
    repository = new_repository(tmp_path, "cells/minimal/cell.yaml")
    monkeypatch.chdir(repository.folder)
    return repository.folder


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("generated/minimal", "no file or folder `generated/minimal`; `cellc build SPEC` writes the folder of a cell"),
        (
            "generated/minimal cells/minimal/cell.yaml",
            "no file or folder `generated/minimal`; `cellc build cells/minimal/cell.yaml` writes the folder of a cell",
        ),
        ("cells/minimal", "it is not a generated folder; name `cells/minimal/cell.yaml`"),
        ("cells", "it is not a generated folder; name `cells/minimal/cell.yaml`"),
        ("main:cells/ cells/minimal/cell.yaml", "name `main:cells/minimal/cell.yaml`"),
        ("cells/minimal/cell.yaml nothing", "there is no file or folder `nothing`; `cellc build SPEC` writes"),
    ],
)
@pytest.mark.usefixtures("repository")
def test_what_is_not_there_is_told_with_what_writes_it(call: str, said: str) -> None:
    ran = run("diff", *call.split())
    assert (ran.code, said in ran.err) == (2, True), ran.err


def test_a_folder_that_is_not_committed_names_the_spec_to_compare(repository: Path) -> None:
    assert run("build", "cells/minimal/cell.yaml").code == 0
    ran = run("diff", "generated/minimal")
    assert ran.code == 2
    assert "where folders are not committed, compare specs: `cellc diff HEAD cells/minimal/cell.yaml`" in ran.err
    assert (repository / "generated/minimal").is_dir()


def test_a_spec_that_was_moved_names_where_it_was(repository: Path) -> None:
    (repository / "cells/minimal").rename(repository / "cells/bench")
    ran = run("diff", "cells/bench/cell.yaml")
    assert ran.code == 2
    command = "diff HEAD:cells/minimal/cell.yaml cells/bench/cell.yaml"
    assert f"has no `cells/bench/cell.yaml`, but `cells/minimal/cell.yaml`: `cellc {command}`" in ran.err
    assert run(*command.split()).out.startswith("cells/bench/cell.yaml: no change\n")
    (repository / "cells/bench/cell.yaml").write_text("cell: other\n", encoding="utf-8")
    assert "has no `cells/bench/cell.yaml`; it is new" in run("diff", "cells/bench/cell.yaml").err


def test_a_mass_stands_before_where_it_is_and_both_are_one_cause() -> None:
    old, new = (
        "payload: {mass: 1.0 kg, center_of_mass: 0 0 58 mm}",
        "payload: {mass: 1.4 kg, center_of_mass: 0 0 70 mm}",
    )
    file = spec_of("ur5e_pick").as_posix()
    before = package_of("before", check(file))
    found = review(before, package_of("after", check(file, {file: edited((old, new))})))
    (group,) = groups_of(found)
    assert group.title.startswith("devices.arm.payload (cell.yaml:")
    assert group.title.endswith("mass 1.0 kg -> 1.4 kg (+40 %), center_of_mass 0 0 58 mm -> 0 0 70 mm")
    assert [(change.quantity, change.delta) for change in group.changes] == [
        ("robot payload mass", "+40 %"),
        ("robot payload center of mass", "moves 12 mm"),
    ]


def test_a_payload_that_only_the_checklist_has_is_a_payload() -> None:
    text = spec_text("gen3_2f").replace("payload: {mass: 1.0 kg,", "payload: {mass: 1.1 kg,")
    found = review(_before("gen3_2f"), _as_folder("after", text, "gen3_2f"))
    (change,) = found.changes
    assert (change.grade, change.area, change.quantity, change.delta) == (
        "dangerous",
        "payload",
        "robot payload mass",
        "+10 %",
    )


def test_what_a_person_wrote_into_a_file_is_listed_whatever_other_changes_say() -> None:
    after = _as_folder("after", edited(("goal_time: 1 s", "goal_time: 2 s"), cell="minimal"), "minimal")
    file = next(path for path in after.files if path.startswith("launch/") and path.endswith(".xml"))
    # The line has no word but those of the value that changed.
    files = {**after.files, file: after.files[file].replace("</launch>", "  <!-- 2 -->\n</launch>")}
    assert files != after.files
    found = review(_before("minimal"), replace(after, files=files, facts=facts_of(files)))
    assert [change.after for change in found.changes if file in change.subjects] == ["<!-- 2 -->"]
    assert not [change for change in review(_before("minimal"), after).changes if file in change.subjects]
