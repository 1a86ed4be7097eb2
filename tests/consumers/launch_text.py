"""Substitutions of launch XML, from the grammar of ROS 2 launch: ``$(name argument …)``, nested, arguments quoted.

A backslash before any character but a line break stands for that character alone, outside and inside of substitutions
(``replace_escaped_characters`` of launch 3.7).
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass


class LaunchError(Exception):
    """What `ros2 launch` would stop with."""


@dataclass(frozen=True, slots=True)
class World:
    """What substitutions can see: launch configurations, and what a command prints."""

    configurations: Mapping[str, str]
    run: Callable[[str], str]


def unescaped(text: str) -> str:
    """Return a text in which nothing is put in, but in which a backslash escapes too: descriptions, choices."""
    return re.sub(r"\\(.)", r"\1", text)


def expand(text: str, world: World, keep: Callable[[str], str] = str) -> str:
    """Return the text with every substitution in place, as ``keep`` writes its value."""
    value, rest = _sequence(text, world, end="", keep=keep)
    assert not rest
    return value


def _sequence(text: str, world: World, end: str, keep: Callable[[str], str] = str) -> tuple[str, str]:
    """Expand up to an unquoted character of ``end``, which stays in the rest."""
    built = ""
    while text and text[0] not in end:
        if text.startswith("$("):
            value, text = _substitution(text[2:], world)
            built += keep(value)
        elif re.match(r"\\.", text):
            built, text = built + text[1], text[2:]
        else:
            built, text = built + text[0], text[1:]
    return built, text


def _substitution(text: str, world: World) -> tuple[str, str]:
    name = ""
    while text and (text[0].isalnum() or text[0] in "-_"):
        name, text = name + text[0], text[1:]
    arguments: list[str] = []
    while text and text[0] != ")":
        if text[0].isspace():
            text = text[1:]
            continue
        quote = text[0] if text[0] in "'\"" else ""
        argument, text = _sequence(text[len(quote) :], world, end=quote or " \t\n)")
        arguments.append(argument)
        if quote and not text:
            raise LaunchError(f"quote {quote} of $({name} is not closed")
        text = text[len(quote) :]
    if not text:
        raise LaunchError(f"$({name} is not closed")
    return _value(name, arguments, world), text[1:]


def _value(name: str, arguments: list[str], world: World) -> str:
    if name == "var":
        (variable,) = arguments
        if variable not in world.configurations:
            raise LaunchError(f"launch configuration '{variable}' does not exist")
        return world.configurations[variable]
    if name == "find-pkg-share":
        (package,) = arguments
        return f"/share/{package}"
    if name == "find-pkg-prefix":
        (package,) = arguments
        return f"/prefix/{package}"
    if name == "env":  # of a shell that has nothing set
        _, default = arguments
        return default
    if name == "command":
        return world.run(arguments[0])
    if name == "eval":
        return str(_evaluate(ast.parse(" ".join(arguments), mode="eval").body))
    raise LaunchError(f"unknown substitution $({name} …)")


def _evaluate(node: ast.expr) -> bool | str:
    """Evaluate comparisons of texts; anything else is not in what we emit, and not run here."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.In) and isinstance(node.comparators[0], ast.List):
        return _evaluate(node.left) in [_evaluate(item) for item in node.comparators[0].elts]
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        left, right = _evaluate(node.left), _evaluate(node.comparators[0])
        if isinstance(node.ops[0], ast.Eq):
            return left == right
        if isinstance(node.ops[0], ast.NotEq):
            return left != right
    if isinstance(node, ast.BoolOp):
        values = [bool(_evaluate(value)) for value in node.values]
        return all(values) if isinstance(node.op, ast.And) else any(values)
    raise LaunchError(f"cannot evaluate {ast.unparse(node)}")


def condition(text: str) -> bool:
    """Read a condition as IfCondition does; text other than these raises there."""
    if text.strip().lower() in ("true", "1"):
        return True
    if text.strip().lower() in ("false", "0"):
        return False
    raise LaunchError(f"condition '{text}' is neither true nor false")
