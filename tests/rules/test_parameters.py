"""Parameters that a consumer refuses or that make a cell worse, in every distribution, by the vendors' declarations."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.catalog.load import controller_kinds, load_controller_kind, load_programs
from cellc.compiler.catalog.programs import DiscouragedValue
from tests.cells import diagnose, spec_text, there, written


@pytest.mark.parametrize("distro", ["humble", "jazzy", "kilted", "lyrical"])
@pytest.mark.parametrize(
    ("parameters", "reported"),
    [
        ("", True),
        (", parameters: {frame_id: arm_tool0}", False),
        (", parameters: {sensor_name: arm_tcp_fts_sensor}", True),
    ],
)
def test_empty_default_that_the_broadcaster_refuses_is_missing(
    distro: str, parameters: str, reported: bool, tmp_path: Path
) -> None:
    # force_torque_sensor_broadcaster declares frame_id with default "" and not_empty<> in every distribution.
    text = spec_text("ur5e_pick").replace("  ros: jazzy", f"  ros: {distro}", 1)
    force = "    arm_force: {type: force_torque_sensor_broadcaster, device: arm" + parameters + "}\n"
    assert "    arm_trajectory:\n" in text
    found = diagnose(written(tmp_path, text.replace("    arm_trajectory:\n", force + "    arm_trajectory:\n", 1)))
    assert any(one.code == "missing-controller-parameter" for one in found) is reported


def _value(**figures: float | str | bool) -> DiscouragedValue:
    return DiscouragedValue.model_validate({"does": "it does that", "source": "a line", **figures})


@pytest.mark.parametrize(
    ("row", "held", "others"),
    [
        (_value(value=0.0), [0.0, 0, -0.0], [0.01, False, "0.0"]),
        (_value(value=False), [False, (True, False)], [True, 0, 0.0, "False"]),
        (_value(value="none"), ["none"], ["splines", False]),
        (_value(above=0.1), [0.11, 1], [0.1, 0.0, True, "1"]),
        (_value(below=0.0), [-0.1, (1.0, -1.0)], [0.0, 1.0, False]),
    ],
)
def test_value_is_held_to_be_worse_only_where_it_is_meant(
    row: DiscouragedValue, held: list[object], others: list[object]
) -> None:
    assert all(row.holds(value) for value in held)
    assert not any(row.holds(value) for value in others)


def test_no_default_of_a_program_is_discouraged_but_where_cellc_writes_another() -> None:
    worse = {
        f"{kind}.{name}"
        for kind in controller_kinds()
        for name, facts in there(load_controller_kind(kind).value).parameters.items()
        if any(one.holds(facts.default) for one in facts.discouraged)
    }
    assert worse == {"parallel_gripper.allow_stalling"}


def test_rows_of_programs_are_values_or_ranges() -> None:
    rows = there(load_programs().value).parameters
    assert rows
    assert all(
        (one.value is None) != (one.below is None and one.above is None) for row in rows for one in row.discouraged
    )
