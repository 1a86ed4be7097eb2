"""A sweep whose parts and tools have masses: what is drawn is what bodies weigh, and a run is the same wherever."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from cellc.mock import load
from cellc.mock.plant import Plant
from cellc.mock.sweep.draws import draw
from cellc.mock.sweep.sweep import reality, uncertainty_of
from tests.cells import build_into, spec_text, written
from tests.cli.run import run

_DRAWN = "uncertainty:"
_WITH = "uncertainty:\n  parts: {object: {mass: 20 g, friction: 0.05}}\n  loads: {arm: {payload: 50 g}}"
_SHORT = "rehearsals:\n  short: {steps: [detect: object, move: home]}"
_NAMES = ("payload of arm", "mass of object", "friction of object")
_TOOLS_KG = 0.66320197 + 2 * (0.01384773208 + 0.04260376752 + 0.04268588744 + 0.02969376448) + 0.072
"""The 2F-85 and the D435i: the inertials of their URDFs."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    text = spec_text("ur5e_pick").replace(_DRAWN, _WITH, 1).replace("rehearsals:", _SHORT, 1)
    path = tmp_path_factory.mktemp("masses")
    return build_into(path / "generated", written(path, text))


def test_bodies_weigh_and_slide_as_a_run_draws_it(folder: Path) -> None:
    cell, plants = load(folder, physics=True), list[Plant]()
    uncertainty = uncertainty_of(cell)
    drawn = draw(uncertainty.quantities, 0, 3)
    cell.run("short")  # which keeps a copy of the cell with what is stated
    real = reality(uncertainty, 0, 3)
    cell.rehearse(cell.entry("short"), watch=plants.append, reality=real, from_off=False)
    dynamics = plants[-1].control.dynamics
    assert dynamics is not None
    payload, mass, friction = (drawn[name] for name in _NAMES)
    assert min(abs(payload), abs(mass), abs(friction)) > 1e-3, "each of them differs from what is stated"
    assert dynamics.weight_n("object") == pytest.approx((0.2 + mass) * 9.81)
    assert dynamics.friction("object") == pytest.approx(0.5 + friction)
    # The controller knows what it was told, so that wrist 1 holds what is drawn beyond it, at about its lever of 0.1 m.
    model = dynamics._now().model
    tools = [index for index, name in enumerate(dynamics.scene.bodies) if name.startswith(("gripper_", "camera_"))]
    weighs = sum(float(model.body_mass[index]) for index in tools)
    held = sum(float(model.body_mass[index] * model.body_gravcomp[index]) for index in tools)
    assert weighs == pytest.approx(_TOOLS_KG + payload)
    assert held == pytest.approx(_TOOLS_KG)


def test_a_sweep_is_resumed_and_its_runs_are_the_same_alone_and_in_other_processes(
    folder: Path, tmp_path: Path
) -> None:
    journal = tmp_path / "sweep.jsonl"
    asked = ("sweep", folder.as_posix(), "--rehearsal", "short", "--journal", journal.as_posix())
    assert run(*asked, "--physics", "--runs", "2", "--jobs", "2").code == 0
    head, *runs = map(json.loads, journal.read_text(encoding="utf-8").splitlines())
    digests = {each["number"]: each["digest"] for each in runs}
    assert (head["masses"].split()[0], sorted(digests)) == ("mujoco", [0, 1])
    alone = run("replay", folder.as_posix(), "sweep:1", "--rehearsal", "short", "--physics")
    found = re.search(r"digest: (\S+)", alone.out)
    assert found is not None
    assert found[1] == digests[1]
    without = run(*asked, "--runs", "2")
    assert (without.code, "belongs to another sweep" in without.err) == (2, True)
    told = run("sweep", folder.as_posix(), "--rehearsal", "short", "--runs", "1")
    assert f"note: drawn with `--physics` alone: {', '.join(_NAMES)}\n" in told.out
