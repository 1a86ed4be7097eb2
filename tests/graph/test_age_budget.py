"""The freshest chain from a sensor to a topic, with shares worked out by hand."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.graph.data_flow import age_chains
from tests.cells import COMPLETE, diagnose, linked


@pytest.fixture(scope="module")
def cell() -> Cell:
    return linked(COMPLETE)


def topic(cell: Cell, name: str, source: str, sink: str, rate_hz: float) -> Interface:
    pose = next(interface for interface in cell.interfaces if interface.name == "/object_pose")

    def end(node: str) -> Endpoint:
        return replace(pose.sources[0], node=node)

    return replace(pose, name=name, sources=(end(source),), sinks=(end(sink),), rate_hz=rate_hz)


def chain(cell: Cell, name: str) -> list[tuple[str, object]]:
    return [(share.topic, share.total_s) for share in age_chains(cell)[name]]


def test_pose_is_as_old_as_its_image_and_its_own_period(cell: Cell) -> None:
    # 8 ms of exposure and a period of 33.3 ms for the image, 100 ms for the pose.
    image, pose = chain(cell, "/object_pose")
    assert image == ("/camera/camera/color/image_raw", pytest.approx(0.008 + 1 / 30))
    assert pose == ("/object_pose", pytest.approx(0.1))


def test_exposure_of_the_catalog_counts_where_the_spec_states_none(tmp_path: Path) -> None:
    # The 80 ms of the catalog and a period of 33.3 ms are more than the 100 ms that the image may be old.
    shutil.copytree(COMPLETE.parent, tmp_path, dirs_exist_ok=True)
    spec, device = (tmp_path / "parts" / name for name in ("devices_camera.yaml", "demo_camera/device.yaml"))
    stated, camera = (file.read_text(encoding="utf-8") for file in (spec, device))
    spec.write_text(stated.replace(" exposure: 8 ms,", ""), encoding="utf-8")
    device.write_text(camera.replace("\ncamera:\n", "\ncamera:\n  exposure: 80 ms\n"), encoding="utf-8")
    found = {finding.code: finding.message for finding in diagnose(tmp_path / COMPLETE.name)}
    assert "must be at least 113.3 ms" in found["max-age-too-short"]


def test_freshest_of_several_inputs_counts(cell: Cell) -> None:
    slow, fast = topic(cell, "/slow", "a", "c", 1.0), topic(cell, "/fast", "b", "c", 50.0)
    made = replace(cell, interfaces=(slow, fast, topic(cell, "/out", "c", "task", 10.0)))
    assert chain(made, "/out") == [("/fast", pytest.approx(0.02)), ("/out", pytest.approx(0.1))]


def test_equally_fresh_inputs_give_the_first_by_name(cell: Cell) -> None:
    same = [topic(cell, name, name[1:], "c", 10.0) for name in ("/b", "/a")]
    made = replace(cell, interfaces=(*same, topic(cell, "/out", "c", "task", 10.0)))
    assert [name for name, _ in chain(made, "/out")] == ["/a", "/out"]


def test_topics_in_a_circle_observe_nothing(cell: Cell) -> None:
    circle = (topic(cell, "/there", "a", "b", 10.0), topic(cell, "/back", "b", "a", 10.0))
    made = replace(cell, interfaces=circle)
    assert chain(made, "/there") == [("/there", pytest.approx(0.1))]
    assert chain(made, "/back") == [("/back", pytest.approx(0.1))]
