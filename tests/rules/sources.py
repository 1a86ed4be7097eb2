"""The source of a rule: its check, and what of its module the check uses."""

from __future__ import annotations

import ast
import inspect
import sys
from functools import cache

from cellc.compiler.rules.kit import Rule


def module_of(rule: Rule) -> ast.Module:
    return _parsed(rule.check.__module__)


@cache
def _parsed(module: str) -> ast.Module:
    return ast.parse(inspect.getsource(sys.modules[module]))


@cache
def lines_of(rule: Rule) -> frozenset[int]:
    """Return the lines on which the check of a rule and what it uses begin, each a statement of its module."""
    named = {name: statement for statement in module_of(rule).body for name in _names(statement)}
    used: dict[str, ast.stmt] = {}
    waiting = [rule.check.__name__]
    while waiting:
        name = waiting.pop()
        if name in named and name not in used:
            used[name] = named[name]
            waiting += [node.id for node in ast.walk(named[name]) if isinstance(node, ast.Name)]
    return frozenset(statement.lineno for statement in used.values())


def _names(statement: ast.stmt) -> list[str]:
    if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
        return [statement.name]
    if isinstance(statement, ast.Assign):
        return [node.id for target in statement.targets for node in ast.walk(target) if isinstance(node, ast.Name)]
    return [ast.unparse(statement.target)] if isinstance(statement, ast.AnnAssign) else []
