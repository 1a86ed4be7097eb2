"""What the files of a folder say, as names and values, and how that differs from what is executed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from cellc.contract.bring_up import BringUpStep, Target, Watch
from cellc.contract.contract import Contract
from cellc.mock.control.parameters import ParameterFile, ParameterFileError, flat
from cellc.mock.errors import MockError
from cellc.robot.description.model import Description
from cellc.robot.description.xml_tree import XmlElement, read_xml

CONTRACT = "contract.json"

Said = str | bool | int | float | Sequence["Said"] | None
Names = Mapping[str, Said]

_CLOSE = 1e-9
"""By which two figures may differ that were written with other digits, relative and absolute."""


@dataclass(frozen=True, slots=True)
class Edited:
    """An edited folder.

    Attributes:
        texts: text of every file that is compared, by path.
        listed: paths of all files that were generated.
        description: what the URDF says that is executed.
        real, watches: the steps and watches of the real target.
    """

    contract: Contract
    description: Description
    mock: tuple[BringUpStep, ...]
    real: tuple[BringUpStep, ...]
    watches: tuple[Watch, ...]
    texts: Mapping[str, str]
    listed: frozenset[str]

    def steps(self, target: Target) -> tuple[BringUpStep, ...]:
        """Return the steps of the bring-up on a target."""
        return self.mock if target == "mock" else self.real


def differing(said: Names, executed: Names, prefix: str = "", by: str = CONTRACT) -> Iterator[str]:
    """Yield what a file says otherwise than what is executed, one name each.

    Args:
        prefix: before the names in the message.
        by: file that says what is executed.
    """
    for name in (*executed, *(text for text in said if text not in executed)):
        if name not in said:
            yield f"`{prefix}{name}` is missing, `{by}` has {_shown(executed[name])}"
        elif name not in executed:
            yield f"`{prefix}{name}` must not be there as `{by}` has none, got {_shown(said[name])}"
        elif not same(said[name], executed[name]):
            yield f"`{prefix}{name}` must be {_shown(executed[name])} as in `{by}`, got {_shown(said[name])}"


def same(one: Said, other: Said) -> bool:
    """Tell whether two values mean the same; figures may be written with other digits."""
    for kind in (str, bool):
        if isinstance(one, kind) or isinstance(other, kind):
            return isinstance(one, kind) and isinstance(other, kind) and one == other
    if isinstance(one, Sequence) and isinstance(other, Sequence):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return math.isclose(one, other, rel_tol=_CLOSE, abs_tol=_CLOSE)
    return one is other


def below(names: Names, prefix: str) -> dict[str, Said]:
    """Return the names below a prefix, without it."""
    return {name.removeprefix(prefix): value for name, value in names.items() if name.startswith(prefix)}


def parameters(file: str, text: str, node: str) -> Names:
    """Return what a ROS parameter file says to a node.

    Raises:
        MockError: no node could be started with it.
    """
    try:
        namespace, _, name = node.rpartition("/")
        return dict(ParameterFile(text).of_node(name, namespace))
    except ParameterFileError as error:
        raise MockError(file, error.reason) from None


def plain(file: str, text: str) -> Names:
    """Return the names and values of a YAML file, nesting as dots.

    Raises:
        MockError: it is none, or has aliases.
    """
    try:
        return dict(flat(text))
    except ParameterFileError as error:
        raise MockError(file, error.reason) from None


def xml(file: str, text: str) -> XmlElement:
    """Return the root of an XML file.

    Raises:
        MockError: it is not well-formed.
    """
    read = read_xml(text, file)
    if read.value is None:
        found = read.diagnostics[0]
        raise MockError(file, f"line {found.span.line}: {found.message}")
    return read.value


def _shown(value: Said) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f"`{value}`"
    if isinstance(value, Sequence):
        return f"({', '.join(map(_shown, value))})"
    return "none" if value is None else f"{value:.12g}"
