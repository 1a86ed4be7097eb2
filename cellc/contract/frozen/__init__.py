"""`dataclasses.dataclass`, but that a frozen class compiles no function before one of its values is made.

The standard library compiles six functions for each class, at import: for the 300 classes of a check that is a fifth of
its time, and most of them are never made. Fields, `replace`, `asdict`, comparison, hash, copies, pickles and texts of
values are those of a dataclass. What differs: `inspect.signature` shows the parameters only after the first value, and
a subclass that is no dataclass is frozen too.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from cellc.contract.frozen.methods import methods

_TAKEN = {"frozen", "slots", "kw_only", "repr"}
"""Options of a class that is made here; with any other, the standard library makes it at import."""


def on_demand(**options: bool) -> Callable[[type], type]:
    """Return the decorator of a class; the options are those of `dataclasses.dataclass`."""
    if not options.get("frozen") or not options.keys() <= _TAKEN:
        return partial(dataclasses.dataclass, **options)

    def decorate(cls: type) -> type:
        own = vars(cls)
        cls.__doc__ = cls.__doc__ or cls.__name__  # or a signature is made up for it, which takes longer than the rest
        made: type = dataclasses.dataclass(
            init=False, repr=False, eq=False, slots=options.get("slots", False), kw_only=options.get("kw_only", False)
        )(cls)
        for name, method in methods(made, shown=options.get("repr", True)):
            if own.get(name) is None:
                setattr(made, name, method)
        return made

    return decorate


if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:
    dataclass = on_demand
