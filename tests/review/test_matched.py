"""What is one thing is told as one: a step by what it does, a box by its room, an arm by where it stands."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from cellc.compiler.catalog.compiled import CATALOG
from cellc.compiler.pipeline import check
from cellc.contract.printing import as_text
from cellc.contract.review import Review, ReviewChange
from cellc.contract.vocabulary import Grade
from cellc.tools.review.groups import groups_of
from cellc.tools.review.leaves import Leaves, Prose
from cellc.tools.review.review import review
from cellc.tools.review.short import MOST_LINES, render_short
from cellc.tools.review.sides import Package, package_of
from cellc.tools.review.steps import with_step_names
from cellc.tools.review.units import difference
from tests.cells import spec_of, spec_text
from tests.review.edits import review_of
from tests.review.revisions import Edit, edited


def _change(found: Review, quantity: str) -> ReviewChange:
    (change,) = [change for change in found.changes if change.quantity == quantity]
    return change


def _titles(found: Review) -> list[str]:
    return [re.sub(r" \(.*", "", f"{group.grade} {group.title}") for group in groups_of(found)]


_SECOND_HOST: tuple[Edit, ...] = (
    (
        "network: {domain_id: 42, discovery: localhost}",
        "network: {domain_id: 42, discovery: unicast, peers: [10.20.0.10, 10.20.0.11]}",
    ),
    ("connection: {host: control_pc, nic: bulk}", "connection: {host: vision_pc, nic: bulk}"),
    ("lifecycle: true, host: control_pc, owner", "lifecycle: true, host: vision_pc, owner"),
    ("independent_of: [control_pc]", "independent_of: [control_pc, vision_pc]"),
)


def test_a_step_of_the_bring_up_is_what_it_does_and_not_its_name() -> None:
    bulk = re.search(r" *bulk: .*\n", edited())
    assert bulk is not None
    second = (
        "      cell: {address: 10.20.0.10/24, carries: [ros]}\n"
        "  vision_pc:\n"
        "    scheduling: generic\n"
        "    clock: {domain: ros, synchronized_by: chrony, max_offset: 1 ms}\n"
        f"    nics:\n{bulk[0]}"
        "      cell: {address: 10.20.0.11/24, carries: [ros]}\n"
    )
    found = review_of("ur5e_pick", *_SECOND_HOST, (bulk[0], second))
    assert found.worst() is Grade.REVIEW
    called = _change(found, "what the step is called")
    assert (called.before, called.after) == ("compare_versions", "compare_versions_on_control_pc")
    moved = _change(found, "computer that it is connected to")
    assert (moved.subjects, moved.before, moved.after) == (("camera",), "control_pc", "vision_pc")
    lines = as_text(render_short(found), color=False).splitlines()
    assert lines[3].startswith("review  hosts.vision_pc added (cell.yaml:22) and 4 lines (cell.yaml:")
    assert "not classified" not in "".join(lines[4:9])
    assert len(lines) <= MOST_LINES


def _step(name: str, **values: str | tuple[str, ...]) -> Leaves:
    return {("step", "real", name, *key.split("__")): leaf for key, leaf in values.items()}


def test_a_step_that_asks_for_another_kind_of_thing_is_another_step() -> None:
    was = _step("one", phase="start", request__kind="versions", proof=("a", "b"))
    other = _step("two", phase="start", request__kind="controllers", proof=("a", "b"))
    assert with_step_names(was, other) == was
    same = _step("two", phase="start", request__kind="versions", proof=("a", "b"))
    assert with_step_names(was, same) == same


@pytest.mark.parametrize(
    ("box", "grade", "told"),
    [
        ("xyz: 330 0 780 mm, box: 940 1200 40 mm", Grade.REVIEW, "gains 40 mm at -x"),
        ("xyz: 330 0 780 mm, box: 900 1200 40 mm", Grade.DANGEROUS, ""),
        ("xyz: 350 0 770 mm, box: 900 1200 20 mm", Grade.DANGEROUS, "loses 20 mm at the top"),
    ],
)
def test_place_and_size_of_an_obstacle_are_graded_by_its_room(box: str, grade: Grade, told: str) -> None:
    found = review_of("ur5e_pick", ("xyz: 350 0 780 mm, box: 900 1200 40 mm", box))
    assert _change(found, "pose in its parent").grade is grade
    assert found.worst() is grade
    if told:
        assert _change(found, "collision shapes").delta == told
        (title,) = _titles(found)
        assert title == f"{grade} scene.table"


def test_a_shared_area_says_what_it_loses_and_gains_on_each_side() -> None:
    found = review_of("dual_ur", ("xyz: 0 0 250 mm, box: 500 400 500 mm", "xyz: 0 0 220 mm, box: 600 400 440 mm"))
    size = _change(found, "size of the shared area")
    assert (size.grade, size.delta) == (Grade.DANGEROUS, "loses 60 mm at the top, gains 50 mm on each side in x")
    assert _titles(found) == ["dangerous areas.over_nest"]


@pytest.mark.parametrize(
    ("area", "grade"),
    [
        ("xyz: 0 0 250 mm, box: 700 600 500 mm", Grade.REVIEW),  # apart in more room
        ("xyz: 0 0 275 mm, box: 500 400 550 mm", Grade.REVIEW),  # from the bottom as before to 550 mm
        ("xyz: 0 0 250 mm, box: 500 400 400 mm", Grade.DANGEROUS),
        ("xyz: 0 100 250 mm, box: 500 400 500 mm", Grade.DANGEROUS),
        ("xyz: 0 0 250 mm, released: hand-over at 50 mm/s, box: 500 400 500 mm", Grade.DANGEROUS),
    ],
)
def test_a_shared_area_is_graded_by_where_arms_may_meet(area: str, grade: Grade) -> None:
    found = review_of("dual_ur", ("xyz: 0 0 250 mm, box: 500 400 500 mm", area))
    assert found.worst() is grade
    assert all(change.why for change in found.changes if change.area == "safety")


@pytest.mark.parametrize(("box", "grade"), [("600 400 500 mm", Grade.DANGEROUS), ("400 400 500 mm", Grade.REVIEW)])
def test_of_a_released_area_a_larger_one_is_dangerous(box: str, grade: Grade) -> None:
    area = "xyz: 0 0 250 mm, box: 500 400 500 mm, granted_by: safety_plc"
    released = edited((area, f"{area}, released: hand-over at 50 mm/s"), cell="dual_ur")
    file = spec_of("dual_ur").as_posix()
    was, now = (check(file, {file: text}) for text in (released, released.replace("500 400 500 mm", box)))
    (change,) = review(package_of("was", was), package_of("now", now)).changes
    assert change.grade is grade


def test_another_alternative_is_one_cause() -> None:
    found = review_of("ur5e_pick", ("{open: {person: integration, date: 2026-12-15}}", "{none: checked on site}"))
    assert _titles(found) == [
        "review surroundings.fittings: {open: {person: integration, date: 2026-12-15}} -> {none: checked on site}"
    ]


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("1.0 kg", "800 g", "-20 %"),
        ("1.0 kg", "1000 g", "+0 %"),
        ("-5 5 46 mm", "5 -5 46 mm", "moves 14.1 mm"),
        ("0 0 46 mm", "0 0 0.05 m", "moves 4 mm"),
        ("1.0 kg", "800 mm", ""),
        ("0 kg", "800 g", "+0.8 kg"),
        ("10 deg", "-5 deg", "-15 deg"),
        ("0 %", "10 %", ""),
    ],
)
def test_quantities_in_other_units_have_a_difference(before: str, after: str, told: str) -> None:
    assert difference(Prose(before), Prose(after), "") == told


def _on_own_axis(folder: Path, *edits: tuple[str, str, str]) -> Package:
    """Return the cell with the axis in a folder of its own, edited."""
    shutil.copytree(CATALOG / "devices" / "linear_axis", folder / "devices" / "linear_axis")
    shutil.copy(CATALOG / "devices" / "shapes.xacro", folder / "devices")
    spec = folder / "cell.yaml"
    spec.write_text(spec_text("rail_arm").replace("model: linear_axis", "model: ./devices/linear_axis"), "utf-8")
    for file, old, new in edits:
        place = folder / "devices" / "linear_axis" / file
        text = place.read_text("utf-8")
        assert text.count(old) == 1
        place.write_text(text.replace(old, new), "utf-8")
    return package_of("after", check(spec.as_posix()))


def test_lines_of_the_folder_of_a_device_cause_what_they_change_and_an_arm_that_stands_elsewhere_asks_safety(
    tmp_path: Path,
) -> None:
    before = _on_own_axis(tmp_path / "before")
    faster = ("device.yaml", "value: 2 m/s^2", "value: 3 m/s^2")
    after = _on_own_axis(tmp_path / "after", faster, ("linear_axis.urdf.xacro", 'value="0.12"', 'value="0.10"'))
    found = review(before, after)
    lower, quicker = groups_of(found)
    assert re.fullmatch(
        r"devices/linear_axis/linear_axis\.urdf\.xacro top: 0\.12 -> 0\.10 \(linear_axis\.urdf\.xacro:\d+\)",
        lower.title,
    )
    assert re.fullmatch(
        r"devices/linear_axis/device\.yaml limits\.acceleration\.\*: 2 m/s\^2 -> 3 m/s\^2 \(device\.yaml:\d+\)",
        quicker.title,
    )
    base = _change(found, "base in the root frame")
    assert (base.subjects, base.grade, base.approval, base.delta) == (
        ("arm_base_link",),
        Grade.DANGEROUS,
        "safety",
        "moves 20 mm",
    )
    assert [change.quantity for change in quicker.changes] == ["acceleration"]


def test_a_file_that_a_description_includes_from_outside_of_its_folder_is_named(tmp_path: Path) -> None:
    inertia = ("../shapes.xacro", "${mass * (y**2 + z**2) / 12}", "${mass * (y**2 + z**2) / 6}")
    found = review(_on_own_axis(tmp_path / "before"), _on_own_axis(tmp_path / "after", inertia))
    (group,) = groups_of(found)
    assert group.title.startswith("devices/shapes.xacro inertia ixx: ${mass * (y**2 + z**2) / 12} -> ")
    assert {change.quantity for change in group.changes} == {"inertia ixx"}


def test_texts_of_the_folder_of_a_device_cause_nothing(tmp_path: Path) -> None:
    before = _on_own_axis(tmp_path / "before")
    after = _on_own_axis(tmp_path / "after", ("device.yaml", "summary: carriage", "summary: a carriage"))
    assert not review(before, after).causes
