"""``cellc catalog``: devices are found by what is known of them, and each has a page with a picture."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from cellc.compiler.catalog.load import CatalogDevice, controller_kinds, device_names, load_controller_kind, load_device
from cellc.tools.browse.controllers import controllers_page
from cellc.tools.browse.page import page, pages, picture
from cellc.tools.browse.search import Wanted, answered, answers
from tests.cells import ROOT
from tests.cli.run import run

_SVG = "{http://www.w3.org/2000/svg}"


def _entry(name: str) -> CatalogDevice:
    entry = load_device(name).value
    assert entry is not None
    return entry


def _models(*arguments: str) -> list[str]:
    ran = run("catalog", *arguments)
    assert ran.code == 0, ran.err
    return [line.split()[0] for line in ran.out.splitlines()[1:] if not line.startswith(("no, ", "not known, "))]


def test_committed_pages_are_those_of_the_catalog() -> None:
    folder = ROOT / "docs" / "catalog"
    written = {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir()}
    assert written == pages(), "run `cellc catalog --all -o docs/catalog` and commit it"


def test_without_a_wish_every_device_is_listed() -> None:
    assert _models() == list(device_names())


def test_words_are_looked_for_in_model_vendor_driver_and_summary() -> None:
    assert _models("libfranka") == ["franka_fr3", "franka_hand"]
    assert _models("adaptive", "robotiq") != []
    assert set(_models("gripper")) >= {"franka_hand", "pneumatic_gripper", "robotiq_2f_85"}


def test_arms_are_found_by_what_their_vendors_say_of_reach_and_payload() -> None:
    # Franka Robotics, FR3 datasheet: 855 mm, 3 kg. Universal Robots, UR5e technical specification: 850 mm, 5 kg.
    assert {"franka_fr3", "ur5e"} <= set(_models("--reach", "850 mm"))
    assert "ur5e" not in _models("--reach", "0.851 m")
    assert "franka_fr3" not in _models("--payload", "4 kg")
    assert "ur5e" in _models("--payload", "5000 g")


def test_reach_and_payload_are_answered_with_yes_no_and_not_known() -> None:
    """Kinova and OpenArm state no reach of these: that is neither yes nor no, and a camera is not asked."""
    *_, unknown, small = run("catalog", "--reach", "900 mm").out.splitlines()
    assert unknown.startswith("not known, no figure is stated: kinova_gen3, ")
    assert "openarm_v2_left" in unknown
    assert small == "no, too small: franka_fr3, ur3e, ur5e, ur7e"
    stated = {name for name in device_names() if _entry(name).model.kind == "arm"}
    said = {name for line in (unknown, small) for name in line.partition(": ")[2].split(", ")}
    assert said | set(_models("--reach", "900 mm")) == stated


def test_list_fits_a_terminal() -> None:
    wanted = Wanted()
    for columns in (100, 120, 160):
        lines = [line if isinstance(line, str) else str(line[0]) for line in answered(answers(wanted), wanted, columns)]
        shown = [line for line in lines if not line.startswith("Styled")]
        assert max(map(len, shown)) <= max(columns, 110)
    assert any("six-joint arm, 5 kg payload" in line for line in shown)


def test_devices_are_found_by_kind_and_distribution() -> None:
    assert "realsense_d435i" in _models("--kind", "camera")
    assert "ur5e" not in _models("--kind", "camera")
    # rosdistro: franka_ros2 is not released for Lyrical.
    assert "franka_fr3" not in _models("--ros", "lyrical")
    assert "ur5e" in _models("--ros", "lyrical")


def test_what_nobody_answers_says_so_and_what_else_to_do() -> None:
    ran = run("catalog", "--reach", "90 m")
    assert ran.code == 1
    assert "cellc import" in ran.err


@pytest.mark.parametrize("wrong", [("--reach", "900"), ("--payload", "5 mm"), ("--all",), ("-o", "somewhere")])
def test_wrong_question_is_a_usage_error(wrong: tuple[str, ...]) -> None:
    assert run("catalog", *wrong).code == 2


@pytest.mark.parametrize("name", device_names())
def test_picture_names_each_frame_in_both_views(name: str) -> None:
    entry = _entry(name)
    root = ElementTree.fromstring(picture(entry))
    views = root.findall(f"{_SVG}g")
    assert len(views) == 2
    for view in views:
        said = {part.strip() for text in view.iter(f"{_SVG}text") for part in (text.text or "").split(",")}
        assert set(entry.model.frames) <= said


def test_page_of_an_arm_says_what_its_activation_moves() -> None:
    text = page(_entry("robotiq_2f_85"))
    row = next(line for line in text.splitlines() if line.startswith("| activate |"))
    assert "| moves |" in row
    assert run("catalog", "robotiq_2f_85").out == text


@pytest.mark.parametrize("name", [name for name in device_names() if _entry(name).model.switched])
def test_page_of_a_switched_device_has_its_states_outputs_and_sensors(name: str) -> None:
    entry = _entry(name)
    switched = entry.model.switched
    assert switched is not None
    (section,) = (part for part in page(entry).split("\n## ") if part.startswith("States\n"))
    rows = {row.split("|")[1].strip(" `"): row for row in section.splitlines() if row.startswith("| `")}
    assert list(rows) == list(switched.states)
    for state, levels in switched.states.items():
        for signal, level in {**levels.outputs, **levels.sensors}.items():
            assert f"`{signal}` {'on' if level else 'off'}" in rows[state]
        assert ("holds" in rows[state]) == (state == switched.holds)


@pytest.mark.parametrize("name", controller_kinds())
def test_page_of_the_controllers_has_every_parameter_of_every_kind(name: str) -> None:
    kind = load_controller_kind(name).value
    assert kind is not None
    (section,) = (part for part in controllers_page().split("\n## ") if part.startswith(f"`{name}`\n"))
    for parameter, facts in kind.parameters.items():
        (row,) = (line for line in section.splitlines() if line.startswith(f"| `{parameter}` |"))
        for bound in (facts.minimum, facts.exclusive_minimum, facts.maximum):
            assert bound is None or f"{bound:g}" in row
        assert all(f"`{word}`" in row for word in (*facts.one_of, *facts.subset_of))
        assert ("must be given" in row) == facts.required
    for use in kind.plugins.values():
        assert f"`{use.type}`" in section
