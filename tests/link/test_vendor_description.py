"""The vendor's own description, where its package is at hand: its shapes are taken, its figures compared."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.robot.description.model import Box, Sphere
from cellc.robot.description.packages import on_package_path
from tests.cells import CORPUS, compiled, diagnose, linked, written

_BASE = CORPUS / "invalid" / "base"
_CELL = """format: 1
cell: vendored
versions: {ros: jazzy}
devices:
  arm: {model: ./NAME}
control:
  update_rate: 100 Hz
  controllers: {joint_states: {type: joint_state_broadcaster}}
"""


def _spec(folder: Path, name: str = "vendored_arm") -> Path:
    shutil.copytree(_BASE / name, folder / name)
    return written(folder, _CELL.replace("NAME", name))


def _shapes(spec: Path) -> list[type]:
    (device,) = linked(spec).devices
    return [type(collision.geometry) for link in device.body.description.links for collision in link.collisions]


def test_links_have_the_shapes_of_a_package_that_is_at_hand(tmp_path: Path) -> None:
    assert _shapes(_spec(tmp_path)) == [Sphere]


def test_without_the_package_the_shapes_of_the_catalog_serve_and_the_audit_says_so(tmp_path: Path) -> None:
    spec = _spec(tmp_path)
    shutil.rmtree(tmp_path / "vendored_arm" / "vendored_arm_description")
    assert _shapes(spec) == [Box]
    audit = compiled(spec).texts["audit.md"]
    assert "| arm | boxes and cylinders | `vendored_arm_description` is neither beside the spec" in audit


def test_package_is_found_on_the_package_path_and_every_target_has_its_shapes(tmp_path: Path) -> None:
    spec = _spec(tmp_path)
    beside = compiled(spec).texts
    (tmp_path / "elsewhere").mkdir()
    package = tmp_path / "vendored_arm" / "vendored_arm_description"
    package.rename(tmp_path / "elsewhere" / package.name)
    with on_package_path([(tmp_path / "elsewhere").as_posix()]):
        texts = compiled(spec).texts
    assert all("<sphere" in texts[f"urdf/vendored.{target}.urdf"] for target in ("mock", "real"))
    assert "| arm | from its vendor |" in texts["audit.md"]
    assert texts == beside


def test_difference_is_told_with_its_figures(tmp_path: Path) -> None:
    (found,) = [
        diagnosis
        for diagnosis in diagnose(_spec(tmp_path, "bent_arm"))
        if diagnosis.code == "vendor-description-differs"
    ]
    # 210 mm instead of 200 mm, 12 N m instead of 10 N m.
    assert "`arm_arm` is 10 mm off" in found.message
    assert "effort of `arm_turn` is 10 here and 12 there" in found.message


@pytest.mark.parametrize("name", ["vendored_arm", "unread_arm"])
def test_equal_or_unread_descriptions_differ_in_nothing(tmp_path: Path, name: str) -> None:
    assert "vendor-description-differs" not in {diagnosis.code for diagnosis in diagnose(_spec(tmp_path, name))}


def test_link_that_the_vendor_calls_otherwise_has_its_shape_and_place_too(tmp_path: Path) -> None:
    spec = _spec(tmp_path)
    vendor = tmp_path / "vendored_arm" / "vendored_arm_description" / "urdf" / "vendored_arm.urdf"
    text = vendor.read_text(encoding="utf-8")
    vendor.write_text(text.replace('"arm"', '"vendors_arm"').replace('<robot name="vendors_arm"', '<robot name="arm"'))
    assert _shapes(spec) == [Box]
    device = tmp_path / "vendored_arm" / "device.yaml"
    told = device.read_text(encoding="utf-8")
    device.write_text(told.replace("vendor: {", "vendor: {links: {vendors_arm: arm}, "), encoding="utf-8")
    assert _shapes(spec) == [Sphere]
    assert "vendor-description-differs" not in {diagnosis.code for diagnosis in diagnose(spec)}
