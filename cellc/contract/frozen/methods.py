"""What a frozen class has beside its fields: written once for all classes, but for `__init__`."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from functools import cache
from operator import attrgetter
from reprlib import recursive_repr
from types import FunctionType
from typing import Any, ClassVar, Protocol

_Method = Callable[..., object]


class _Made(Protocol):
    """A value of a class that is made here."""

    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[Any]]]
    __compared__: ClassVar[_Method]


def methods(cls: type, *, shown: bool) -> Iterable[tuple[str, _Method]]:
    """Yield what a frozen dataclass has, the parts that are the same for all written once."""
    yield "__init__", _first_init(cls)
    yield "__compared__", _values(field.name for field in dataclasses.fields(cls) if field.compare)
    yield from _SHARED
    if shown:
        yield "__repr__", _repr


def _values(names: Iterable[str]) -> _Method:
    """Return what reads fields of a value, at the speed of C: always as a tuple, which compares what is in it.

    Of one name alone, `attrgetter` returns the value, and `==` of an array is no answer; so that name is read twice.
    """
    given = tuple(names)
    return attrgetter(*given, *given[: len(given) == 1]) if given else _nothing


def _first_init(cls: type) -> _Method:
    """Return the `__init__` that makes the one of the class when it is first called, and leaves it in its place."""

    def first(self: object, *values: object, **named: object) -> None:
        compiled = _compiled_init(cls)
        type.__setattr__(cls, "__init__", compiled)
        compiled(self, *values, **named)

    return first


def _compiled_init(cls: type) -> _Method:
    """Compile the `__init__` of a class: its parameters by position, then those by name, and one line a field."""
    known: dict[str, object] = {"_put": object.__setattr__, "_missing": dataclasses.MISSING}
    parameters: dict[bool, list[str]] = {False: ["self"], True: []}
    lines = []
    for field in dataclasses.fields(cls):
        name, made = field.name, field.default_factory is not dataclasses.MISSING
        known[f"_default_{name}"] = field.default_factory if made else field.default
        value = f"_default_{name}()" if made else f"_default_{name}"
        if field.init:
            optional = made or field.default is not dataclasses.MISSING
            absent = "_missing" if made else value
            parameters[bool(field.kw_only)].append(f"{name}={absent}" if optional else name)
            value = f"{value} if {name} is _missing else {name}" if made else name
        if field.init or known[f"_default_{name}"] is not dataclasses.MISSING:  # else `__post_init__` sets it
            lines.append(f"    _put(self, {name!r}, {value})")
    if hasattr(cls, "__post_init__"):
        lines.append("    self.__post_init__()")
    by_name = ["*", *parameters[True]] if parameters[True] else []
    text = f"def __init__({', '.join((*parameters[False], *by_name))}):\n" + "\n".join(lines or ["    pass"])
    exec(text, known)
    compiled = known["__init__"]
    assert isinstance(compiled, FunctionType)
    compiled.__qualname__ = f"{cls.__qualname__}.__init__"
    return compiled


def _nothing(_: object) -> tuple[()]:
    return ()


def _equal(self: _Made, other: object) -> object:
    cls = type(self)
    return cls.__compared__(self) == cls.__compared__(other) if type(other) is cls else NotImplemented


def _hash(self: _Made) -> int:
    return hash(type(self).__compared__(self))


@cache
def _names(cls: type) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(cls))


@recursive_repr()
def _repr(self: _Made) -> str:
    shown = (f"{field.name}={getattr(self, field.name)!r}" for field in dataclasses.fields(self) if field.repr)
    return f"{type(self).__qualname__}({', '.join(shown)})"


def _refuse(self: object, name: str, *_: object) -> None:
    raise dataclasses.FrozenInstanceError(f"cannot change field {name!r}")


def _state(self: _Made) -> list[object]:
    return [getattr(self, name) for name in _names(type(self))]


def _restore(self: _Made, state: list[object]) -> None:
    for name, value in zip(_names(type(self)), state, strict=True):
        object.__setattr__(self, name, value)


_SHARED: tuple[tuple[str, _Method], ...] = (
    ("__eq__", _equal),
    ("__hash__", _hash),
    ("__setattr__", _refuse),
    ("__delattr__", _refuse),
    ("__getstate__", _state),
    ("__setstate__", _restore),
)
