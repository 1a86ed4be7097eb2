"""YAML read by a parser that is not cellc's: libyaml, which ROS reads parameters with, where PyYAML was built with it.

PyYAML's own parser reads the same and takes ten times as long.
"""

from __future__ import annotations

from typing import Any

import yaml

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def safe_load(text: str) -> Any:
    """Return what a text says."""
    return yaml.load(text, Loader=LOADER)
