"""Files of devices: families, names that a device of the user gives, and the reference of every key."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import BaseModel

from cellc.compiler.catalog import catalog_model, device_model
from cellc.compiler.catalog.catalog_model import CatalogModel, said_of
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.device_schema import device_reference, device_schema
from cellc.compiler.catalog.load import CatalogDevice, load_device_folder
from cellc.compiler.spec.place import keys_in_order
from cellc.contract.diagnostics import Outcome
from tests.cells import CORPUS, ROOT, there
from tests.cli.run import run

PARTS = ROOT / "tests/corpus/valid/parts"


@pytest.mark.parametrize(
    ("device", "old", "new", "message"),
    [
        ("demo_camera", "qos: default", "qos: nobody", "the catalog has no QoS profile `nobody`"),
        ("demo_camera", "info_qos: default", "info_qos: nobody", "the catalog has no QoS profile `nobody`"),
        ("demo_camera", "optical_frames: [color_optical]", "optical_frames: [nobody]", "no link `nobody`"),
        ("demo_camera", "frame: color_optical\n", "frame: nobody\n", "the description has no link `nobody`"),
        ("demo_gripper", "jerk: {finger_joint", "jerk: {nobody", "the description has no joint `nobody`"),
        ("demo_gripper", "acceleration: {finger_joint", "acceleration: {nobody", "no joint `nobody`"),
        ("demo_gripper", "  joint: finger_joint", "  joint: nobody", "the description has no joint `nobody`"),
        ("demo_arm", '  joints: {"*": {', "  joints: {nobody: {", "the description has no joint `nobody`"),
        ("demo_arm", "tool_frame: tool0", "tool_frame: nobody", "the description has no link `nobody`"),
        (
            "demo_gripper",
            "gripper:\n",
            "services: [{name: /open, type: std_srvs/srv/Trigger, server: nobody}]\ngripper:\n",
            "the device has no node `nobody`",
        ),
    ],
)
def test_name_of_nothing_is_found_at_its_line(device: str, old: str, new: str, message: str, tmp_path: Path) -> None:
    folder = tmp_path / device
    shutil.copytree(PARTS / device, folder)
    text = (folder / "device.yaml").read_text(encoding="utf-8")
    assert old in text
    changed = text.replace(old, new, 1)
    (folder / "device.yaml").write_text(changed, encoding="utf-8")
    loaded = load_device_folder(folder, tmp_path)
    assert loaded.value is None
    (found,) = loaded.diagnostics
    assert (found.code, found.message.endswith(message)) == ("catalog-entry-invalid", True)
    assert "nobody" in changed.splitlines()[found.span.line - 1]


@pytest.mark.parametrize(
    ("device", "old", "new", "message"),
    [
        (
            "demo_arm",
            "{command: [position,",
            "{command: [postion,",
            "the standard of ros2_control has no interface `postion`",
        ),
        ("demo_arm", "state: [position, velocity]}}", "state: [position, velocty]}}", "has no interface `velocty`"),
        (
            "demo_arm",
            "initial: {speed_scaling_factor",
            "initial: {speed_scaling",
            "the gpio has no interface `speed_scaling`",
        ),
        (
            "demo_arm",
            "tool_frame:",
            "home: {joint_1: 400 deg}\ntool_frame:",
            "must lie from -6.28319 to 6.28319, got 6.98132",
        ),
    ],
)
def test_slip_in_an_interface_and_home_past_a_limit_are_found_at_their_line(
    device: str, old: str, new: str, message: str, tmp_path: Path
) -> None:
    folder = tmp_path / device
    shutil.copytree(PARTS / device, folder)
    text = (folder / "device.yaml").read_text(encoding="utf-8")
    assert old in text
    changed = text.replace(old, new, 1)
    (folder / "device.yaml").write_text(changed, encoding="utf-8")
    (found,) = load_device_folder(folder, tmp_path).diagnostics
    assert found.code == "catalog-entry-invalid"
    assert message in found.message
    assert new.split("\n")[0] in changed.splitlines()[found.span.line - 1]


def test_interface_that_is_no_slip_of_a_standard_one_is_a_vendors_own(tmp_path: Path) -> None:
    folder = tmp_path / "demo_arm"
    shutil.copytree(PARTS / "demo_arm", folder)
    file = folder / "device.yaml"
    own = file.read_text(encoding="utf-8").replace(
        "{command: [position,", "{command: [torque_offset, position_2nd_encoder,", 1
    )
    file.write_text(own, encoding="utf-8")
    assert load_device_folder(folder, tmp_path).diagnostics == ()


@pytest.mark.parametrize(
    ("device", "old", "new", "message"),
    [
        ("stage", "slide: {value: 5 m/s^2", "slide: {value: 5 rad/s^2", "in `m/s^2`, got 5 rad/s^2"),
        ("stage", "turn: {value: 50 rad/s^3", "turn: {value: 50 m/s^3", "in `rad/s^3`, got 50 m/s^3"),
        ("lift", "slide: {value: 20 m/s^3, source: made up}, ", "", "`jerk` of `slide`, which is prismatic, must be"),
        ("demo_gripper", "closed: 40 mm", "closed: 2 deg", "`closed` of `finger_joint`, which is prismatic, must be"),
    ],
)
def test_figure_of_another_unit_than_its_joint_is_found_at_its_line(
    device: str, old: str, new: str, message: str, tmp_path: Path
) -> None:
    shutil.copytree(PARTS / device, tmp_path / device)
    file = tmp_path / device / "device.yaml"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    (found,) = load_device_folder(tmp_path / device, tmp_path).diagnostics
    assert message in found.message
    assert found.span.line == text[: text.index(old)].count("\n") + 1


@pytest.mark.parametrize(
    ("old", "new", "message", "help_text"),
    [
        ("kind: arm", "kind: arn", "`kind` must be one of its choices, got the text `arn`", "did you mean `arm`?"),
        ("base: rail", "base: 3", "expected text for `base`, got the number `3`", 'put it in quotes: `"3"`'),
        ("{file: lift.urdf}", "lift.urdf", "expected a mapping for `description`", "write a mapping"),
        ("as_of: 2026-07-01", "as_of: July", "`July` cannot be used as `as_of`", "write the day as `2026-07-01`"),
        ("model: lift", "model: my lift", "`my lift` cannot be used as `model`", "use letters, digits and `_`"),
        ("slide: {value: 2 m/s^2", "slide: {value: 2 kg", "`kg` is not a unit of", "write a number and the unit"),
    ],
)
def test_wrong_value_is_told_in_the_words_of_the_spec(
    old: str, new: str, message: str, help_text: str, tmp_path: Path
) -> None:
    shutil.copytree(PARTS / "lift", tmp_path / "lift")
    file = tmp_path / "lift" / "device.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    (found,) = load_device_folder(tmp_path / "lift", tmp_path).diagnostics
    assert found.message.startswith(message)
    assert found.help.startswith(help_text)


ARM = CORPUS / "valid/parts/demo_arm"
FAMILY = "arms/both.family.yaml"


@pytest.fixture(name="folder")
def folder_fixture(tmp_path: Path) -> Path:
    """Return the folder of a model; its family's file stands above it, as beside other models of a vendor."""
    folder = tmp_path / "arms" / "long"
    shutil.copytree(ARM, folder)
    text = (folder / "device.yaml").read_text(encoding="utf-8").replace("model: demo_arm", 'model: "{model}"')
    (tmp_path / FAMILY).write_text(text, encoding="utf-8")
    _write(folder, "")
    return folder


