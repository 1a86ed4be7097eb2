"""Folders of specs, with devices of their own, that together use every part of the spec language and of the catalog."""

from __future__ import annotations

import re
from collections.abc import Mapping

from cellc.compiler.catalog.compiled import device_file
from tests.cells import CORPUS, ROOT, spec_text
from tests.consumers.matrix import spec_for

_VALID = CORPUS / "valid"
_DEVICES = ROOT / "cellc" / "compiler" / "catalog" / "devices"
_OWN = re.compile(r"model: (\w+)")


def variants() -> dict[str, Mapping[str, str]]:
    """Return the files of each folder by its name; the spec is ``cell.yaml``."""
    found: dict[str, Mapping[str, str]] = {
        f"{cell}-{distro}": {"cell.yaml": spec_for(cell, distro)} for cell, distro in _SPECS
    }
    found |= {f"{name} with its devices": _with_devices(spec_text(name)) for name in ("ur5e_pick", "fr3_hand")}
    more = _from_corpus("complete")
    for path, (old, new) in _MORE.items():
        assert old in more[path]
        more[path] = more[path].replace(old, new)
    return found | {"more": more} | {name: _from_corpus(name) for name in _CORPUS}


_SPECS = (
    ("ur5e_pick", "jazzy"),
    ("ur5e_pick", "humble"),
    ("minimal", "kilted"),
    ("fr3_hand", "lyrical"),
    ("two_arms", "jazzy"),
)
_CORPUS = (
    "complete",
    "every_fault",
    "more_fields",
    "parameters_of_every_type",
    "direct_sdk_with_adapter",
    "unicast_with_peers",
    "zenoh",
)
# What no spec and no description of the corpus has.
_MORE = {
    "parts/hosts_control_pc.yaml": (".10/24, carries: [control]", ".10/24, interface: enp3s0, carries: [control]"),
    "parts/interfaces_object_pose.yaml": ("wants: newest", "wants: newest\n    unit: m\n    owner: perception"),
    "parts/demo_camera/demo_camera.urdf": (
        '<link name="color_optical"/>',
        """<material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="color_optical">
    <visual name="lens"><geometry><mesh filename="package://demo_camera/lens.stl"/></geometry>
      <material name="glass"><color rgba="0 0 1 1"/></material></visual>
    <visual name="cap"><geometry><box size="0.01 0.01 0.01"/></geometry><material name="grey"/></visual>
  </link>""",
    ),
}


def _with_devices(spec: str) -> dict[str, str]:
    """Return a spec whose devices are folders of its own: copies of the catalog's."""
    files = {"cell.yaml": _OWN.sub(r"model: ./\1", spec)}
    for model in dict.fromkeys(_OWN.findall(spec)):
        own = device_file(model)
        for path in (*sorted(own.parent.iterdir()), _DEVICES / "shapes.xacro"):
            text = path.read_text(encoding="utf-8")
            name = "device.yaml" if path == own else path.name
            files[f"{model}/{name}"] = text.replace("../shapes.xacro", "shapes.xacro")
    return files


def _from_corpus(name: str) -> dict[str, str]:
    files = {"cell.yaml": (_VALID / f"{name}.yaml").read_text(encoding="utf-8")}
    parts = _VALID / "parts"
    for path in sorted(path for path in parts.rglob("*") if path.is_file()):
        if "stage" not in path.parent.name:  # devices of other specs
            files[f"parts/{path.relative_to(parts).as_posix()}"] = path.read_text(encoding="utf-8")
    return files
