"""The valid documents that inputs start from: cells, devices with a cell, descriptions, generated folders."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

from cellc.compiler.catalog.compiled import compiled_device
from cellc.compiler.catalog.load import device_names
from tests.cells import CELLS, CORPUS, ROOT, catalog_facts, spec_text
from tests.robustness.fuzz.tree import Tree, copied, read_yaml

PARTS = CORPUS / "valid" / "parts"
_CATALOG = ROOT / "cellc" / "compiler" / "catalog"
_HEAD = "format: 1\ncell: fuzzed\nversions: {ros: jazzy}\n"
TINY = (
    _HEAD + "devices:\n  camera: {model: ./parts/demo_camera, mount: {parent: world, xyz: 0 0 1 m}}\n"
    "frames:\n  tray: {parent: world, xyz: 450 100 850 mm}\n  lamp: {parent: tray, xyz: 0 0 1 m, rpy: 0 90 0 deg}\n"
    "nodes:\n  seer: {run: cell/seer, host: pc, owner: vision}\n  taker: {run: cell/taker, host: pc}\n"
    "hosts:\n  pc: {nics: {bulk: {address: 10.0.0.2/24, carries: [camera]}}}\n"
    "interfaces:\n  /pose:\n    topic: geometry_msgs/msg/PoseStamped\n"
    "    from: {seer: {reliability: reliable, depth: 1, deadline: 1 s}}\n"
    "    to: {taker: {deadline: 1 s}}\n    rate: 10 Hz\n    max_age: 200 ms\n    on_stale: reject_goal\n"
    "    frame: tray\n",
    _HEAD
    + "devices:\n  stage: {model: ./parts/stage, mount: {parent: world, xyz: 0 0 0.8 m}, limits: {velocity: 50 %}}\n"
    "control:\n  update_rate: 500 Hz\n  controllers:\n    joint_states: {type: joint_state_broadcaster}\n"
    "    moves: {type: joint_trajectory, device: stage, goal_time: 1 s, path_tolerance: 0.2 rad,\n"
    "      goal_tolerance: 0.01 rad, joints: [stage/turn]}\n"
    "motion:\n  groups: {all: {base: stage/base, tip: stage/arm}}\n"
    "  poses: {ready: {all: 10 deg}, back: {all: 0.2 rad}}\n"
    "scene:\n  table: {parent: world, xyz: 2 0 0 m, box: 800 600 20 mm}\n"
    "rehearsals:\n  there: {steps: [{move: ready}, {wait: 100 ms}, {move: back}], timeout: 20 s}\n",
    _HEAD + "devices:\n  stage: {model: ./parts/stage, simulated_joints: {turn: {lag: 10 ms}}}\n"
    "network: {domain_id: 42, discovery: localhost}\nkpis: {cancel: 200 ms}\n"
    "owners: {responsibilities: {frames: vision, limits: controls}, approvals: {graph: controls}}\n"
    "safety:\n  recovery: {states: [fault, protective_stop, emergency_stop], acknowledge: operator, owner: safety,\n"
    "    observer: operator}\n",
)
"""Cells that check in milliseconds, which most inputs start from."""


_TOLERANCES: dict[str, Tree] = {"goal_time": "1 s", "path_tolerance": "0.2 rad", "goal_tolerance": "0.01 rad"}


@dataclass(frozen=True)
class DeviceBase:
    """A folder of a device, whose description is URDF, and a cell that has the device."""

    facts: Tree
    urdf: str
    spec: Tree


@dataclass(frozen=True)
class FolderBase:
    """The files of a generated folder."""

    files: dict[str, bytes]


@cache
def specs() -> tuple[Tree, ...]:
    """Return the specs, small ones first."""
    corpus = [_merged(file) for file in sorted((CORPUS / "valid").glob("*.yaml"))]
    cells = [read_yaml(spec_text(cell)) for cell in CELLS]
    return (*map(read_yaml, TINY), *cells, *corpus)


@cache
def _merged(file: Path) -> Tree:
    """Return a spec of the corpus with its includes merged in, as a spec beside a folder ``parts``."""
    folder = "" if file.parent.name == "parts" else "parts/"
    root = read_yaml(re.sub(r"\./(?!parts/)(\w+)", r"./parts/\1", file.read_text(encoding="utf-8-sig")))
    assert isinstance(root, dict)
    include = root.pop("include", [])
    for name in include if isinstance(include, list) else [include]:
        part = copied(_merged((file.parent / str(name)).resolve()))
        assert isinstance(part, dict), folder
        for section, content in part.items():
            here = root.setdefault(section, {} if isinstance(content, dict) else content)
            if isinstance(here, dict) and isinstance(content, dict):
                here.update({key: value for key, value in content.items() if key not in here})
    return root


@cache
def devices() -> tuple[DeviceBase, ...]:
    """Return the devices of the corpus and of the catalog, small ones first."""
    own = [_own(PARTS / name) for name in ("stage", "demo_gripper", "demo_camera", "odd_stage", "demo_arm")]
    more = [
        _own(folder) for folder in sorted((CORPUS / "invalid" / "base").iterdir()) if (folder / "device.yaml").exists()
    ]
    return (*own, *more, *map(_of_catalog, device_names()))


def _own(folder: Path) -> DeviceBase:
    facts = read_yaml((folder / "device.yaml").read_text(encoding="utf-8"))
    assert isinstance(facts, dict)
    description = facts["description"]
    assert isinstance(description, dict)
    urdf = (folder / str(description["file"])).read_text(encoding="utf-8")
    return _base(facts, urdf)


def _of_catalog(name: str) -> DeviceBase:
    facts = {key: value for key, value in catalog_facts(name).items() if key != "family"}
    compiled = compiled_device(name)
    assert compiled is not None
    return _base(facts, compiled[1])


def _base(facts: dict[str, Tree], urdf: str) -> DeviceBase:
    facts["description"] = {"file": "device.urdf"}
    spec = read_yaml(_HEAD)
    assert isinstance(spec, dict)
    device: dict[str, Tree] = {"model": "./device"}
    kind = facts.get("kind")
    if kind != "arm":
        device["mount"] = {"parent": "world", "xyz": "0 0 0.5 m"}
    spec["devices"] = {"it": device}
    if "control" in facts:
        controllers: dict[str, Tree] = {"joint_states": {"type": "joint_state_broadcaster"}}
        if kind == "arm":
            controllers["moves"] = {"type": "joint_trajectory", "device": "it", **_TOLERANCES}
        elif kind == "gripper":
            controllers["grips"] = {"type": "parallel_gripper", "device": "it"}
        spec["control"] = {"update_rate": "500 Hz", "controllers": controllers}
    tool = facts.get("tool_frame")
    if kind == "arm" and tool:
        spec["motion"] = {"groups": {"all": {"base": f"it/{facts['base']}", "tip": f"it/{tool}"}}}
    return DeviceBase(facts, urdf, spec)


@cache
def descriptions() -> tuple[ElementTree.Element, ...]:
    """Return the descriptions of all devices as trees, none of them to be changed."""
    return tuple(ElementTree.fromstring(device.urdf) for device in devices())


@cache
def xacros() -> tuple[str, ...]:
    """Return xacro files: one with a bit of everything, and those of the catalog."""
    files = sorted((_CATALOG / "devices").glob("*/*.xacro"))
    catalog = [file.read_text(encoding="utf-8").replace("../shapes.xacro", "shapes.xacro") for file in files]
    return (_ROBOT, _ROBOT, _ROBOT, *catalog)


def xacro_files() -> dict[str, bytes]:
    """Return what stands beside a xacro file."""
    return {
        "device/part.xacro": _PART.encode(),
        "device/facts.yaml": b"length: 0.4\nangles: [!degrees 90, 0.1]\nnested: {mass: 2}\n",
        "device/shapes.xacro": (_CATALOG / "devices" / "shapes.xacro").read_bytes(),
    }


_XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
_PART = (
    f'<robot {_XACRO}><xacro:macro name="ball" params="r:=0.05"><collision><geometry>'
    '<sphere radius="${r}"/></geometry></collision></xacro:macro></robot>'
)
_ROBOT = f"""<robot {_XACRO} name="demo">
  <xacro:arg name="size" default="1.0"/>
  <xacro:include filename="part.xacro"/>
  <xacro:property name="size" value="$(arg size)"/>
  <xacro:property name="facts" value="${{xacro.load_yaml('facts.yaml')}}"/>
  <xacro:macro name="leg" params="name parent *where size:=1 **more">
    <link name="${{name}}"><xacro:ball r="${{0.05 * size}}"/><xacro:insert_block name="more"/></link>
    <joint name="${{name}}_joint" type="revolute">
      <xacro:insert_block name="where"/>
      <parent link="${{parent}}"/> <child link="${{name}}"/> <axis xyz="0 0 1"/>
      <limit lower="${{-pi}}" upper="${{radians(90)}}" velocity="${{facts['nested']['mass'] * 2}}" effort="1"/>
    </joint>
  </xacro:macro>
  <link name="base"/>
  <xacro:leg name="arm" parent="base"><origin xyz="0 0 ${{size}}"/><more/></xacro:leg>
  <xacro:if value="${{size > 0.5 and facts['length'] == 0.4}}">
    <xacro:leg name="hand" parent="arm"><origin xyz="${{sin(facts['angles'][0])}} 0 0"/><more/></xacro:leg>
  </xacro:if>
  <xacro:unless value="true"><link name="never"/></xacro:unless>
</robot>
"""


@cache
def folders() -> tuple[FolderBase, ...]:
    """Return the generated folders of the repository."""
    return tuple(
        FolderBase(
            {
                file.relative_to(folder).as_posix(): file.read_bytes()
                for file in sorted(folder.rglob("*"))
                if file.is_file()
            }
        )
        for folder in sorted((ROOT / "generated").iterdir())
        if (folder / "contract.json").exists()
    )
