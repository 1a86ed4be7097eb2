"""The arithmetic of ``${…}`` in xacro, interpreted node by node instead of by ``eval``.

xacro evaluates expressions as Python; an untrusted description must not. What robot descriptions use is here:
numbers, texts, lists, dictionaries, comparison, indexing, a fixed set of functions and of methods. Everything else is
refused, as is every underscored attribute and every result beyond a bound.
"""

from __future__ import annotations

import ast
import operator
import re
from collections import ChainMap
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from functools import lru_cache
from typing import Any, cast

from cellc.contract.errors import CellcError
from cellc.contract.limits import limits

MAX_MAGNITUDE = 10**40
_WIDE = re.compile(r"%[^a-zA-Z%]*(?:\d{3}|\*)")
_METHODS: dict[type, frozenset[str]] = {
    str: frozenset({"split", "rsplit", "strip", "lstrip", "rstrip", "lower", "upper", "title", "capitalize",
                    "startswith", "endswith", "count", "find", "rfind", "index", "rindex", "replace", "join",
                    "partition", "rpartition", "splitlines", "swapcase", "casefold", "isdigit", "isalpha", "isalnum",
                    "isdecimal", "isnumeric", "isspace", "islower", "isupper", "istitle", "isidentifier",
                    "removeprefix", "removesuffix", "ljust", "rjust", "center", "zfill"}),
    dict: frozenset({"get", "keys", "values", "items", "copy"}),
    list: frozenset({"index", "count", "copy"}),
    tuple: frozenset({"index", "count"}),
    float: frozenset({"is_integer"}),
}  # fmt: skip
_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
}
_UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Not: operator.not_,
    ast.Invert: operator.invert,
}
_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda item, container: item in container,
    ast.NotIn: lambda item, container: item not in container,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
}


class ExpressionError(CellcError):
    """An expression uses more of Python than a description needs, or its result is beyond bounds."""


def evaluate(text: str, symbols: Mapping[str, Any]) -> Any:
    """Evaluate one expression.

    Args:
        text: what is between ``${`` and ``}``.
        symbols: properties, macro parameters and functions in scope.

    Raises:
        ExpressionError: where the expression is not arithmetic or is too large.
        Exception: what the operation itself raises, such as ZeroDivisionError or KeyError.
    """
    if len(text) > limits().xacro_text:
        raise ExpressionError(f"the expression has {len(text)} characters, at most {limits().xacro_text} are evaluated")
    return _value(_parsed(text.strip()), symbols)


@lru_cache(maxsize=512)
def _parsed(text: str) -> ast.expr:
    # Macros evaluate the same few texts again and again.
    return ast.parse(text, mode="eval").body


def bounded(value: Any) -> Any:
    """Pass a result on unless it is too large to handle; applied to every intermediate result."""
    if isinstance(value, int) and abs(value) > MAX_MAGNITUDE:
        raise ExpressionError("a number is beyond 1e40")
    if isinstance(value, str) and len(value) > limits().xacro_text:
        raise ExpressionError(f"a text is longer than {limits().xacro_text} characters")
    if isinstance(value, (list, tuple, dict, set, frozenset)) and len(value) > limits().xacro_items:
        raise ExpressionError(f"a list is longer than {limits().xacro_items} items")
    return value


def _value(node: ast.expr, symbols: Mapping[str, Any]) -> Any:
    evaluator = _EVALUATORS.get(type(node))
    if evaluator is None:
        raise ExpressionError(f"`{type(node).__name__}` is not allowed in an expression")
    return bounded(evaluator(node, symbols))


def _name(node: Any, symbols: Mapping[str, Any]) -> Any:
    if node.id.startswith("__"):
        raise ExpressionError(f"the name `{node.id}` is not allowed in an expression")
    try:
        return symbols[node.id]
    except KeyError:
        raise NameError(f"name `{node.id}` is not defined") from None


def _binary(node: Any, symbols: Mapping[str, Any]) -> Any:
    operation = _BINARY.get(type(node.op))
    if operation is None:
        raise ExpressionError(f"the operator `{type(node.op).__name__}` is not allowed in an expression")
    left, right = _value(node.left, symbols), _value(node.right, symbols)
    _check_growth(node.op, left, right)
    return operation(left, right)


def _unary(node: Any, symbols: Mapping[str, Any]) -> Any:
    operation = _UNARY.get(type(node.op))
    if operation is None:
        raise ExpressionError(f"the operator `{type(node.op).__name__}` is not allowed in an expression")
    return operation(_value(node.operand, symbols))


def _check_growth(operation: ast.operator, left: Any, right: Any) -> None:
    # Both would first compute the large result and only then be refused.
    whole = isinstance(left, int) and isinstance(right, int)
    if isinstance(operation, (ast.Pow, ast.LShift)) and whole and abs(right) > 128:
        raise ExpressionError(f"the exponent {right} is beyond 128")
    if isinstance(operation, ast.Mult):
        for items, count in ((left, right), (right, left)):
            repeated = len(items) * count if isinstance(items, (str, list, tuple)) and isinstance(count, int) else 0
            if repeated > limits().xacro_items:
                raise ExpressionError(f"repetition to {repeated} items, at most {limits().xacro_items}")
    if isinstance(operation, ast.Mod) and isinstance(left, str) and _WIDE.search(left):
        raise ExpressionError("text formatting with `%` to more than 99 places is not allowed in an expression")


