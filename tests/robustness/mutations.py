"""Random changes of a spec's text and of its structure, told by a seed."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import Any

import yaml

_ODD: tuple[Any, ...] = (
    None, True, 0, -1, 10**40, 1e400, "", "UNKNOWN", " ", "0", "-5 m", "1e9 mm", "nan rad", "../../x", "a/b/c",
    "\u2066x", [], {}, [[]], {"": ""}, [None], {"a": {"b": {}}}, "0 0 0 deg", "latest", "world", "arm", "arm/", "/",
    "x" * 5000,
)  # fmt: skip
_CHARACTERS = ":{}[],&*#?|-<>=!%@`'\"\t\n\r\x00\ufeff aé0"


def mutated(text: str, seed: int) -> str:
    """Return a spec with one to three changes; the same for the same seed."""
    chance = random.Random(seed)
    for _ in range(chance.randint(1, 3)):
        text = chance.choice(_TEXT + _STRUCTURE * 3)(text, chance)
    return text


def _line_out(text: str, chance: random.Random) -> str:
    lines = text.splitlines(keepends=True)
    if lines:
        lines.pop(chance.randrange(len(lines)))
    return "".join(lines)


def _line_moved(text: str, chance: random.Random) -> str:
    lines = text.splitlines(keepends=True) or [""]
    lines.insert(chance.randrange(len(lines)), chance.choice(lines))
    return "".join(lines)


def _indented(text: str, chance: random.Random) -> str:
    lines = text.splitlines(keepends=True) or [""]
    place = chance.randrange(len(lines))
    lines[place] = " " * chance.randint(1, 5) + lines[place]
    return "".join(lines)


def _character(text: str, chance: random.Random) -> str:
    place = chance.randrange(len(text) + 1)
    return text[:place] + chance.choice(_CHARACTERS) + text[place + chance.randint(0, 2) :]


def _cut(text: str, chance: random.Random) -> str:
    return text[: chance.randrange(len(text) + 1)]


def _word_changed(text: str, chance: random.Random) -> str:
    words = text.split(" ")
    words[chance.randrange(len(words))] = chance.choice(words)
    return " ".join(words)


def _value_replaced(text: str, chance: random.Random) -> str:
    return _at_random_place(text, chance, lambda holder, key: holder.__setitem__(key, chance.choice(_ODD)))


def _value_out(text: str, chance: random.Random) -> str:
    return _at_random_place(text, chance, lambda holder, key: holder.__delitem__(key))


def _value_copied(text: str, chance: random.Random) -> str:
    """Put a value of one place into another."""
    places = list(_places(_loaded(text)))
    if not places:
        return text
    source, at = chance.choice(places)
    return _at_random_place(text, chance, lambda holder, key: holder.__setitem__(key, source[at]))


def _key_renamed(text: str, chance: random.Random) -> str:
    def rename(holder: Any, key: Any) -> None:
        if isinstance(holder, dict):
            holder[str(key)[:-1] + chance.choice("xyz/ ")] = holder.pop(key)

    return _at_random_place(text, chance, rename)


def _at_random_place(text: str, chance: random.Random, change: Callable[[Any, Any], None]) -> str:
    data = _loaded(text)
    places = list(_places(data))
    if not places:
        return text
    change(*chance.choice(places))
    return yaml.safe_dump(data, sort_keys=False, allow_unicode=True)


def _loaded(text: str) -> Any:
    try:
        return yaml.load(text, Loader=yaml.BaseLoader)
    except (yaml.YAMLError, RecursionError, ValueError):
        return None


def _places(data: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every value as its holder and its key or index."""
    keys: Any = data if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ()
    for key in list(keys):
        yield data, key
        yield from _places(data[key])


_TEXT = [_line_out, _line_moved, _indented, _character, _cut, _word_changed]
_STRUCTURE = [_value_replaced, _value_out, _value_copied, _key_renamed]
