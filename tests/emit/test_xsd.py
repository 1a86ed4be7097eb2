"""Emitted XML against the schemas that the projects behind its readers publish."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest
import xmlschema

from tests.emit.cells import CELLS, artifacts_of
from tests.oracles import UPSTREAM, needs_upstream

pytestmark = needs_upstream


def _schema(name: str) -> Path:
    return UPSTREAM / "xsd" / name


@pytest.mark.parametrize("cell", CELLS)
def test_package_xml_is_format_3(cell: str) -> None:
    xmlschema.XMLSchema(_schema("package_format3.xsd")).validate(artifacts_of(cell)["package.xml"])


@pytest.mark.parametrize("target", ["mock", "real"])
@pytest.mark.parametrize("cell", CELLS)
def test_urdf_is_what_urdfdom_declares(cell: str, target: str) -> None:
    robot = ElementTree.fromstring(artifacts_of(cell)[f"urdf/{cell}.{target}.urdf"])
    for tag in robot.findall("ros2_control"):  # the schema does not know it
        robot.remove(tag)
    xmlschema.XMLSchema(_schema("urdf.xsd")).validate(robot)


@pytest.mark.parametrize("file", ["launch/cell.launch.xml", "launch/real_gate.launch.xml"])
@pytest.mark.parametrize("cell", CELLS)
def test_launch_files_follow_the_grammar(cell: str, file: str) -> None:
    launch = ElementTree.fromstring(artifacts_of(cell)[file])
    for argument in launch.findall("arg"):  # choices are newer than the schema
        for choice in argument.findall("choice"):
            argument.remove(choice)
        argument.text = None
    for parameter in launch.iter("param"):  # so is the type of a parameter
        parameter.attrib.pop("type", None)
    for node in launch.iter("node"):  # and output to screen and log file
        assert node.attrib.pop("output") == "both"
        assert node.attrib.pop("ros_args").startswith("--enclave /")
        assert node.attrib.pop("on_exit", "shutdown") == "shutdown"
    xmlschema.XMLSchema11(_schema("launch.0.1.1.xsd")).validate(launch)
