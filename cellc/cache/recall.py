"""Take an answer from the cache, or compute and keep it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from cellc.cache.folder import cache_folder
from cellc.cache.key import entry_name
from cellc.cache.store import read_entry, write_entry

_Answer = TypeVar("_Answer")


def recall(kind: str, question: str, answer: type[_Answer], compute: Callable[[], _Answer]) -> _Answer:
    """Return the kept answer to a question, or compute it.

    A missing, unreadable or damaged entry, and a folder that cannot be written, cost time and nothing else.

    Args:
        kind: folder of the entry.
        question: everything that the answer depends on, apart from the program.
        answer: a type that pydantic reads and writes, such as a dataclass.
    """
    if cache_folder() is None:
        return compute()
    # Whoever uses the other parts of the cache does not pay for pydantic.
    from pydantic import TypeAdapter, ValidationError

    adapter = TypeAdapter(answer)
    name = entry_name(kind, question)
    content = read_entry(name)
    if content is not None:
        try:
            return adapter.validate_json(content)
        except ValidationError:
            pass  # of another release whose code looked the same
    computed = compute()
    write_entry(name, adapter.dump_json(computed))
    return computed
