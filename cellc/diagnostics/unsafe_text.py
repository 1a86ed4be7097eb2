"""Text that other programs would run or hide: what no value of a spec, a device or a description may hold.

``xacro``, ``ros2 launch`` and shells replace ``${…}`` and ``$(…)`` by what they evaluate, on the host that starts the
cell. Control characters and direction marks make a reviewer see something else than what programs read.
"""

from __future__ import annotations

import re

# What YAML 1.2.2, production c-printable, leaves out, and what only hides text: Unicode line separators (YAML 1.1
# breaks lines there, 1.2 does not), text direction marks, and a byte order mark in the middle of the text.
HIDDEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufeff\ufffe\uffff]"
)
# xacro stops at `$$` with anything else than a bracket behind it.
_SUBSTITUTION = re.compile(r"\$[{($]")


def hidden(text: str) -> str | None:
    """Say which character hides text; None where there is none."""
    match = HIDDEN.search(text)
    return None if match is None else f"the text holds the character U+{ord(match[0]):04X}"


def substitution(text: str) -> str | None:
    """Say that a text holds what xacro, ros2 launch or a shell would evaluate; None where it does not."""
    match = _SUBSTITUTION.search(text) if "$" in text else None
    return None if match is None else f"`{match[0]}` begins what xacro, ros2 launch or a shell would evaluate"
