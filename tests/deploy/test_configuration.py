"""The configuration id names calibration, TF publishers and URDF, and nothing else."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import pytest

from cellc.deploy.configuration import configuration_id, configuration_inputs
from tests.cells import graph_of, spec_text, written
from tests.emit.cells import emitted


def _id(folder: Path, text: str) -> str:
    return configuration_id(configuration_inputs(graph_of(written(folder, text)).cell))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("revision: 4", "revision: 5"),
        ("published_by: perception", "published_by: task"),
        ("xyz: 0 0 162 mm", "xyz: 0 0 163 mm"),
        ("velocity: 50 %", "velocity: 40 %"),
        ("192.168.56.101", "192.168.56.102"),
    ],
)
def test_id_changes_with_what_it_names(before: str, after: str, tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert before in text
    assert _id(tmp_path, text) != _id(tmp_path, text.replace(before, after))


@pytest.mark.parametrize(
    ("before", "after"),
    [("rate: 30 Hz", "rate: 15 Hz"), ("goal_time: 1 s", "goal_time: 2 s"), ("domain_id: 42", "domain_id: 7")],
)
def test_id_stays_with_what_it_does_not_name(before: str, after: str, tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert before in text
    assert _id(tmp_path, text) == _id(tmp_path, text.replace(before, after))


def test_id_does_not_depend_on_the_order_of_calibrations(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    lines = {
        name: line for name in ("hand_eye", "tcp_2f") for line in text.splitlines() if line.startswith(f"  {name}:")
    }
    swapped = text.replace(lines["hand_eye"], "A").replace(lines["tcp_2f"], lines["hand_eye"])
    assert _id(tmp_path, text) == _id(tmp_path, swapped.replace("\nA\n", f"\n{lines['tcp_2f']}\n"))


def test_hash_is_that_of_the_real_urdf_without_its_header(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    urdf = emitted(tmp_path, text)["urdf/ur5e_pick.real.urdf"]
    body = re.sub(r"<!--.*?-->\n", "", urdf, count=1, flags=re.DOTALL)
    inputs = configuration_inputs(graph_of(written(tmp_path, text)).cell)
    assert inputs.urdf_sha256 == hashlib.sha256(body.encode()).hexdigest()
