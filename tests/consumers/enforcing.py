"""Processes under an enforced policy: a keystore made by sros2 from what was emitted, and stand-ins in its enclaves."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import fromstring, tostring

from tests.consumers.matrix import Build
from tests.consumers.starting import plan, proven

DOMAIN = "96"
ROOT = Path(__file__).resolve().parents[2]
Node = dict[str, Any]

_PACKAGES = ("rclpy", "sros2", "controller_manager_msgs", "control_msgs", "sensor_msgs", "tf2_msgs")
_KEYS = """
import pathlib, sys
from sros2.api import _artifact_generation
_artifact_generation.generate_artifacts(pathlib.Path(sys.argv[1]), [], [pathlib.Path(sys.argv[2])])
"""
_JOINS = "import rclpy; rclpy.init(args=['--ros-args', '--enclave', '/cell']); rclpy.create_node('a')"
_ONE_ENCLAVE = """<policy version="0.2.0"><enclaves><enclave path="/cell"><profiles>
<profile ns="/" node="a"><topics publish="ALLOW"><topic>rosout</topic></topics></profile>
</profiles></enclave></enclaves></policy>"""


def on_loopback(**more: str) -> dict[str, str]:
    """Return the environment of a process that nobody beyond this machine hears."""
    own = {"ROS_DOMAIN_ID": DOMAIN, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "PYTHONPATH": str(ROOT)}
    return {"AMENT_PREFIX_PATH": sys.prefix, **os.environ, **own, **more}


def enforced(keystore: Path) -> dict[str, str]:
    """Return the environment of a process that starts in an enclave or not at all."""
    told = {"ROS_SECURITY_ENABLE": "true", "ROS_SECURITY_STRATEGY": "Enforce"}
    return on_loopback(ROS_SECURITY_KEYSTORE=str(keystore), **told)


def make_keystore(folder: Path, policy: str, common: str = "") -> Path:
    """Make the keystore of a policy, and of what it includes, as ``ros2 security generate_artifacts`` does."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "policy.xml").write_text(policy, encoding="utf-8")
    (folder / "common.xml").write_text(common, encoding="utf-8")
    words = [sys.executable, "-W", "ignore", "-c", _KEYS, str(folder / "keystore"), str(folder / "policy.xml")]
    subprocess.run(words, env=on_loopback(), check=True, stdout=subprocess.DEVNULL)
    return folder / "keystore"


def why_not(folder: Path) -> str:
    """Return why nothing can be enforced here; empty where the installed middleware can, which is tried."""
    if absent := [name for name in _PACKAGES if importlib.util.find_spec(name) is None]:
        return f"not installed: {', '.join(absent)}"
    words = [sys.executable, "-c", _JOINS]
    joins = subprocess.run(words, env=enforced(make_keystore(folder, _ONE_ENCLAVE)), capture_output=True, text=True)
    # A middleware that can do it looks at the enclave, and refuses the node one of its services.
    return "the middleware is built without DDS security" if "security libraries" in joins.stderr else ""


@dataclass
class Started:
    """One process of stand-ins.

    Args:
        refused: right, name and message of each end that it could not open.
        heard: how often each topic was heard, each service answered it.
        answered: how often it answered each service.
        told: a file in memory for what the middleware tells, as nobody reads it meanwhile.
    """

    process: subprocess.Popen[str]
    told: int
    refused: list[tuple[str, str, str]] = field(default_factory=list)
    heard: dict[str, int] = field(default_factory=dict)
    answered: dict[str, int] = field(default_factory=dict)

    def opened(self) -> Started:
        """Wait until all ends are open, or refused."""
        line = self._line()
        self.refused = [(right, name, said) for right, name, said in json.loads(line)["refused"]]
        return self

    def met(self, *, closed: bool = True) -> Started:
        """Let it leave, or wait until it has heard what it waits for; take what it met."""
        if closed and self.process.stdin:
            self.process.stdin.close()
        met = json.loads(self._line())
        self.heard, self.answered = met["heard"], met["answered"]
        return self

    @property
    def said(self) -> str:
        """Return what the middleware has told."""
        return os.pread(self.told, os.fstat(self.told).st_size, 0).decode()

    def _line(self) -> str:
        line = self.process.stdout.readline() if self.process.stdout else ""
        assert line, self.said
        return line


