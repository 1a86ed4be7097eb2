"""The type of data that a YAML document holds once positions and styles are gone."""

from __future__ import annotations

from typing import TypeAlias, Union

PlainScalar: TypeAlias = Union[bool, int, float, str, None]

Plain: TypeAlias = Union[bool, int, float, str, list["Plain"], dict[str, "Plain"], None]
"""What YAML 1.2 core can say; every mapping has string keys."""
