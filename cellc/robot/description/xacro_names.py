"""The names that an expression of xacro knows: all that xacro 2 exposes, plain and in the namespaces that it has.

What would compute without end is bounded, what yields its items one by one is a list, and the two names whose answers
depend on the run are refused.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NoReturn

from cellc.contract.limits import limits
from cellc.robot.description.xacro_expression import ExpressionError

_LARGEST_COUNT = 1000
"""Of things that are counted out; the number of combinations is beyond 1e40 long before."""


def _of_items(*arguments: int) -> list[int]:
    numbers = range(*arguments)
    if len(numbers) > limits().xacro_items:
        raise ExpressionError(f"a range of {len(numbers)} items, at most {limits().xacro_items}")
    return list(numbers)


def _counting(function: Callable[..., int]) -> Callable[..., int]:
    def counted(*arguments: int) -> int:
        if any(isinstance(argument, int) and argument > _LARGEST_COUNT for argument in arguments):
            raise ExpressionError(f"`{function.__name__}` of more than {_LARGEST_COUNT}")
        return function(*arguments)

    return counted


def _refused(name: str) -> Callable[..., NoReturn]:
    def refuse(*_arguments: object) -> NoReturn:
        raise ExpressionError(f"`python.{name}` is not allowed in an expression: its answer depends on the run")

    return refuse


_MATH: dict[str, Any] = {name: value for name, value in vars(math).items() if not name.startswith("_")} | {
    name: _counting(getattr(math, name)) for name in ("comb", "factorial", "perm")
}
_PLAIN: dict[str, Any] = {
    "bool": bool, "dict": dict, "float": float, "int": int, "len": len, "list": list,
    "map": lambda function, *items: list(map(function, *items)), "max": max, "min": min, "range": _of_items,
    "round": round, "sorted": sorted, "str": str, "True": True, "False": False,
}  # fmt: skip
_PYTHON: dict[str, Any] = _PLAIN | {
    "abs": abs, "all": all, "any": any, "complex": complex, "divmod": divmod,
    "enumerate": lambda items, start=0: list(enumerate(items, start)),
    "filter": lambda function, items: list(filter(function, items)), "frozenset": frozenset, "hash": _refused("hash"),
    "isinstance": isinstance, "issubclass": issubclass, "ord": ord, "repr": repr,
    "reversed": lambda items: list(reversed(items)), "set": set, "slice": slice, "sum": sum, "tuple": tuple,
    "type": lambda value: type(value),  # of three arguments it would make a class
    "vars": _refused("vars"), "zip": lambda *items: list(zip(*items, strict=False)),
}  # fmt: skip


def known_names(of_xacro: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return what `${…}` knows; ``of_xacro`` is what the namespace `xacro` holds, some of it known plainly too."""
    named = of_xacro or {}
    plain: dict[str, Any] = {name: named[name] for name in ("abs_filename", "dotify", "load_yaml") if name in named}
    return {**_PLAIN, **_MATH, **plain, "math": dict(_MATH), "python": dict(_PYTHON), "xacro": dict(named)}


def names_of_eval() -> dict[str, Any]:
    """Return what `$(eval …)` knows besides the arguments: what Python does, and the truths of roslaunch."""
    return {**_PYTHON, **_MATH, "true": True, "false": False}
