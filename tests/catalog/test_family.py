"""A model of a family states its own figures over what its family's file says, and mistakes stay at their lines."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.compiler.catalog.load import CatalogDevice, load_device_folder
from cellc.contract.diagnostics import Outcome
from tests.cells import CORPUS

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
    assert loaded.value is not None
    return loaded.value


def test_model_is_what_its_family_is_under_its_own_name(folder: Path) -> None:
    alone = load_device_folder(ARM, ARM).value
    assert alone is not None
    named = alone.model.model_copy(update={"family": "both", "model": "long_arm"})
    assert _model(folder).model == named


def test_family_may_stand_beside_the_model(folder: Path) -> None:
    (folder.parents[1] / FAMILY).rename(folder / "both.family.yaml")
    assert _model(folder).model.model == "long_arm"


def test_mappings_merge_by_key_and_all_else_is_replaced(folder: Path) -> None:
    before = _model(folder).model
    _write(folder, "limits: {payload: {value: 7 kg, source: a sheet}}\nsources: [a sheet]\nhome: null\n")
    after = _model(folder).model
    assert after.limits.payload is not None
    assert after.limits.payload.value.si == 7.0
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
    assert [(one.span.file, one.span.line) for one in found] == [
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
