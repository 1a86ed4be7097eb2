"""A frozen class that is compiled on demand means what the one of the standard library means, in each of its uses."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from cellc.contract.frozen import on_demand

Decorator = Callable[..., Callable[[type], type]]


def _classes(dataclass: Decorator) -> dict[str, Any]:
    """Return classes of each form, as one of the two decorators makes them."""

    @dataclass(frozen=True, slots=True)
    class Point:
        x: float
        y: float = 2.0
        seen: list[int] = dataclasses.field(default_factory=list, compare=False)

        def __post_init__(self) -> None:
            self.seen.append(1)

    @dataclass(frozen=True, slots=True, kw_only=True)
    class Named:
        """Said of it."""

        name: str
        rest: tuple[object, ...] = ()
        hidden: int = dataclasses.field(default=7, repr=False)

    @dataclass(frozen=True, slots=True, kw_only=True)
    class Longer(Named):
        length: float

    @dataclass(frozen=True, repr=False)
    class Shown:
        part: object

        def __repr__(self) -> str:
            return f"<{self.part}>"

    @dataclass(frozen=True)
    class Empty:
        pass

    @dataclass(frozen=True, slots=True, order=True)
    class Ordered:
        rank: int

    @dataclass(frozen=True, slots=True)
    class Alone:
        value: object

    @dataclass(frozen=True, slots=True)
    class Counted:
        text: str
        length: int = dataclasses.field(init=False)
        kind: str = dataclasses.field(init=False, default="text")

        def __post_init__(self) -> None:
            object.__setattr__(self, "length", len(self.text))

    classes = (Point, Named, Longer, Shown, Empty, Ordered, Alone, Counted)
    return {made.__name__: made for made in classes}


OURS, THEIRS = _classes(on_demand), _classes(dataclasses.dataclass)
CALLS: list[tuple[str, tuple[object, ...], dict[str, object]]] = [
    ("Point", (1.0,), {}),
    ("Point", (1.0, 3.0), {}),
    ("Point", (), {"x": 1.0, "seen": [4]}),
    ("Point", (), {}),
    ("Point", (1.0,), {"z": 1}),
    ("Point", (1.0, 2.0, [], 4), {}),
    ("Named", (), {"name": "a"}),
    ("Named", ("a",), {}),
    ("Named", (), {"name": "a", "rest": (1, None)}),
    ("Longer", (), {"name": "a", "length": 2.0}),
    ("Shown", ((),), {}),
    ("Empty", (), {}),
    ("Ordered", (3,), {}),
    ("Alone", (3,), {}),
    ("Counted", ("four",), {}),
    ("Counted", ("four",), {"length": 4}),
]


def _uses(cls: Any, values: tuple[object, ...], named: dict[str, object]) -> dict[str, object]:
    """Return what comes of a value and of its uses; of what is refused, the kind of the refusal."""
    try:
        made, again = (cls(*copy.deepcopy(values), **copy.deepcopy(named)) for _ in range(2))
    except TypeError as refusal:
        return {"refused": str(refusal)}
    first, *_ = (*dataclasses.fields(cls), None)
    other = again if first is None else dataclasses.replace(again, **{first.name: "other"})
    refused = []
    for attribute in ("__setattr__", "__delattr__"):
        with pytest.raises(dataclasses.FrozenInstanceError) as raised:
            getattr(made, attribute)(*(("x" if first is None else first.name, 1)[: 2 if "set" in attribute else 1]))
        refused.append(type(raised.value))
    return {
        "text": repr(made),
        "data": dataclasses.asdict(made),
        "equal": (made == again, made == other, made == 1, hash(made) == hash(again), len({made, again, other})),
        "copies": (copy.copy(made) == made, copy.deepcopy(made) == made, repr(copy.deepcopy(made)) == repr(made)),
        "match": cls.__match_args__,
        "slots": hasattr(made, "__dict__"),
        "fields": [(field.name, field.kw_only, field.compare) for field in dataclasses.fields(cls)],
        "said": cls.__doc__ if cls.__name__ == "Named" else "",
        "refused": refused,
        "ordered": cls.__name__ != "Ordered" or made <= again,
    }


@pytest.mark.parametrize(("name", "values", "named"), CALLS)
def test_a_class_is_used_as_that_of_the_standard_library(
    name: str, values: tuple[object, ...], named: dict[str, object]
) -> None:
    if name == "Empty":  # no field that could be set: the standard library names any attribute
        assert OURS[name]() == OURS[name]()
        assert repr(OURS[name]()) == repr(THEIRS[name]())
        return
    assert _uses(OURS[name], values, named) == _uses(THEIRS[name], values, named)


def test_a_single_field_is_compared_as_in_a_tuple() -> None:
    array = np.zeros(2)
    assert (OURS["Alone"](array) == OURS["Alone"](array)) is True


def test_a_field_that_nothing_has_set_is_absent() -> None:
    @on_demand(frozen=True, slots=True)
    class Unset:
        later: int = dataclasses.field(init=False)

    assert not hasattr(Unset(), "later")


@on_demand(frozen=True, slots=True)
class Sent:
    """Found by its name, as a pickle wants it."""

    a: int
    b: tuple[int, ...] = ()


def test_a_value_crosses_to_another_process() -> None:
    made: Any = Sent
    assert pickle.loads(pickle.dumps(made(1, (2, 3)))) == made(1, (2, 3))


def test_no_function_of_a_class_is_compiled_before_its_first_value() -> None:
    program = """
import sys
from cellc.contract.frozen import dataclass
compiled = []
def heard(event, given):
    if event == "compile" and given[1] == "<string>" and b"def __init__" in (given[0] or b""):
        compiled.append(given)
sys.addaudithook(heard)
@dataclass(frozen=True, slots=True)
class Pair:
    a: int
    b: int = 2
assert not compiled, compiled
assert (Pair(1).b, Pair(1, 3).b) == (2, 3)
assert len(compiled) == 1, compiled
"""
    subprocess.run([sys.executable, "-c", program], check=True)