def _write(folder: Path, more: str, head: str = "family: both\nmodel: long_arm\n") -> None:
    (folder / "device.yaml").write_text(head + more, encoding="utf-8")


def _load(folder: Path) -> Outcome[CatalogDevice]:
    return load_device_folder(folder, folder.parents[1])


def _model(folder: Path) -> CatalogDevice:
    loaded = _load(folder)
    assert loaded.diagnostics == ()
    return there(loaded.value)


def test_model_is_what_its_family_is_under_its_own_name(folder: Path) -> None:
    alone = there(load_device_folder(ARM, ARM).value)
    named = alone.model.model_copy(update={"family": "both", "model": "long_arm"})
    assert _model(folder).model == named


def test_family_may_stand_beside_the_model(folder: Path) -> None:
    (folder.parents[1] / FAMILY).rename(folder / "both.family.yaml")
    assert _model(folder).model.model == "long_arm"


def test_mappings_merge_by_key_and_all_else_is_replaced(folder: Path) -> None:
    before = _model(folder).model
    _write(folder, "limits: {payload: {value: 7 kg, source: a sheet}}\nsources: [a sheet]\nhome: null\n")
    after = _model(folder).model
    assert there(after.limits.payload).value.si == 7.0
    assert after.limits.acceleration == before.limits.acceleration != {}
    assert (after.sources, after.home) == (("a sheet",), None)


def test_null_takes_a_key_of_the_family_away_at_any_depth(folder: Path) -> None:
    assert _model(folder).model.limits.acceleration
    _write(folder, "limits: {acceleration: null}\n")
    assert _model(folder).model.limits.acceleration == {}


