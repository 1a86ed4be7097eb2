"""A gripper on the tool connector of the arm, as the driver of each release of that arm takes it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from cellc.tools.report.resolved import Tree, resolved_tree
from tests.cells import graph_of, spec_text, written
from tests.emit.cells import emitted
from tests.oracles import here
from tests.vendors.oracle import RELEASES, Release, facts

_LINE = "tool_connector: {voltage: 24 V, serial: {port: /run/user/1000/arm_tool, baud_rate: 115200}}"
_GRIPPER_BY_USB = "connection: {host: control_pc, port: /dev/ttyUSB0}"


def _spec(connector: str = _LINE) -> str:
    text = spec_text("ur5e_pick").replace("    program: {", f"    {connector}\n    program: {{", 1)
    return text.replace(_GRIPPER_BY_USB, "connection: {host: control_pc, through: arm}")


@pytest.mark.parametrize("release", here([release for release in RELEASES if release.device == "ur5e"]), ids=str)
def test_the_plugin_gets_every_parameter_that_it_reads_with_tool_communication(
    release: Release, tmp_path: Path
) -> None:
    text = _spec().replace("ros: jazzy", f"ros: {release.distro}").replace("ur_robot_driver 3.8.0", release.driver)
    hardware = graph_of(written(tmp_path, text)).cell.device("arm").control.hardware
    assert hardware is not None
    given = hardware.parameters["real"]
    read = facts(release, "hardware_parameters")["parameters"]
    asked = {name for name, told in read.items() if told["required"] == "when use_tool_communication"}
    assert asked
    assert asked <= set(given) <= set(read)
    # launch_arguments.yaml of the release: its own defaults but for the voltage, which is 0 there.
    usual = next(iter(facts(release, "launch_arguments").values()))
    settings = {name: given[name] for name in asked - {"tool_voltage"}}
    assert settings == {name: usual[name]["default"] for name in settings}
    assert (given["use_tool_communication"], given["tool_voltage"]) == ("true", "24")


def test_the_line_is_forwarded_to_the_port_that_the_gripper_opens(tmp_path: Path) -> None:
    texts = emitted(tmp_path, _spec())
    launch = ElementTree.fromstring(texts["launch/cell.launch.xml"])
    (program,) = launch.findall("executable")
    # ur_control.launch.py of 3.8.0, line 119: the address, the port of the robot, the device node.
    assert program.get("cmd", "").split("/lib/ur_client_library/")[1] == (
        "tool_communication.py 192.168.56.101 --tcp-port 54321 --device-name /run/user/1000/arm_tool"
    )
    assert "'real'" in program.get("if", "")
    robot = ElementTree.fromstring(texts["urdf/ur5e_pick.real.urdf"])
    assert [param.text for param in robot.iter("param") if param.get("name") == "COM_port"] == [
        "/run/user/1000/arm_tool"
    ]
    needed = {exec_depend.text for exec_depend in ElementTree.fromstring(texts["package.xml"]).findall("exec_depend")}
    assert {"socat", "ur_client_library"} <= needed


def test_the_voltage_is_named_before_anything_has_power(tmp_path: Path) -> None:
    gates = emitted(tmp_path, _spec())["gates/promotion.md"].replace("\\", "").split("\n## ")
    inventory, enabling = (next(gate for gate in gates if gate.startswith(code)) for code in ("G0 ", "G5 "))
    assert "The tool connector of arm supplies 24 V to gripper" in inventory
    # The settings reach the connector as the program starts, and the gripper is activated with no program.
    played, activated = enabling.index("start the program once and stop it"), enabling.index("hardware that moves")
    assert played < activated


def test_show_has_the_voltage_as_it_is_written_and_the_port_where_it_leads(tmp_path: Path) -> None:
    devices = resolved_tree(graph_of(written(tmp_path, _spec())).cell)["devices"]
    assert isinstance(devices, dict)
    shown = dict(leaves(devices))
    assert shown["arm.tool_connector.voltage"] == "24 V"
    assert shown["gripper.connection.port"] == "/run/user/1000/arm_tool"


def leaves(tree: dict[str, Tree], path: str = "") -> Iterator[tuple[str, str]]:
    """Yield the texts of a tree by their dotted paths."""
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from leaves(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value.text
