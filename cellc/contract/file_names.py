"""Names of files: of a spec, and the kinds of names in the files between compiler and mock that become paths.

As with numbers, the compiler writes what its own types let through, and who reads an untrusted folder validates with
``context=limits()``: past that door a name leads to its own place, and to no other.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Annotated

from pydantic import AfterValidator, ValidationInfo
from pydantic_core import PydanticCustomError

from cellc.contract.frozen import dataclass
from cellc.contract.limits import Limits

SPEC_FILE = "cell.yaml"
"""What a spec is called where a folder is named instead of it."""
_CELL = re.compile("[a-z][a-z0-9_]{1,63}")
_LONGEST_NAME = 255
"""Bytes of one name, as most file systems have it."""
_LONGEST_PATH = 4000
_SHOWN = 80
_DEVICES = frozenset(("con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(10))))
"""Names of devices of Windows; Microsoft Learn, "Naming Files, Paths, and Namespaces"."""


def is_file_name(name: str) -> bool:
    """Whether a text names something in a folder: one part of a path, which no system takes for more."""
    if not name.isprintable() or name in ("", ".", "..") or not {"/", "\\", ":"}.isdisjoint(name):
        return False
    return len(name.encode()) <= _LONGEST_NAME


def opens_a_device(name: str) -> bool:
    """Whether Windows takes the name of a file for one of its devices, with any ending: no checkout can have it."""
    return name.partition(".")[0].rstrip(" ").casefold() in _DEVICES


def is_inside(path: str) -> bool:
    """Whether a text is a path from a folder down, with forward slashes."""
    return len(path) <= _LONGEST_PATH and all(map(is_file_name, path.split("/")))


def _is_beside(path: str) -> bool:
    return len(path) <= _LONGEST_PATH and all(part in (".", "..") or is_file_name(part) for part in path.split("/"))


def is_cell_name(name: str) -> bool:
    return _CELL.fullmatch(name) is not None


@dataclass(frozen=True, slots=True)
class _Kind:
    """What a name of one kind must be."""

    text: str
    holds: Callable[[str], bool]

    def __call__(self, name: str, info: ValidationInfo) -> str:
        """Return a name of this kind, or refuse it where a folder is read."""
        if isinstance(info.context, Limits) and not self.holds(name):
            shown = f"{name[:_SHOWN]}…" if len(name) > _SHOWN else name
            text = f"must be {self.text}, got `{shown}`"
            raise PydanticCustomError("no-path", "{text}", {"text": text})
        return name


CellName = Annotated[str, AfterValidator(_Kind("a lower-case name of letters, digits and `_`", is_cell_name))]
"""The name of a cell and of its package; folders are named by it."""
InnerPath = Annotated[str, AfterValidator(_Kind("a path inside the folder", is_inside))]
"""A file of the generated folder, with forward slashes."""
BesidePath = Annotated[str, AfterValidator(_Kind("a relative path", _is_beside))]
"""A folder outside of the generated one; whether it may be read is asked once it is found."""
