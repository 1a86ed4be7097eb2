"""Plays the graph of a package with the real client library: nodes, topics, services and transforms as it states them.

Run as a program: ``played_graph.py PACKAGE TARGET WRONG``. WRONG names what is played otherwise, and is empty for none.
"""

from __future__ import annotations

import ctypes
import importlib
import json
import math
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import rclpy
import yaml
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy


def loaded(kind: str) -> Any:
    """Return the class of an interface type; None where it is not installed."""
    package, part, name = kind.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{part}"), name)
    except (ImportError, AttributeError):
        return None


def profile(qos: Any) -> QoSProfile:
    """Return the profile of an end as the contract states it."""
    return QoSProfile(
        depth=qos["depth"],
        reliability=ReliabilityPolicy[qos["reliability"].upper()],
        durability=DurabilityPolicy[qos["durability"].upper()],
    )


class Played:
    """All nodes of a target in one process."""

    def __init__(self, folder: Path, target: str, wrong: str) -> None:
        self.contract = json.loads((folder / "contract.json").read_text())
        self.plan = json.loads((folder / "config/observe.json").read_text())[target]
        self.description = (folder / self.contract["files"][f"urdf_{target}"]).read_text()
        self.wrong = wrong
        self.context = Context()
        rclpy.init(context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.nodes: dict[str, Node] = {}
        self.says: list[tuple[float, Any]] = []
        self.kept: list[Any] = []
        early = {
            node
            for sides in self.plan["ends"].values()
            for nodes in sides.values()
            for node, since in nodes.items()
            if since < "G6" or wrong == f"early:{node}"  # nothing is claimed and nothing moves in what is played
        }
        later = {node for sides in self.plan["ends"].values() for nodes in sides.values() for node in nodes} - early
        names = [name for name in self.plan["nodes"] if wrong != f"missing:{name}" and name not in later]
        for name in [*names, *(["/stranger"] if wrong == "stranger" else [])]:
            self.join(name)
        if wrong == "twin":
            self.join(names[0] + "_", called=names[0])
        self.parameters(folder, target)

    def join(self, name: str, called: str = "") -> None:
        """Start a node."""
        home, _, bare = (called or name).rpartition("/")
        node = Node(
            bare, namespace=home or "/", context=self.context, allow_undeclared_parameters=True, enable_rosout=False
        )
        self.nodes[name] = node
        if self.wrong == f"sim_time:{name}":
            node.set_parameters([Parameter("use_sim_time", value=True)])
        self.executor.add_node(node)

    def parameters(self, folder: Path, target: str) -> None:
        """Give each node the values of its file."""
        for file in sorted((folder / "config").rglob("*.yaml")):
            if file.stem.partition(".")[2] in ("", target):  # the others are those of another target
                self.section("", yaml.safe_load(file.read_text()))

    def section(self, name: str, part: Any) -> None:
        """Declare what a section of a parameter file has."""
        for key, inner in part.items() if isinstance(part, dict) else ():
            if key != "ros__parameters":
                self.section(f"{name}/{key.strip('/')}", inner)
            elif name in self.nodes:
                self.declare(self.nodes[name], "", inner)

    def declare(self, node: Node, above: str, part: Any) -> None:
        """Declare parameters, one of them with another number where that is what is wrong."""
        for key, inner in part.items():
            if isinstance(inner, dict):
                self.declare(node, f"{above}{key}.", inner)
                continue
            if self.wrong == "parameter" and isinstance(inner, (int, float)) and not isinstance(inner, bool):
                self.wrong, inner = "done", inner * 2 + 1
            node.declare_parameter(f"{above}{key}", inner)

    def ends(self) -> None:
        """Open the ends of every interface."""
        for name, sides in self.plan["ends"].items():
            interface = self.contract["interfaces"][name]
            kind = loaded(interface["type"])
            if kind is None:
                continue
            for side in ("sources", "sinks"):
                stated = {each["full_name"]: each["qos"] for each in interface.get(side, ())}
                for node in sides[side]:
                    if node in self.nodes:
                        self.end(name, interface, kind, side, node, stated.get(node))
        if self.wrong == "second_publisher":
            name = next(
                each for each, facts in self.contract["interfaces"].items() if facts["type"].endswith("JointState")
            )
            self.nodes["/robot_state_publisher"].create_publisher(loaded("sensor_msgs/msg/JointState"), name, 10)
        if self.wrong in ("second_server", "commander"):
            action = next(
                each for each, facts in self.contract["interfaces"].items() if facts["type"].endswith("Trajectory")
            )
            side = {"second_server": "sources", "commander": "sinks"}[self.wrong]
            self.end(action, {"kind": "action"}, None, side, "/robot_state_publisher", None)

    def end(self, name: str, interface: Any, kind: Any, side: str, node: str, qos: Any) -> None:
        """Open one end."""
        owner = self.nodes[node]
        if interface["kind"] == "topic":
            stated = profile(qos or {"depth": 10, "reliability": "reliable", "durability": "volatile"})
            if self.wrong == f"qos:{name}" and side == "sources":
                stated.reliability = ReliabilityPolicy.BEST_EFFORT
            if self.wrong == f"volatile:{name}" and side == "sources":
                stated.durability = DurabilityPolicy.VOLATILE
            if side == "sources":
                with redefined(kind) if self.wrong == f"hash:{name}" else nullcontext():
                    publisher = owner.create_publisher(kind, name, stated)
                self.publish(name, interface, kind, publisher)
            else:
                owner.create_subscription(kind, name, lambda _: None, stated)
        elif interface["kind"] == "service":
            make = owner.create_service if side == "sources" else owner.create_client
            make(kind, name, *([partial(self.tell, name)] if side == "sources" else []))
        else:
            status = loaded("action_msgs/msg/GoalStatusArray")
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            make = owner.create_publisher if side == "sources" else partial(owner.create_subscription, callback=print)
            make(status, f"{name}/_action/status", qos_profile=latched)

    def publish(self, name: str, interface: Any, kind: Any, publisher: Any) -> None:
        """Say what a topic with a rate says, in its rate, and once what a device says of itself."""
        if any(reading["interface"] == name for reading in self.plan.get("readings", ())):
            publisher.publish(self.tell(name, None, kind()))
            self.kept.append(publisher)
        if interface.get("rate_hz") is None or self.wrong == f"silent:{name}":
            return
        message, joints = kind(), kind.__name__ == "JointState"
        if joints:
            message.name = sorted(
                {
                    joint
                    for manager in self.contract["managers"].values()
                    for each in manager["controllers"].values()
                    for joint in each["joints"]
                }
            )[1 if self.wrong == "joint" else 0 :]
            message.position = [self.position(joint) for joint in message.name]
        header = getattr(message, "header", None)
        if header is not None:
            header.frame_id = "elsewhere" if self.wrong == f"frame:{name}" else interface.get("frame") or ""
        late_s = 1.0 if self.wrong == f"late:{name}" else -1.0 if self.wrong == f"future:{name}" else 0.0
        rate = interface["rate_hz"] * (0.5 if self.wrong == f"slow:{name}" else 1.0)

        def say() -> None:
            if header is not None:
                now = time.time() - late_s
                header.stamp.sec, header.stamp.nanosec = int(now), int(now % 1.0 * 1e9)
            if joints and self.wrong == "moving":
                message.position[0] += 0.0001
            if joints and self.wrong == "nan":
                message.position[0] = math.nan
            publisher.publish(message)

        self.says.append((1.0 / rate, say))

    def tell(self, name: str, _: Any, message: Any) -> Any:
        """Fill a message or an answer with what a device says of itself at G4, or with something else."""
        for reading in self.plan.get("readings", ()):
            if reading["interface"] == name:
                due = [names for since, names in sorted(reading.get("expected", {}).items()) if since <= "G4"]
                values = [reading["values"][due[-1][0]]] if due else [1.0]
                if "version" in reading:
                    pinned = self.contract["version_tuple"][reading["version"]].rpartition(" ")[2]
                    values = [int(part) for part in pinned.split(".")]
                if "values" in reading and not due:
                    values = [next(iter(reading["values"].values()))]
                if self.wrong == f"says:{name}":
                    values = [values[0] + 4, *values[1:]]  # SAFEGUARD_STOP, RUNNING, another major version
                for field, value in zip(reading["fields"], values, strict=True):
                    setattr(message, field, value)
        return message

    def position(self, joint: str) -> float:
        """Return a position within the limits of a joint."""
        limits = self.contract["joint_limits"].get(joint, {})
        low, high = (float(limits.get(end, 0.0)) for end in ("lower", "upper"))
        return high + 0.1 if self.wrong == "beyond" and "upper" in limits else (low + high) / 2.0

    def transforms(self) -> None:
        """Say every transform of the description."""
        kind, stamped = loaded("tf2_msgs/msg/TFMessage"), loaded("geometry_msgs/msg/TransformStamped")
        node = self.nodes["/robot_state_publisher"]
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        topics = {
            True: node.create_publisher(kind, "/tf_static", latched),
            False: node.create_publisher(kind, "/tf", 100),
        }
        messages = {True: kind(), False: kind()}
        for joint in ElementTree.fromstring(self.description).iterfind("joint"):
            parent, child, origin = joint.find("parent"), joint.find("child"), joint.find("origin")
            assert parent is not None
            assert child is not None
            each = stamped(child_frame_id=child.get("link"))
            each.header.frame_id = "world" if self.wrong == f"parent:{child.get('link')}" else parent.get("link")
            xyz, rpy = (
                [float(text) for text in (origin.get(name, "0 0 0") if origin is not None else "0 0 0").split()]
                for name in ("xyz", "rpy")
            )
            each.transform.translation.x = xyz[0] + (0.01 if self.wrong == f"moved:{child.get('link')}" else 0.0)
            each.transform.translation.y, each.transform.translation.z = xyz[1:]
            rpy[2] += 0.01 if self.wrong == f"turned:{child.get('link')}" else 0.0
            turn(each.transform.rotation, rpy)
            if self.wrong != f"frame:{child.get('link')}":
                messages[joint.get("type") == "fixed"].transforms.append(each)
        topics[True].publish(messages[True])
        self.twice(kind, stamped, latched)
        self.says.append((0.05, partial(topics[False].publish, messages[False])))
        described = node.create_publisher(loaded("std_msgs/msg/String"), "/robot_description", latched)
        heavier = self.description.replace('<mass value="', '<mass value="1', 1)
        text = {"mass": heavier, "no XML": "<robot"}.get(self.wrong, self.description)
        described.publish(loaded("std_msgs/msg/String")(data=text))

    def twice(self, kind: Any, stamped: Any, latched: QoSProfile) -> None:
        """Have a second authority of a fixed frame say another transform."""
        if self.wrong.startswith("twice:"):
            other = stamped(child_frame_id=self.wrong.partition(":")[2])
            other.header.frame_id, other.transform.rotation.w = "world", 1.0
            self.nodes["/perception"].create_publisher(kind, "/tf_static", latched).publish(kind(transforms=[other]))

    def managers(self) -> None:
        """Answer for controller managers and managed nodes."""
        services = ("ListControllers", "ListHardwareComponents")
        listing, parts = (loaded(f"controller_manager_msgs/srv/{name}") for name in services)
        states = {
            each: loaded(f"controller_manager_msgs/msg/{each}")
            for each in ("ControllerState", "HardwareComponentState")
        }
        for manager in self.contract["managers"].values():
            name = f"{manager['namespace'].rstrip('/')}/controller_manager"
            if name not in self.nodes:
                continue
            stated = self.plan["states"][name]
            controllers, components = [], []
            for controller, state in stated["controllers"].items():
                facts = manager["controllers"][controller]
                wrong = self.wrong == f"state:{controller}"
                state = {"active": "inactive", "inactive": "active"}[state] if wrong else state
                claims = facts["command_interfaces"] if state == "active" else []
                kind = "other/Type" if self.wrong == f"type:{controller}" else facts["plugin"]
                claims = claims[1:] if self.wrong == f"claims:{controller}" else claims
                made = states["ControllerState"](name=controller, state=state, type=kind, claimed_interfaces=claims)
                controllers.append(made)
            for component, state in stated["hardware"].items():
                each = states["HardwareComponentState"](name=component)
                each.state.label = "finalized" if self.wrong == f"hardware:{component}" else state
                components.append(each)
            node = self.nodes[name]
            self.cycles(node, name, manager["update_rate_hz"])
            node.create_service(listing, f"{name}/list_controllers", answering("controller", controllers))
            node.create_service(parts, f"{name}/list_hardware_components", answering("component", components))
        for name, state in self.plan["lifecycle"].items():
            kind = loaded("lifecycle_msgs/srv/GetState")
            made = loaded("lifecycle_msgs/msg/State")(label="finalized" if self.wrong == f"lifecycle:{name}" else state)
            if name in self.nodes:
                self.nodes[name].create_service(kind, f"{name}/get_state", answering("current_state", made))

    def cycles(self, node: Node, name: str, rate: float) -> None:
        """Say what the cycles of a manager take, and what it thinks of them."""
        diagnoses, status, pair = (
            loaded(f"diagnostic_msgs/msg/{each}") for each in ("DiagnosticArray", "DiagnosticStatus", "KeyValue")
        )
        average = rate * (0.8 if self.wrong == "slow_manager" else 1.0)
        figures = {"update_rate": f"{rate:g}", "periodicity.average": f"{average:f}", "periodicity.min": f"{average:f}"}
        said = status(
            level=b"\1" if self.wrong == "irregular" else b"\0", name="controller_manager: Controller Manager Activity"
        )
        said.message = "Controller Manager has bad periodicity" if self.wrong == "irregular" else "running"
        said.values = [pair(key=key, value=value) for key, value in figures.items()]
        publisher = node.create_publisher(diagnoses, "/diagnostics", 1)
        self.says.append((0.5, partial(publisher.publish, diagnoses(status=[said]))))
        names, values = (loaded(f"pal_statistics_msgs/msg/Statistics{each}") for each in ("Names", "Values"))
        if names is not None:
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            first = node.create_publisher(names, f"{name}/statistics/names", latched)
            first.publish(names(names=["other", "controller_manager.total_time"], names_version=2))
            self.kept.append(first)
            took = node.create_publisher(values, f"{name}/statistics/values", 100)
            time_us = 1.2e6 / rate if self.wrong == "overrun" else 0.5e6 / rate
            self.says.append((0.02, partial(took.publish, values(values=[9e9, time_us], names_version=2))))

    def run(self) -> None:
        """Play until standard input ends."""
        self.ends()
        self.transforms()
        self.managers()
        for period_s, say in self.says:
            threading.Thread(target=repeat, args=(period_s, say), daemon=True).start()
        threading.Thread(target=self.executor.spin, daemon=True).start()
        print("plays", flush=True)
        sys.stdin.read()


class TypeSupport(ctypes.Structure):
    """``rosidl_message_type_support_t`` of rosidl_runtime_c since Iron."""

    _fields_ = [
        ("identifier", ctypes.c_char_p),
        ("data", ctypes.c_void_p),
        ("func", ctypes.c_void_p),
        ("get_type_hash", ctypes.c_void_p),
    ]


_HASH = ctypes.create_string_buffer(b"\1" + b"\x42" * 32, 33)
_OTHER = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)(lambda _: ctypes.addressof(_HASH))


