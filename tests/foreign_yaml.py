"""YAML read by a parser that is not cellc's: libyaml, which ROS reads parameters with, where PyYAML was built with it.

PyYAML's own parser reads the same and takes ten times as long.
"""

from __future__ import annotations

import pickle
from functools import lru_cache
from typing import Any

import yaml

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def safe_load(text: str) -> Any:
    """Return what a text says; it is the caller's own. Tests read the same files again and again: each is read once."""
    return pickle.loads(_read(text))


@lru_cache(maxsize=512)
def _read(text: str) -> bytes:
    return pickle.dumps(yaml.load(text, Loader=LOADER))
