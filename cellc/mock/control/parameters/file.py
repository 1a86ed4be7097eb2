"""A ROS parameter file and its match to node names, by rcl_yaml_param_parser and rcl_yaml_node_match.

PyYAML is used for the grammar alone: its nodes are typed here, since its own resolver is YAML 1.1 with other rules.
"""

from __future__ import annotations

from typing import TypeAlias, cast

import yaml

from cellc.contract.errors import ReasonError
from cellc.mock.control.parameters.declaration import ParameterValue, scalar


class ParameterFileError(ReasonError):
    """The file is not one; a node that is given it ends before it starts.

    Args:
        reason: the message.
    """


_MAX_DEPTH = 64
"""Deeper files would exhaust the stack; no controller has parameters of a tenth of it."""


_Loader: TypeAlias = "type[yaml.SafeLoader | yaml.CSafeLoader]"


def _compose(text: str) -> yaml.Node | None:
    """Return the root of the file; libyaml reads it where it is there, as in rcl, and says less of an error."""
    try:
        return _compose_with(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except yaml.YAMLError:
        return _compose_with(text, yaml.SafeLoader)


def _compose_with(text: str, loader: _Loader) -> yaml.Node | None:
    _refuse_aliases_and_depth(text, loader)
    return yaml.compose(text, Loader=loader)


def _refuse_aliases_and_depth(text: str, loader: _Loader) -> None:
    depth = 0
    for event in yaml.parse(text, Loader=loader):
        line = 1 if event.start_mark is None else event.start_mark.line + 1
        if isinstance(event, yaml.AliasEvent):
            raise ParameterFileError(f"Will not support aliasing at line {line}")
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > _MAX_DEPTH:
            raise ParameterFileError(f"Values are nested more than {_MAX_DEPTH} deep at line {line}")


def _line(node: yaml.Node) -> int:
    return int(node.start_mark.line) + 1


def _sequence(node: yaml.SequenceNode) -> ParameterValue:
    values = []
    for item in node.value:
        if not isinstance(item, yaml.ScalarNode):
            raise ParameterFileError(f"Sequences can not be nested. Error at line {_line(item)}")
        values.append(scalar(item.value, bool(item.style)))
    if len({type(value) for value in values}) > 1:
        raise ParameterFileError(f"Sequence should be of same type. Value type at line_num {_line(node)}")
    return cast("ParameterValue", values)  # the items were just seen to be of one type


def _parameters(node: yaml.MappingNode, prefix: str) -> dict[str, ParameterValue]:
    parameters: dict[str, ParameterValue] = {}
    for key, value in node.value:
        name = f"{prefix}{key.value}"
        if isinstance(value, yaml.MappingNode):
            parameters.update(_parameters(value, f"{name}."))
        elif isinstance(value, yaml.SequenceNode):
            parameters[name] = _sequence(value)
        elif value.value == "" and not value.style:
            raise ParameterFileError(f"No value at line {_line(value)}")
        else:
            parameters[name] = scalar(value.value, bool(value.style))
    return parameters


def _sections(node: yaml.Node, path: str) -> list[tuple[str, dict[str, ParameterValue]]]:
    if not isinstance(node, yaml.MappingNode):
        raise ParameterFileError(f"Cannot have a value before ros__parameters at line {_line(node)}")
    sections: list[tuple[str, dict[str, ParameterValue]]] = []
    for key, value in node.value:
        if key.value == "ros__parameters":
            if not isinstance(value, yaml.MappingNode):
                raise ParameterFileError(f"Cannot have a value before ros__parameters at line {_line(value)}")
            sections.append((path, _parameters(value, "")))
        elif isinstance(value, yaml.SequenceNode):
            raise ParameterFileError(
                f"Sequences can only be values and not keys in params. Error at line {_line(value)}"
            )
        else:
            child = key.value if key.value.startswith("/") or not path else f"/{key.value}"
            sections.extend(_sections(value, f"{path}{child}"))
    return sections


def _matches(pattern: str, full_name: str) -> bool:
    """Match a node key: `*` is one token, `**` any number of them, also none; in time that does not explode."""
    names = full_name.lstrip("/").split("/")
    reached = {0}
    for token in pattern.lstrip("/").split("/"):
        if token == "**":
            reached = set(range(min(reached), len(names) + 1))
        else:
            reached = {place + 1 for place in reached if place < len(names) and _token_matches(token, names[place])}
        if not reached:
            return False
    return len(names) in reached


def _token_matches(token: str, name: str) -> bool:
    """Match one token, in which a star represents one character or more: each part is taken where it comes first."""
    first, *rest = token.split("*")
    if not rest:
        return token == name
    if not name.startswith(first):
        return False
    end = len(first)
    for part in rest[:-1]:
        place = name.find(part, end + 1)
        if place < 0:
            return False
        end = place + len(part)
    return name.endswith(rest[-1]) and len(name) - len(rest[-1]) > end


def _root(text: str) -> yaml.Node | None:
    if any("\t" in line[: len(line) - len(line.lstrip())] for line in text.splitlines()):
        raise ParameterFileError("found character that cannot start any token (tab)")
    try:
        return _compose(text)
    except yaml.MarkedYAMLError as error:
        line = 1 if error.problem_mark is None else error.problem_mark.line + 1
        raise ParameterFileError(f"Error parsing a event near line {line}: {error.problem}") from None
    except yaml.YAMLError as error:
        raise ParameterFileError(f"Error parsing a event: {' '.join(str(error).split())}") from None


class ParameterFile:
    """The text of one parameter file.

    Args:
        text: the file; empty text is a file without any parameter.

    Raises:
        ParameterFileError: where rcl would refuse the file, which ends the node.
    """

    def __init__(self, text: str) -> None:
        root = _root(text)
        self._sections = [] if root is None else _sections(root, "")

    def of_node(self, name: str, namespace: str) -> dict[str, ParameterValue]:
        """The parameters for one node, later sections winning.

        Args:
            name: name of the node.
            namespace: its namespace, "" or "/" for the root.

        Returns:
            Values by full parameter name, with dots.
        """
        full_name = f"{namespace.rstrip('/')}/{name}"
        merged: dict[str, ParameterValue] = {}
        for pattern, values in self._sections:
            if _matches(pattern, full_name):
                merged.update(values)
        return merged