def _call(node: Any, symbols: Mapping[str, Any]) -> Any:
    if isinstance(node.func, ast.Attribute) and any(keyword.arg is None for keyword in node.keywords):
        raise ExpressionError("`**` arguments are not allowed in an expression")
    function = _value(node.func, symbols)
    if not callable(function):
        raise TypeError(f"`{ast.unparse(node.func)}` is not a function")
    arguments = [_value(argument, symbols) for argument in node.args]
    keywords = {keyword.arg: _value(keyword.value, symbols) for keyword in node.keywords}
    return function(*arguments, **keywords)


def _attribute(node: Any, symbols: Mapping[str, Any]) -> Any:
    if node.attr.startswith("_"):
        raise ExpressionError(f"the attribute `{node.attr}` is not allowed in an expression")
    owner = _value(node.value, symbols)
    if any(isinstance(owner, kind) and node.attr in methods for kind, methods in _METHODS.items()):
        return getattr(owner, node.attr)
    if isinstance(owner, dict) and node.attr in owner:  # dotted access to namespaces and to values from YAML
        return owner[node.attr]
    raise ExpressionError(f"the attribute `{node.attr}` is not allowed in an expression")


def _boolean(node: Any, symbols: Mapping[str, Any]) -> Any:
    stop_at = isinstance(node.op, ast.Or)
    value: Any = None
    for operand in node.values:
        value = _value(operand, symbols)
        if bool(value) is stop_at:
            break
    return value


def _comprehension(node: Any, symbols: Mapping[str, Any]) -> Any:
    results = list(_turns(node, node.generators, symbols, [0]))
    if isinstance(node, ast.DictComp):
        return dict(results)
    return set(results) if isinstance(node, ast.SetComp) else results


def _turns(
    node: Any, generators: list[ast.comprehension], symbols: Mapping[str, Any], turns: list[int]
) -> Iterator[Any]:
    """Yield the items of a comprehension, all turns of all its loops counted."""
    if not generators:
        of = (node.key, node.value) if isinstance(node, ast.DictComp) else (node.elt,)
        values = tuple(_value(entry, symbols) for entry in of)
        yield values if len(values) == 2 else values[0]
        return
    first = generators[0]
    for item in _value(first.iter, symbols):
        turns[0] += 1
        if turns[0] > limits().xacro_items:
            raise ExpressionError(f"a comprehension of more than {limits().xacro_items} turns")
        known = cast("MutableMapping[str, Any]", symbols)  # what is bound goes into the first map alone
        inner = ChainMap(dict(_bound(first.target, item)), known)
        if all(_value(condition, inner) for condition in first.ifs):
            yield from _turns(node, generators[1:], inner, turns)


def _bound(target: ast.expr, item: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(target, ast.Name):
        yield target.id, item
    elif isinstance(target, (ast.Tuple, ast.List)):
        for part, value in zip(target.elts, item, strict=True):
            yield from _bound(part, value)
    else:
        raise ExpressionError(f"`{type(target).__name__}` is not allowed in a comprehension")


def _comparison(node: Any, symbols: Mapping[str, Any]) -> bool:
    left = _value(node.left, symbols)
    for operation, comparator in zip(node.ops, node.comparators, strict=True):
        right = _value(comparator, symbols)
        if not _COMPARE[type(operation)](left, right):
            return False
        left = right
    return True


def _choice(node: Any, symbols: Mapping[str, Any]) -> Any:
    return _value(node.body if _value(node.test, symbols) else node.orelse, symbols)


def _subscript(node: Any, symbols: Mapping[str, Any]) -> Any:
    if isinstance(node.slice, ast.Slice):
        parts = (node.slice.lower, node.slice.upper, node.slice.step)
        index: Any = slice(*(None if part is None else _value(part, symbols) for part in parts))
    else:
        index = _value(node.slice, symbols)
    return _value(node.value, symbols)[index]


def _constant(node: Any, symbols: Mapping[str, Any]) -> Any:
    if not isinstance(node.value, (bool, int, float, str, type(None))):
        raise ExpressionError(f"`{node.value!r}` is not allowed in an expression")
    return node.value


_EVALUATORS: dict[type[ast.expr], Callable[[Any, Mapping[str, Any]], Any]] = {
    ast.Constant: _constant,
    ast.Name: _name,
    ast.BinOp: _binary,
    ast.UnaryOp: _unary,
    ast.BoolOp: _boolean,
    ast.Compare: _comparison,
    ast.IfExp: _choice,
    ast.Call: _call,
    ast.Attribute: _attribute,
    ast.Subscript: _subscript,
    ast.List: lambda node, symbols: [_value(item, symbols) for item in node.elts],
    ast.ListComp: _comprehension,
    ast.SetComp: _comprehension,
    ast.DictComp: _comprehension,
    ast.GeneratorExp: _comprehension,
    ast.Set: lambda node, symbols: {_value(item, symbols) for item in node.elts},
    ast.Tuple: lambda node, symbols: tuple(_value(item, symbols) for item in node.elts),
    ast.Dict: lambda node, symbols: {
        _value(key, symbols): _value(value, symbols) for key, value in zip(node.keys, node.values, strict=True)
    },
}