@contextmanager
def redefined(kind: Any) -> Iterator[None]:
    """Let a type have another hash meanwhile, as one that was built from another definition."""
    kind.__class__.__import_type_support__()
    pointer = ctypes.pythonapi.PyCapsule_GetPointer
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    address = pointer(kind.__class__._TYPE_SUPPORT, None)
    handle = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p)
    inner = handle(TypeSupport.from_address(address).func)(address, b"rosidl_typesupport_fastrtps_c")
    supports = [TypeSupport.from_address(each) for each in (address, inner)]
    before = [support.get_type_hash for support in supports]
    for support in supports:
        support.get_type_hash = ctypes.cast(_OTHER, ctypes.c_void_p).value
    yield
    for support, own in zip(supports, before, strict=True):
        support.get_type_hash = own


def answering(field: str, value: Any) -> Any:
    """Return the callback of a service whose answer has a value."""

    def answer(_: Any, response: Any) -> Any:
        setattr(response, field, value)
        return response

    return answer


def repeat(period_s: float, say: Any) -> None:
    """Say something in a period, for ever."""
    due = time.monotonic()
    while True:
        say()
        due += period_s
        time.sleep(max(0.0, due - time.monotonic()))


def turn(rotation: Any, rpy: list[float]) -> None:
    """Set a quaternion: yaw after pitch after roll."""
    x, y, z, w = 0.0, 0.0, 0.0, 1.0
    for axis in (2, 1, 0):
        half = rpy[axis] / 2.0
        a, b, c, d = (math.sin(half) * (axis == each) for each in range(3)), 0, 0, math.cos(half)
        p, q, r = a
        x, y, z, w = (
            w * p + x * d + y * r - z * q,
            w * q - x * r + y * d + z * p,
            w * r + x * q - y * p + z * d,
            w * d - x * p - y * q - z * r,
        )
        del b, c
    rotation.x, rotation.y, rotation.z, rotation.w = x, y, z, w


if __name__ == "__main__":
    Played(Path(sys.argv[1]), sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else "").run()
    import os

    os._exit(0)
