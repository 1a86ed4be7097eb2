"""YAML parser events of a text, from libyaml where it is built in."""

from __future__ import annotations

from collections.abc import Iterator

import yaml

_FAST = getattr(yaml, "CLoader", None)


def parse_events(text: str, *, pure: bool = False) -> Iterator[yaml.Event]:
    """Yield the events of ``text`` one by one, so that a reader can stop at the first that it refuses.

    Args:
        pure: use the parser written in Python even where libyaml is there; both give the same events.

    Raises:
        yaml.YAMLError: the text is not YAML.
        ValueError: in Python's parser alone, for an escape or a directive with an absurdly large number.
    """
    loader = yaml.Loader if pure or _FAST is None else _FAST
    yield from yaml.parse(text, Loader=loader)
