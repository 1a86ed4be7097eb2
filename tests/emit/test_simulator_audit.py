"""What the audit says of the target ``sim``: each thing that it cannot show is there, UNKNOWN, and named."""

from __future__ import annotations

from typing import Any

import pytest

from tests.cells import EVERY_CELL, built
from tests.foreign_yaml import safe_load

_TITLE = "## What the simulator cannot show"


def _rows(cell: str) -> dict[str, tuple[str, str]]:
    section = built(cell).texts["audit.md"].split(_TITLE)[1].split("\n## ")[0]
    lines = [line.strip("|").split("|") for line in section.strip().splitlines()[2:]]
    return {what.strip(): (answer.strip(), there.strip()) for what, answer, there in lines}


def _simulated(cell: str) -> bool:
    return "config/controllers.sim.yaml" in built(cell).texts


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_every_controller_that_the_simulator_lacks_is_named_and_unknown(cell: str) -> None:
    texts = built(cell).texts
    assert (_TITLE in texts["audit.md"]) == _simulated(cell)
    if not _simulated(cell):
        return
    rows = _rows(cell)
    assert {answer for answer, _ in rows.values()} == {"UNKNOWN"}
    (file,) = {path for path in texts if path in ("config/controllers.yaml", "config/controllers.mock.yaml")}

    def plugins(path: str) -> dict[str, Any]:
        manager = safe_load(texts[path])["controller_manager"]["ros__parameters"]
        return {name: value["type"] for name, value in manager.items() if isinstance(value, dict) and "type" in value}

    there, real = plugins("config/controllers.sim.yaml"), plugins(file)
    for name, plugin in real.items():
        row = rows.get(f"controller `/{name}`")
        if name not in there:
            assert row is not None
            assert row[1].startswith("not loaded, because it takes `")
        else:
            assert row == (
                None if plugin == there[name] else ("UNKNOWN", f"`{there[name]}` in the place of `{plugin}`")
            )


def test_what_a_vendor_does_besides_motion_is_named() -> None:
    rows = _rows("ur5e_pick")
    assert "speed scaling of arm" in rows
    assert any(what.startswith("stops and modes of arm: protective_stop") for what in rows)
    assert rows["encoding of `/camera/depth/image_rect_raw`"][1] == "32FC1 in m, 16UC1 from the driver"
    assert "commands of arm by velocity" in rows
    rows = _rows("fr3_hand")
    assert rows["loop of `/arm_trajectory` by effort"][1] == "it commands position, as on the mock"
    assert rows["action `/hand_gripper/gripper_action` of the driver"][1] == "`/hand_action` takes its goals"


@pytest.mark.parametrize("page", ["gates/promotion.md", "gates/network.md"])
def test_gates_say_that_nothing_in_the_simulator_is_real(page: str) -> None:
    said = "A run with `target:=sim` is evidence for no gate. Nothing in the simulator is real."
    for cell in EVERY_CELL:
        assert (said in built(cell).texts[page]) == _simulated(cell)
        assert ("target:=sim headless:=true" in built(cell).texts["README.md"]) == _simulated(cell)
