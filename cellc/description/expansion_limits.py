"""Bounds of one expansion; a large real robot stays below a tenth of each."""

from __future__ import annotations

MAX_MACRO_DEPTH = 100
MAX_INCLUDE_DEPTH = 32
MAX_ELEMENTS = 50_000
