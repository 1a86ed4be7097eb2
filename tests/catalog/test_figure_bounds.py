"""Every number of a device.yaml has a range, is held by the shape of the file, or is free for a stated reason."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cellc.compiler.catalog.device_schema import device_schema
from cellc.compiler.catalog.figure_bounds import RANGES
from cellc.compiler.catalog.load import device_names, read_device
from cellc.compiler.pipeline import judge
from tests.rules.test_quantities import numbers

HELD = {
    "format": "unsupported-format",
    "gripper.closed": "the limits of its joint, and `open`",
    "gripper.goal_tolerance": "half of the way of its joint",
    "gripper.open": "the limits of its joint, and `closed`",
    "home.*": "the limits of its joint",
    "limits.position.*.lower": "its `upper`, and the range of the joint in implausible-description",
    "limits.position.*.upper": "its `lower`, and the range of the joint in implausible-description",
    "mounts.*.rpy": "one turn, by its type",
    "network.ports.*.port": "ports, by its type",
    "plug.serial.baud_rate": "what the connector of the robot offers",
    "plug.serial.stop_bits": "one or two, by its type",
    "robot.tool_connector.serial.baud_rates.*": "by its type",
    "robot.tool_connector.serial.stop_bits.*": "one or two, by its type",
    "robot.tool_connector.serial.tcp_port": "ports, by its type",
}
_CONTROLLER = "a parameter of a plugin means what its documentation says"
_OF_A_VALUE = ("above", "below", "given.*", "given.*.*", "value", "value.*")
FREE = {
    **dict.fromkeys(
        (f"controllers.*.parameters.*.discouraged.*.{key}" for key in _OF_A_VALUE),
        "a value of a parameter, in the unit of its program",
    ),
    "camera.exposure_parameters.*": "the unit in which a node takes its exposure, whatever that is",
    "control.gpios.*.initial.*": "a signal has the range that the device gives it",
    "control.sensors.*.initial.*": "a reading has the range of its sensor",
    **{
        f"control.hardware.{target}.{key}": reason
        for target in ("mock", "real")
        for key, reason in (
            ("commands.*.parameters.*", "a parameter of a request means what its server says"),
            ("commands.*.parameters.*.*", "a parameter of a request means what its server says"),
            ("reported_by.*.above", "a reading has the range of its sensor"),
            ("reported_by.*.values.*", "a number is a name here"),
        )
    },
    **{
        f"controllers.*.{key}": _CONTROLLER
        for key in (
            *("parameters.*.default", "parameters.*.default.*", "parameters.*.differs.*.default"),
            *("parameters.*.differs.*.default.*", "parameters.*.exclusive_minimum", "parameters.*.maximum"),
            *("topics.*.given.*", "topics.*.given.*.*"),
            *("parameters.*.minimum", "plugins.*.parameters.*", "plugins.*.parameters.*.*"),
        )
    },
    "nodes.*.parameters.*": "a parameter of a node means what its documentation says",
    "nodes.*.parameters.*.*": "a parameter of a node means what its documentation says",
    "readings.*.values.*": "a number is a name here",
    "robot.program.start_modes.*.node_parameters.*.*": "a parameter of a node means what its documentation says",
    "robot.program.start_modes.*.node_parameters.*.*.*": "a parameter of a node means what its documentation says",
    **{
        f"robot.tool_connector.serial.{key}.{end}": "times of silence are counted in characters, as many as it takes"
        for key in ("rx_idle_chars", "tx_idle_chars")
        for end in ("least", "most", "usual")
    },
}

ROBOT = """<robot name="arm"><link name="base"/><link name="tip"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
<origin xyz="0 0 0.5"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="10"/></joint>
</robot>"""
DEVICE = """format: 1
model: arm
vendor: demo
summary: an arm
kind: arm
as_of: 2026-08-01
sources: [manual]
description: {file: arm.urdf}
base: base
frames: {tip: tip}
tool_frame: tip
home: {turn: 0 rad}
packages: {}
"""


def unheld(schema: object) -> set[str]:
    assert isinstance(schema, dict)
    ranges = {key.replace("control.hardware.*", f"control.hardware.{at}") for key in RANGES for at in ("mock", "real")}
    return numbers(schema) - ranges - set(HELD) - set(FREE)


def test_every_number_of_a_device_is_held_or_free() -> None:
    assert unheld(json.loads(device_schema())) == set()


def test_a_key_that_is_added_without_an_entry_is_missed() -> None:
    schema = json.loads(device_schema())
    properties = schema["properties"]
    assert isinstance(properties, dict)
    properties["new_length"] = {"type": "string", "x-units": ["mm"]}
    assert unheld(schema) == {"new_length"}


def test_what_is_held_or_free_is_in_the_schema() -> None:
    ranges = {key.replace("control.hardware.*", f"control.hardware.{at}") for key in RANGES for at in ("mock", "real")}
    assert ranges | set(HELD) | set(FREE) <= numbers(json.loads(device_schema()))


def test_no_device_of_the_catalog_has_an_implausible_figure() -> None:
    found = [item for name in device_names() for item in read_device(name).diagnostics]
    assert [str(item) for item in found if item.code == "implausible-fact"] == []


@pytest.mark.parametrize(
    ("section", "key", "said"),
    [
        (
            "limits: {velocity: {turn: {value: 180 rad/s, source: x}}}",
            "limits",
            "from 0.001 to 50 in SI units, got 180",
        ),
        ("limits: {repeatability: {value: 50 mm, source: x}}", "limits", "from 1e-06 to 0.005 in SI units, got 0.05"),
        ("limits: {payload: {value: 0 kg, source: x}}", "limits", "from 0.01 to 3e+03 in SI units, got 0"),
        # 0.5 m from the base to the tip: five times that, and a hundredth.
        ("limits: {reach: {value: 2.5 m, source: x}}", "limits", "which is 0.5 m long, got 2.5 m"),
        ("limits: {reach: {value: 0.9 m, source: x}}", "limits", "which is 0.5 m long, got 0.9 m"),
        (
            "limits: {velocity: {turn: {value: 2 rad/s, source: x}}, "
            "acceleration: {turn: {value: 0.02 rad/s^2, source: x}}}",
            "limits",
            "must reach its speed within a millisecond to 10 s, got 100 s",
        ),
    ],
)
def test_a_figure_that_no_machine_has_is_reported_at_its_line(
    tmp_path: Path, section: str, key: str, said: str
) -> None:
    folder = tmp_path / "arm"
    folder.mkdir()
    (folder / "arm.urdf").write_text(ROBOT, encoding="utf-8")
    (folder / "device.yaml").write_text(f"{DEVICE}{section}\n", encoding="utf-8")
    found = [item for item in judge(folder / "device.yaml") if item.code == "implausible-fact"]
    assert [said in item.message for item in found] == [True], [str(item) for item in judge(folder / "device.yaml")]
    assert (found[0].span.line, found[0].yaml_path[0]) == (14, key)