def test_mistake_is_at_the_line_of_the_file_that_makes_it(folder: Path) -> None:
    family = folder.parents[1] / FAMILY
    lines = family.read_text(encoding="utf-8").splitlines()
    number = next(place for place, line in enumerate(lines, 1) if line.startswith("base:"))
    family.write_text("\n".join([*lines[: number - 1], "base: nobody", *lines[number:]]) + "\n", encoding="utf-8")
    _write(folder, "summary: 3\nlimits: {payload: {value: 7 m, source: a sheet}}\n")
    found = _load(folder).diagnostics
    assert [(finding.span.file, finding.span.line) for finding in found] == [
        ((folder / "device.yaml").as_posix(), 3 + n) for n in (0, 1)
    ]
    _write(folder, "")
    (in_family,) = _load(folder).diagnostics
    assert (in_family.span.file, in_family.span.line) == (family.as_posix(), number)


@pytest.mark.parametrize("named", ["nobody", "../both", "3", "[both]", '""'])
def test_family_that_is_not_there_is_said_at_its_name(named: str, folder: Path) -> None:
    _write(folder, "", f"family: {named}\nmodel: long_arm\n")
    (found,) = _load(folder).diagnostics
    assert found.code == "catalog-entry-invalid"
    assert found.message.startswith("`family` must name a `FAMILY.family.yaml` beside this file or in the folder above")
    assert (found.span.line, found.span.column) == (1, 9 if not named.startswith("[") else 1)


def test_family_outside_the_folder_of_the_spec_is_not_read(folder: Path) -> None:
    (found,) = load_device_folder(folder, folder).diagnostics
    assert found.yaml_path == ("family",)


PAGE = (ROOT / "docs" / "device.md").read_text(encoding="utf-8")
SCHEMA = json.loads(device_schema())
OBJECTS = {"DeviceModel": SCHEMA, **{name: one for name, one in SCHEMA["$defs"].items() if "properties" in one}}


def test_committed_page_and_schema_are_those_of_the_models() -> None:
    # Written by `cellc schema device --reference > docs/device.md` and `cellc schema -o schemas`.
    assert device_reference() == PAGE
    assert device_schema() == (ROOT / "schemas" / "device.schema.json").read_text(encoding="utf-8")


def test_every_key_has_a_meaning_that_is_a_sentence() -> None:
    told = {(model, key): field for model, one in OBJECTS.items() for key, field in one["properties"].items()}
    assert len(told) > 390
    wrong = {key for key, field in told.items() if not re.match(r"[`A-Z].*\.$", field.get("description", ""))}
    assert wrong == set()


def test_every_model_has_a_summary_without_its_keys() -> None:
    assert {model for model, one in OBJECTS.items() if not one["description"].endswith(".")} == set()
    assert {model for model, one in OBJECTS.items() if "Attributes" in one["description"]} == set()


def test_a_quantity_names_its_units() -> None:
    told = (field for one in OBJECTS.values() for field in one["properties"].values() if "x-units" in json.dumps(field))
    assert all(" Units: " in field["description"] for field in told)


def test_no_meaning_is_that_of_a_key_that_is_gone() -> None:
    stated = re.compile(r"^ {4}(\w+): ", re.MULTILINE)
    for model in _subclasses(CatalogModel):
        lines = stated.findall((model.__doc__ or "").replace("\n    ", "\n").partition("Attributes:")[2])
        assert set(lines) <= set(model.model_fields), model.__name__


def test_a_key_of_a_base_has_its_meaning_there() -> None:
    from cellc.compiler.catalog.limit_facts import VelocityLimit

    assert said_of(VelocityLimit, "source").startswith("Document with its version")
    assert said_of(VelocityLimit, "sourc") == ""


def test_every_key_stands_on_the_page_and_every_link_leads_to_one_heading() -> None:
    keys = {key for one in OBJECTS.values() for key in one["properties"]}
    assert {key for key in keys if f"`{key}`" not in PAGE} == set()
    headings = [_anchor(line) for line in re.findall(r"^#+ (.+)$", PAGE, re.MULTILINE)]
    assert len(headings) == len(set(headings))
    assert set(re.findall(r"\]\(#([^)]+)\)", PAGE)) <= set(headings)


def _anchor(heading: str) -> str:
    return re.sub(r"[^a-z0-9 _-]", "", heading.lower()).replace(" ", "-")


def test_the_command_prints_the_page_and_refuses_one_that_there_is_not() -> None:
    assert run("schema", "device", "--reference").out == PAGE
    refused = run("schema", "fleet", "--reference")
    assert refused.code == 2
    assert "there is no reference of `fleet`; there are those of cell and device" in refused.err


def test_no_docstring_is_read_where_a_device_is(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> str:
        raise AssertionError("a check pays for the reference")

    for name in ("said_of", "summary_of"):
        monkeypatch.setattr(catalog_model, name, never)
    for model in _subclasses(CatalogModel):
        model.model_rebuild(force=True)
    assert "device_schema" not in vars(device_model)
    assert keys_in_order(DeviceModel)[0] == "format"


def _subclasses(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
    for one in model.__subclasses__():
        if one.__module__.startswith("cellc."):
            yield one
            yield from _subclasses(one)
