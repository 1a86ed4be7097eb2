"""Every emitted XML file against the schema that the project behind its reader publishes."""

from __future__ import annotations

from functools import lru_cache
from xml.etree.ElementTree import Element, fromstring, tostring

import pytest
import xmlschema
from lxml import etree

from tests.consumers.matrix import build, every_build
from tests.consumers.permissions import policy_text
from tests.oracles import UPSTREAM, needs_upstream

pytestmark = needs_upstream

_SCHEMAS = {
    "package.xml": "package_format3.xsd",
    ".urdf": "urdf.xsd",
    "security/policy.xml": "sros2_policy.xsd",
    ".fastdds.xml": "fastdds_profiles.xsd",
    ".cyclonedds.xml": "cyclonedds.xsd",
}
# Version 2 of Fast DDS, of Humble and Jazzy, has another namespace than the schema, which is of version 3.
_FASTDDS_2, _FASTDDS_3 = "http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles", "http://www.eprosima.com"
# What the policy includes is judged in it; MuJoCo publishes no schema, and loads the scene in tests/emit/test_scene.py.
_ELSEWHERE = (".launch.xml", ".srdf", ".svg", "security/common.xml", "sim/scene.xml")


@lru_cache(maxsize=8)
def schema(name: str) -> etree.XMLSchema:
    """Return a schema of version 1.0; what it imports is taken from beside it, never from the network."""
    file = UPSTREAM / "xsd" / name
    text = file.read_bytes().replace(b"http://www.w3.org/2001/03/xml.xsd", b"xml.xsd")
    parser = etree.XMLParser(no_network=True)
    return etree.XMLSchema(etree.fromstring(text, parser, base_url=str(file)))


@lru_cache(maxsize=1)
def launch_schema() -> xmlschema.XMLSchema11:
    """Return the schema of launch files, which needs version 1.1."""
    return xmlschema.XMLSchema11(UPSTREAM / "xsd" / "launch.0.1.1.xsd")


@lru_cache(maxsize=256)
def faults(path: str, text: str) -> list[str]:
    """Return what the schema of a file says of its text."""
    (name,) = (name for end, name in _SCHEMAS.items() if path.endswith(end))
    root = fromstring(text.replace(_FASTDDS_2, _FASTDDS_3))
    for tag in (*root.findall("ros2_control"), *root.findall("{http://www.ros.org/wiki/xacro}arg")):
        root.remove(tag)  # outside of the schema of urdfdom; xacro leaves none of its own
    checked = schema(name)
    checked.validate(etree.fromstring(tostring(root)))
    return [str(error) for error in checked.error_log]


@lru_cache(maxsize=64)
def launch_faults(text: str) -> list[str]:
    """Return what the schema says of a launch file, without what launching knows since and the schema does not."""
    root = fromstring(text)
    for action in root.findall("set_parameter"):
        assert {"name", "value"} <= set(action.attrib) <= {"name", "value", "if"}
        root.remove(action)
    for action in root.iter():
        _take_newer_away(action)
    return [str(error.reason) for error in launch_schema().iter_errors(root)]


def _take_newer_away(action: Element) -> None:
    for choice in action.findall("choice"):
        assert set(choice.attrib) == {"value"}
        action.remove(choice)
    if action.tag == "arg":
        action.text = None
        action.attrib.pop("if", None)
    if action.tag == "param":
        assert action.attrib.pop("type", "str") in {"str", "int", "float", "bool"}
    if action.tag in ("node", "executable"):
        assert action.attrib.pop("output", "both") == "both"
        action.attrib.pop("ros_args", None)
        assert action.attrib.pop("on_exit", "shutdown") == "shutdown"


@every_build
def test_xml_is_what_its_readers_declare(cell: str, distro: str) -> None:
    files = {path: text for path, text in build(cell, distro).texts.items() if path.endswith(("xml", "urdf"))}
    checked = [path for path in files if not path.endswith(_ELSEWHERE)]
    assert {"package.xml", "security/policy.xml", f"urdf/{cell}.mock.urdf", f"urdf/{cell}.real.urdf"} <= set(checked)
    files["security/policy.xml"] = policy_text(files)
    for path in checked:
        assert faults(path, files[path]) == [], path


@every_build
def test_launch_files_follow_their_grammar(cell: str, distro: str) -> None:
    for path, text in build(cell, distro).texts.items():
        if path.endswith(".launch.xml"):
            assert launch_faults(text) == [], path


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("package.xml", "<license>", "<licence>"),
        ("urdf/ur5e_pick.mock.urdf", 'type="revolute"', 'type="hinge"'),
        ("security/policy.xml", 'publish="ALLOW"', 'publish="PERMIT"'),
        ("middleware/control_pc.fastdds.xml", "<type>UDPv4</type>", "<kind>UDPv4</kind>"),
    ],
)
def test_schemas_see_a_fault(path: str, old: str, new: str) -> None:
    texts = build("ur5e_pick", "jazzy").texts
    text = policy_text(texts) if path == "security/policy.xml" else texts[path]
    broken = text.replace(old, new).replace(old.replace("<", "</"), new.replace("<", "</"))
    assert broken != text
    assert faults(path, broken)


def test_schema_of_cyclone_sees_a_fault() -> None:
    text = build("fr3_hand", "humble").texts["middleware/control_pc.cyclonedds.xml"]
    assert faults("a.cyclonedds.xml", text.replace("AllowMulticast>", "AllowMulticasts>"))


def test_schema_of_launch_files_sees_a_fault() -> None:
    text = build("ur5e_pick", "jazzy").texts["launch/cell.launch.xml"]
    assert launch_faults(text.replace(' exec="spawner"', ' execute="spawner"'))
