"""Changes of a document's structure."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence

from tests.robustness.fuzz.hostile import NUMBERS, TEXTS, UNITS, crowd, hostile, number
from tests.robustness.fuzz.tree import (
    Anchored,
    Raw,
    Tree,
    any_place,
    copied,
    names_in,
    paths,
    places,
    put,
    remove,
    value_at,
)

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
_UNIT = re.compile(r"(?<=\d )[a-zA-Z%/^0-9]+$")


class TreeMutator:
    """Changes one document; ``others`` are documents of its kind that parts are taken from."""

    def __init__(self, tree: Tree, others: Sequence[Tree], chance: random.Random, *, json: bool) -> None:
        self.tree, self._others, self._chance, self._json = tree, others, chance, json
        self._anchors = 0

    def mutate(self, times: int) -> Tree:
        """Change the document so many times, and return it."""
        gentle_alone = self._chance.random() < 0.5
        for _ in range(times):
            draw = self._chance.random()
            gentle = gentle_alone or draw < 0.3
            self._chance.choice(self._gentle() if gentle else self._rough() if draw < 0.97 else self._rare())()
        return self.tree

    def _gentle(self) -> Sequence[Callable[[], None]]:
        """What leaves most documents in the shape that they must have."""
        return [self._refer, self._quantity, self._quantity, self._graft, self._graft, self._remove, self._exchange]

    def _rough(self) -> Sequence[Callable[[], None]]:
        return [
            self._replace, self._replace, self._replace, self._double, self._swap, self._copy, self._rename,
            self._retype, self._splice, self._number,
        ]  # fmt: skip

    def _rare(self) -> Sequence[Callable[[], None]]:
        return [self._crowd] if self._json else [self._anchor, self._merge, self._crowd]

    def _replace(self) -> None:
        if (place := any_place(self.tree, self._chance)) is not None:
            put(*place, hostile(self._chance, json=self._json))

    def _remove(self) -> None:
        if (place := any_place(self.tree, self._chance)) is not None:
            remove(*place)

    def _double(self) -> None:
        if (place := any_place(self.tree, self._chance)) is None:
            return
        holder, key = place
        value = copied(value_at(holder, key))
        if isinstance(holder, list):
            holder.insert(self._chance.randrange(len(holder) + 1), value)
        else:
            holder[f"{key}{self._chance.choice('_2x/. ')}"] = value

    def _swap(self) -> None:
        first, second = any_place(self.tree, self._chance), any_place(self.tree, self._chance)
        if first is not None and second is not None:
            kept, other = copied(value_at(*first)), copied(value_at(*second))
            put(*first, other)
            put(*second, kept)

    def _copy(self) -> None:
        first, second = any_place(self.tree, self._chance), any_place(self.tree, self._chance)
        if first is not None and second is not None:
            put(*second, copied(value_at(*first)))

    def _rename(self) -> None:
        found = [place for place in places(self.tree) if isinstance(place[0], dict)]
        if not found:
            return
        holder, key = self._chance.choice(found)
        assert isinstance(holder, dict)
        draw = self._chance.random()
        names = names_in(self.tree) if draw < 0.6 else TEXTS
        new = f"{key}"[:-1] if draw < 0.2 else self._chance.choice(names)
        items = [(new if name == key else name, value) for name, value in holder.items()]
        holder.clear()
        holder.update(items)

    def _refer(self) -> None:
        """Let a text name something else of the document."""
        found = [place for place in places(self.tree) if _is_name(value_at(*place))]
        if not found:
            return
        place = self._chance.choice(found)
        names, text = names_in(self.tree), str(value_at(*place))
        alike = [str(value_at(*finding)) for finding in found if finding[1] == place[1]]
        if self._chance.random() < 0.5 and len(alike) > 1:
            names = alike
        device, slash, rest = text.partition("/")
        if slash and self._chance.random() < 0.6:
            parts = (
                [self._chance.choice(names), rest]
                if self._chance.random() < 0.5
                else [device, self._chance.choice(names)]
            )
            put(*place, "/".join(parts))
        else:
            put(*place, self._chance.choice(names))

    def _exchange(self) -> None:
        """Exchange two values that have the same key."""
        if (first := any_place(self.tree, self._chance)) is None:
            return
        kind = type(value_at(*first))
        alike = [place for place in places(self.tree) if place[1] == first[1] and type(value_at(*place)) is kind]
        second = self._chance.choice(alike)
        kept, other = copied(value_at(*first)), copied(value_at(*second))
        put(*first, other)
        put(*second, kept)

    def _quantity(self) -> None:
        """Change a number or the unit inside of a value, by an amount that somebody may mean."""
        self._number(("0", "1", "-1", "2", "0.1", "0.001", "10", "100", "1000", "0.5", "3.2", "90", "1e-6", "1e5"))

    def _number(self, numbers: Sequence[str] = NUMBERS) -> None:
        found = [place for place in places(self.tree) if _is_quantity(value_at(*place))]
        if not found:
            return
        place = self._chance.choice(found)
        value = value_at(*place)
        if not isinstance(value, str):
            put(
                *place,
                Raw(self._chance.choice(numbers) if numbers is not NUMBERS else number(self._chance, json=self._json)),
            )
        elif self._chance.random() < 0.2 and _UNIT.search(value):
            put(*place, _UNIT.sub(self._chance.choice(UNITS), value))
        else:
            hits = list(_NUMBER.finditer(value))
            hit = self._chance.choice(hits)
            put(*place, value[: hit.start()] + self._chance.choice(numbers) + value[hit.end() :])

    def _retype(self) -> None:
        if (place := any_place(self.tree, self._chance)) is None:
            return
        value = value_at(*place)
        shapes: list[Tree] = [[value], {"value": value}, [value, value], "x"]
        if isinstance(value, dict):
            shapes += [list(value.values()), [*value]]
        elif isinstance(value, list):
            shapes += [{str(index): item for index, item in enumerate(value)}, value[:1]]
        else:
            shapes += [{str(value): None}]
        put(*place, self._chance.choice(shapes))

    def _splice(self) -> None:
        """Put a part of another document somewhere."""
        here = any_place(self.tree, self._chance)
        there = any_place(self._chance.choice(self._others), self._chance)
        if here is not None and there is not None:
            put(*here, copied(value_at(*there)))

    def _graft(self) -> None:
        """Put a part of another document where it fits: below names that users choose, keys of the same shape."""
        other = paths(self._chance.choice(self._others))
        here = paths(self.tree)
        path, holder, key = self._chance.choice(other) if other else ((), {}, "")
        fitting = [
            (at, one) for at, one, _ in here if len(at) == len(path) and at[:1] == path[:1] and at[2:-1] == path[2:-1]
        ]
        if fitting:
            _, target = self._chance.choice(fitting)
            if isinstance(target, dict):
                target[str(key)] = copied(value_at(holder, key))
            else:
                target.append(copied(value_at(holder, key)))

    def _anchor(self) -> None:
        """Share a value between two places."""
        first, second = any_place(self.tree, self._chance), any_place(self.tree, self._chance)
        if first is None or second is None or isinstance(value_at(*first), (Anchored, Raw)):
            return
        self._anchors += 1
        put(*second, Raw(f"*a{self._anchors}"))
        put(*first, Anchored(f"a{self._anchors}", copied(value_at(*first))))

    def _merge(self) -> None:
        """Merge a mapping into another."""
        found = [place for place in places(self.tree) if isinstance(value_at(*place), dict)]
        if len(found) < 2:
            return
        first, second = self._chance.choice(found), self._chance.choice(found)
        target = value_at(*second)
        assert isinstance(target, dict)
        self._anchors += 1
        target["<<"] = Raw(f"*a{self._anchors}")
        put(*first, Anchored(f"a{self._anchors}", copied(value_at(*first))))

    def _crowd(self) -> None:
        found = [
            place for place in places(self.tree) if isinstance(value_at(*place), (dict, list)) and value_at(*place)
        ]
        if not found:
            return
        place = self._chance.choice(found)
        value = value_at(*place)
        size = self._chance.choice((10, 100, 400))
        if isinstance(value, list):
            put(*place, [copied(self._chance.choice(value)) for _ in range(size)])
        elif isinstance(value, dict) and self._chance.random() < 0.8:
            key = self._chance.choice(list(value))
            value.update({f"{key}{index}": copied(value[key]) for index in range(size // 4)})
        else:
            put(*place, crowd(self._chance))


def _is_name(value: Tree) -> bool:
    return isinstance(value, str) and _NUMBER.match(value) is None


def _is_quantity(value: Tree) -> bool:
    if isinstance(value, str):
        return _NUMBER.search(value) is not None
    return isinstance(value, (int, float))