class StandIns(ExitStack):
    """Stand-ins that live together; all of them are ended with it."""

    def __init__(self, environment: dict[str, str]) -> None:
        super().__init__()
        self._environment = environment

    def start(self, enclave: str, *nodes: Node, **more: Any) -> Started:
        """Start one process with its nodes in an enclave."""
        words = [sys.executable, "-m", "tests.consumers.ros_stand_in"]
        told = os.memfd_create("told")
        self.callback(os.close, told)
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": told}
        process = subprocess.Popen(words, env=self._environment, text=True, cwd=ROOT, **pipes)
        self.callback(process.wait)
        self.callback(process.kill)
        assert process.stdin
        process.stdin.write(json.dumps({"enclave": enclave, "nodes": nodes, **more}) + "\n")
        process.stdin.flush()
        return Started(process, told)


_RIGHTS = {"topic": ("publish", "subscribe"), "service": ("reply", "request"), "action": ("execute", "call")}
_OF_MANAGER = {
    "list_controllers": "ListControllers",
    "list_hardware_components": "ListHardwareComponents",
    "set_hardware_component_state": "SetHardwareComponentState",
    "switch_controller": "SwitchController",
}


def stand_ins(built: Build) -> dict[str, list[Node]]:
    """Return the nodes of every enclave with the ends that the cell declares for them."""
    cell = built.graph.cell
    nodes: dict[str, Node] = {node.full_name: _node(node.full_name, bool(node.lifecycle)) for node in cell.nodes}
    nodes |= {controller.full_name: _node(controller.full_name) for controller in cell.controllers}
    for interface in cell.interfaces:
        for right, ends in zip(_RIGHTS[interface.kind.value], (interface.sources, interface.sinks), strict=True):
            for end in ends:
                nodes[end.full_name]["ends"].append((right, interface.name, interface.type))
    for proof in (proof for proof in _proofs(built) if proof["kind"] == "mock"):
        nodes[proof["node"]]["parameters"] = {"robot_description": f"<plugin>{proof['plugins'][0]}</plugin>"}
    for manager in cell.managers:
        asked = (
            (f"{manager.node}/{verb}", f"controller_manager_msgs/srv/{kind}") for verb, kind in _OF_MANAGER.items()
        )
        nodes[manager.node]["ends"] += [("reply", name, kind) for name, kind in asked]
    home = {controller.full_name: manager.node for manager in cell.managers for controller in manager.controllers}
    found: dict[str, list[Node]] = {}
    for full_name, node in nodes.items():
        found.setdefault(f"/{cell.name}{home.get(full_name, full_name)}", []).append(node)
    return found


def _node(full_name: str, lifecycle: bool = False) -> Node:
    namespace, _, name = full_name.rpartition("/")
    return {"name": name, "namespace": namespace, "lifecycle": lifecycle, "ends": []}


def _proofs(built: Build) -> Iterator[Any]:
    for step in proven(plan(built.cell, built.distro), "mock"):
        yield from (*step["proof"], *step.get("effect", ()))


def world(built: Build) -> dict[str, Any]:
    """Return what stand-ins say, and what their managers list, so that each step of the mock finds its proof."""
    cell, proofs = built.graph.cell, list(_proofs(built))
    asked = [step.get("request") or {} for step in plan(built.cell, built.distro)["mock"]]
    activated = {request.get("component") for request in asked}
    frames = [(proof["parent"], proof["child"]) for proof in proofs if proof["kind"] == "transform"]
    joints = [joint.name for device in cell.devices for joint in device.joints]
    at = {"name": joints, "position": [0.1] * len(joints), "velocity": [0.0] * len(joints)}
    says = {interface.name: at for interface in cell.interfaces if interface.type == "sensor_msgs/msg/JointState"}
    listed = {}
    for manager in cell.managers:
        own = {
            proof["component"] for proof in proofs if proof["kind"] == "hardware" and proof["manager"] == manager.node
        }
        hardware = {one: "inactive" if one in activated else "active" for one in own}
        controllers = {controller.name: "inactive" for controller in manager.controllers}
        listed[manager.node] = {"controllers": controllers, "hardware": hardware}
    return {"says": {**says, "/tf_static": {"transforms": frames}}, "managers": listed}


def without(policy: str, enclave: str, right: str, name: str) -> str:
    """Return a policy in which an enclave lacks one right to one name; the right is there before."""
    root, gone = fromstring(policy), 0
    for profile in root.iterfind(f".//enclave[@path='{enclave}']/profiles/profile"):
        own = f"{profile.attrib['ns'].rstrip('/')}/{profile.attrib['node']}"
        for names in [one for one in profile if one.get(right) == "ALLOW"]:
            for entry in [one for one in names if (one.text or "").replace("~", own) == name]:
                names.remove(entry)
                gone += 1
            if not len(names):  # the schema of sros2 knows no empty list
                profile.remove(names)
    assert gone, (enclave, right, name)
    return tostring(root, encoding="unicode")
