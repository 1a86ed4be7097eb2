"""The type of data that a YAML document holds once positions and styles are gone."""

from __future__ import annotations

from typing import TypeAlias, Union

PlainScalar: TypeAlias = Union[None, bool, int, float, str]

Plain: TypeAlias = Union[None, bool, int, float, str, list["Plain"], dict[str, "Plain"]]
"""What YAML 1.2 core can say; every mapping has string keys."""
