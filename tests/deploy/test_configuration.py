"""The configuration id names what evidence rests on, and nothing else."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.configuration import configuration_id, configuration_inputs
from cellc.compiler.formats.urdf import robot
from cellc.compiler.pipeline import check, emit_cell
from cellc.contract.entities import Target
from cellc.contract.manifest import ConfigurationInputs
from tests.cells import graph_of, spec_of, spec_text, written
from tests.emit.cells import emitted
from tests.review.revisions import edited
from tests.review.test_edits import GROUPS


def _id(folder: Path, text: str) -> str:
    return configuration_id(configuration_inputs(graph_of(written(folder, text))))


@pytest.fixture(scope="module")
def as_it_is(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The id of the cell as it is in the repository."""
    return _id(tmp_path_factory.mktemp("cell"), spec_text("ur5e_pick"))


_TOLD_ALONE = ("summary: ", "limits: controls, watchdogs")
"""What a person reads, and who answers: no evidence rests on it."""


@pytest.mark.parametrize(
    "edit", [edit for edits, _ in GROUPS.values() for edit in edits], ids=lambda edit: edit[0][:40]
)
def test_every_edit_that_means_something_is_another_configuration(
    edit: tuple[str, str], as_it_is: str, tmp_path: Path
) -> None:
    if "watcher" in edit[1]:
        edit = (edit[0], edit[1].replace(", watcher: {depth: 1}", ""))
    changed = _id(tmp_path, edited(edit)) != as_it_is
    assert changed is not edit[0].startswith(_TOLD_ALONE)


def test_id_changes_with_who_publishes_a_frame_and_with_a_bound(as_it_is: str, tmp_path: Path) -> None:
    for edit in (
        ("published_by: perception", "published_by: task"),
        ("cancel_within: 200 ms", "cancel_within: 150 ms"),
    ):
        assert _id(tmp_path, spec_text("ur5e_pick").replace(*edit)) != as_it_is


def test_the_first_planning_pipeline_is_the_default_so_that_another_order_is_another_configuration(
    as_it_is: str, tmp_path: Path
) -> None:
    group = "  groups: {manipulator"
    turned = f"  pipelines: [pilz_industrial_motion_planner, ompl]\n{group}"
    assert _id(tmp_path, spec_text("ur5e_pick").replace(group, turned)) != as_it_is


def test_manifest_from_before_the_cell_was_hashed_is_read() -> None:
    told = {"calibrations": {"hand_eye": 4}, "tf_publishers": {"tcp": "robot_state_publisher"}, "urdf_sha256": "0" * 64}
    assert ConfigurationInputs.model_validate(told).cell_sha256 == ""


def test_hash_is_that_of_the_real_urdf_without_its_header(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    urdf = emitted(tmp_path, text)["urdf/ur5e_pick.real.urdf"]
    body = re.sub(r"<!--.*?-->\n", "", urdf, count=1, flags=re.DOTALL)
    inputs = configuration_inputs(graph_of(written(tmp_path, text)))
    assert inputs.urdf_sha256 == hashlib.sha256(body.encode()).hexdigest()


@pytest.mark.parametrize("cell", ["ur5e_pick", "dual_ur"])
def test_no_description_is_written_twice_for_one_compile(cell: str, monkeypatch: pytest.MonkeyPatch) -> None:
    made = Counter[tuple[object, ...]]()
    parts = robot._parts

    def counted(of: Cell, target: Target, devices: tuple[str, ...]) -> Iterator[Element]:
        made[len(of.devices), target, devices] += 1
        return parts(of, target, devices)

    monkeypatch.setattr(robot, "_parts", counted)
    assert emit_cell(check(spec_of(cell))).value is not None
    assert ("mock", ()) in {key[1:] for key in made}
    assert set(made.values()) == {1}
