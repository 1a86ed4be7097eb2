"""What an observation may speak of: scopes of a cell, and the fields of each, such as the name of a topic."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

Scope = Literal[
    "cell",
    "host",
    "topic",
    "action",
    "controller",
    "trajectory",
    "manager",
    "group",
    "frame",
    "node",
    "lifecycle_node",
    "device",
    "arm",
    "gripper",
    "camera",
]
Subject = Mapping[str, str]
"""Field → text; the first field is the subject's name."""

NOT_STATED = "not stated"
"""Value of a field that a cell does not have: no observation speaks of it."""

_CONTROLLER = ("controller", "node", "manager", "plugin", "joints", "claims", "path_tolerance")
_DEVICE = ("device", "address", "modes", "states", "firmware", "driver", "payload")

FIELDS: dict[Scope, tuple[str, ...]] = {
    "cell": ("cell", "domain_id", "rmw", "discovery", "tf_publishers", "stop_authority", "observer"),
    "host": ("host", "scheduling", "cards", "max_offset"),
    "topic": ("topic", "type", "publishers", "qos", "rate", "max_age"),
    "action": ("action", "server", "client"),
    "controller": _CONTROLLER,
    "trajectory": _CONTROLLER,
    "manager": ("manager", "namespace", "rate", "components"),
    "group": ("group", "joints", "tip"),
    "frame": ("frame", "parent", "authority", "calibration"),
    "node": ("node",),
    "lifecycle_node": ("node",),
    "device": _DEVICE,
    "arm": _DEVICE,
    "gripper": _DEVICE,
    "camera": ("topic", "frame", "rate", *_DEVICE),
}
"""Which fields an observation of each scope may name."""


def placeholders(scope: Scope) -> Subject:
    """Return the subject that represents all, where no cell is given."""
    return {field: f"<{field}>" for field in FIELDS[scope]}
