"""The JSON Schema of ``device.yaml``, and its reference as a page."""

from __future__ import annotations

import json

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.spec.reference import reference_page
from cellc.compiler.spec.schema import tidy
from cellc.contract.base import DIALECT

_INTRODUCTION = """\
<!-- Written by `cellc schema device --reference` from the models of cellc/catalog; do not edit. -->

# The keys of device.yaml

A device of your own is a folder with a `device.yaml` and a description; [Your own robot](own_robot.md) shows how
`cellc import` writes one. Every key is explained below. Keys that must be written are bold; the model of a
family leaves to the family what it shares. `null` removes a value of the family.

- **Quantities** carry their unit: `500 Hz`, `0 0 162 mm`. The tables name the units.
- **Names** of links, joints, sensors and gpios have no prefix.
- **Placeholders** in texts are filled for each device of a cell: `{device}` is its name, `{prefix}` what its ROS names
  begin with, `{address}` and `{port}` its connection, `{host_address}` the card of the host.
- **Every fact names its source**: a document with its version, or a line of code.
- **Kinds of controllers** are those of [the catalog](catalog/controllers.md) and those of `controllers`.
"""


def device_schema() -> str:
    """Return the JSON Schema (2020-12) of a ``device.yaml``, a folder of the user's own."""
    whole = DeviceModel.model_json_schema()
    # What the model of a family does not say, its family does.
    whole |= {"if": {"required": ["family"]}, "then": {"required": ["model"]}, "else": {"required": whole["required"]}}
    del whole["required"]
    schema = {"$schema": DIALECT, **whole, "title": "Device"}
    # JSON Schema's engines end a text with `$`, Python's with `\\Z`.
    return json.dumps(schema, indent=2, ensure_ascii=False).replace('\\\\Z"', '$"') + "\n"


def device_reference() -> str:
    """Return the page."""
    schema = tidy(DeviceModel.model_json_schema())
    assert isinstance(schema, dict)
    return reference_page(_INTRODUCTION, schema, DeviceModel)
