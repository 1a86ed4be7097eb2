"""Elements that several nodes of the launch file have."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from cellc.emit.launch.substitutions import expanded
from cellc.formats.xml_text import element


def enclave(path: str) -> dict[str, str]:
    """Return the attribute that puts a process into its enclave.

    Without security it has no effect; with it, a process outside of its enclave is denied everything.
    """
    return {"ros_args": f"--enclave {path}"}


def description_parameter(file: str) -> Element:
    """Return the parameter that holds a description of the package, its type stated so that nobody parses it."""
    return element("param", {"name": "robot_description", "value": expanded(file), "type": "str"})


def remap(source: str, target: str) -> Element:
    """Return ``<remap>``."""
    return element("remap", {"from": source, "to": target})
