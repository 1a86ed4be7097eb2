"""What simulates the cell: the scene has the links, joints and limits of the description, and its names resolve."""

from __future__ import annotations

from xml.etree.ElementTree import Element, fromstring

import pytest

from tests.consumers.matrix import build, every_cell


def _scene(cell: str, distro: str) -> Element:
    return fromstring(build(cell, distro).texts["sim/scene.xml"])


def _named(root: Element, path: str, name: str = "name") -> list[str]:
    return [found.attrib[name] for found in root.findall(path) if name in found.attrib]


@every_cell
def test_scenes_have_the_links_joints_and_limits_of_the_description(cell: str) -> None:
    scene_follows_the_description(cell, "jazzy")
    names_of_a_scene_are_in_it(cell, "jazzy")


def scene_follows_the_description(cell: str, distro: str) -> None:
    """Fail where a link, a joint, a limit, a mass or a follower of the description is another one in the scene."""
    scene, robot = _scene(cell, distro), fromstring(build(cell, distro).urdf("mock"))
    links, sites = set(_named(robot, "link")) - {"world"}, _named(scene, ".//site")
    assert links <= set(sites)
    assert len(sites) == len(set(sites))
    joints = {joint.attrib["name"]: joint for joint in robot.findall("joint") if joint.get("type") != "fixed"}
    hinges = {joint.attrib["name"]: joint for joint in scene.findall(".//body/joint")}
    assert set(hinges) == set(joints)
    for name, joint in joints.items():
        limit = joint.find("limit")
        if limit is not None and "lower" in limit.attrib:
            assert _numbers(hinges[name], "range") == pytest.approx([float(limit.attrib[end]) for end in _ENDS])
        effort = 0.0 if limit is None else float(limit.attrib["effort"])
        assert _numbers(hinges[name], "actuatorfrcrange") == ([-effort, effort] if effort else [])
    masses = {link.attrib["name"]: float(link.findall("inertial/mass")[0].attrib["value"]) for link in _heavy(robot)}
    weighed = {body.attrib["name"]: body.find("inertial") for body in scene.iter("body")}
    assert {name: _numbers(there, "mass")[0] for name in masses if (there := weighed.get(name)) is not None} == masses
    mimics = {name: mimic.attrib["joint"] for name, joint in joints.items() for mimic in joint.findall("mimic")}
    equal = {each.attrib["joint1"]: each.attrib["joint2"] for each in scene.findall("equality/joint")}
    assert equal == mimics


_ENDS = ("lower", "upper")


def _heavy(robot: Element) -> list[Element]:
    return [link for link in robot.findall("link") if link.find("inertial") is not None]


def _numbers(element: Element, name: str) -> list[float]:
    return [float(word) for word in element.get(name, "").split()]


def names_of_a_scene_are_in_it(cell: str, distro: str) -> None:
    """Fail where a scene names what it does not have, or a posture has another number of joints."""
    scene = _scene(cell, distro)
    bodies, joints, sites = (set(_named(scene, f".//{tag}")) for tag in ("body", "body/joint", "site"))
    assert {*_named(scene, "contact/exclude", "body1"), *_named(scene, "contact/exclude", "body2")} <= bodies
    assert set(_named(scene, "actuator/position", "joint")) <= joints
    assert {sensor.attrib["site"] for sensor in scene.findall("sensor/*")} <= sites
    free = len(scene.findall(".//freejoint"))
    for key in scene.findall("keyframe/key"):
        assert len(_numbers(key, "qpos")) == len(joints) + 7 * free
        assert len(_numbers(key, "ctrl")) == len(scene.findall("actuator/position"))
