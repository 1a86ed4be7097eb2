"""YAML of another tool into plain values, within the limits: an alias counts as often as it is used."""

from __future__ import annotations

import math
import re
from typing import Any, TypeAlias

import yaml

from cellc.contract.errors import CellcError
from cellc.contract.limits import limits

Loader: TypeAlias = "type[yaml.SafeLoader | yaml.CSafeLoader]"
FAST: Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""The parser written in C where there is one."""


class TooManyValuesError(CellcError, ValueError):
    """A document has more values than may be read; the text says so."""


_SEXAGESIMAL = re.compile(r"[-+0-9_:.]+")
_LONGEST_NUMBER = 4300
"""Characters of a number, as many as Python reads of an integer (sys.int_info.default_max_str_digits): the value of one
to base 60, as YAML 1.1 has them, takes time by the square of its length."""


def load_values(text: str, loader: Loader = FAST, most: int | None = None, *, aliases: bool = True) -> Any:
    """Return what a YAML document holds; it must be made with a safe loader.

    Args:
        most: how many values it may have; as many as a list in xacro if None.
        aliases: whether it may have some.

    Raises:
        TooManyValuesError: it has more values than may be once its aliases are written out.
        yaml.YAMLError, ValueError, RecursionError: it cannot be read.
    """
    _refuse_events(text, loader, aliases)
    root = yaml.compose(text, Loader=loader)
    most = limits().xacro_items if most is None else most
    if _written_out(root) > most:
        raise TooManyValuesError(f"has more than {most} values where its aliases are written out")
    try:
        return yaml.load(text, Loader=loader)
    except (ArithmeticError, LookupError, AttributeError, TypeError) as error:  # `!!bool x`, `!!int ''`, `1:1:…:1.5`
        raise ValueError("a value is not of the type of its tag or its form") from error


def _refuse_events(text: str, loader: Loader, aliases: bool) -> None:
    """The parser in C goes down one call of the machine for each level, and nothing stops it."""
    depth = 0
    for event in yaml.parse(text, Loader=loader):
        if isinstance(event, yaml.AliasEvent) and not aliases:
            raise ValueError("it has an alias")
        if isinstance(event, yaml.ScalarEvent) and _is_long_number(event.value):
            raise ValueError(f"a number has more than {_LONGEST_NUMBER} characters")
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > limits().spec_depth:
            raise ValueError(f"values are nested deeper than {limits().spec_depth} levels")


def _is_long_number(text: str) -> bool:
    return len(text) > _LONGEST_NUMBER and _SEXAGESIMAL.fullmatch(text) is not None


def _written_out(root: yaml.Node | None) -> float:
    """Count the values of a document whose aliases are written out; one in itself counts without end."""
    counts: dict[int, float] = {}

    def count(node: yaml.Node) -> float:
        if id(node) not in counts:
            counts[id(node)] = math.inf  # while it is being counted
            items = node.value if isinstance(node, yaml.CollectionNode) else []
            parts = (part for item in items for part in (item if isinstance(item, tuple) else (item,)))
            counts[id(node)] = 1.0 + sum(map(count, parts))
        return counts[id(node)]

    return 0 if root is None else count(root)
