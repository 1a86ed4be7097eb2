"""The packages that `pip install .` leaves out: the one gate to them, with one text where one is missing.

A module that imports such a package is itself imported through ``gate`` alone; tests/project/test_extras.py holds it.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass


class MissingExtraError(CellcError):
    """What was asked for needs a package that is not installed."""


@dataclass(frozen=True, slots=True)
class Extra:
    """An extra of the distribution.

    Attributes:
        name: as in `pip install '.[NAME]'` in a checkout.
        asked_by: what the user called that needs it.
        modules: top modules that are there with it alone.
        requirements: what pip installs for it.
    """

    name: str
    asked_by: str
    modules: tuple[str, ...]
    requirements: tuple[str, ...]


EVIDENCE = Extra("evidence", "`--evidence`", ("mcap",), ("mcap>=1.1",))
LSP = Extra("lsp", "`cellc lsp`", ("pygls", "lsprotocol"), ("pygls>=2.1",))
CLUSTER = Extra("cluster", "`--cluster`", ("distributed", "dask"), ("distributed>=2026.8",))
LIVE = Extra("live", "`--live`", ("foxglove", "mcap"), ("foxglove-sdk>=0.30", "mcap>=1.1"))
BAGS = Extra("bags", "reading a bag", ("rosbags", "mcap"), ("rosbags>=0.11.0", "mcap>=1.1"))
PHYSICS = Extra("physics", "`--physics`", ("mujoco",), ("mujoco>=3.3",))
FILM = Extra("film", "`--film`", ("PIL",), ("pillow>=10.3",))
EXTRAS = (EVIDENCE, LSP, CLUSTER, LIVE, BAGS, PHYSICS, FILM)


@contextmanager
def gate(extra: Extra) -> Iterator[None]:
    """Import modules of an extra in here.

    Raises:
        MissingExtraError: one of its packages is not installed, or is too old.
    """
    try:
        yield
    except ImportError as missing:
        module = (missing.name or "").partition(".")[0]
        if module not in extra.modules:
            raise
        # A checkout has no package index with cellc in it, and its environment may not be activated.
        pip = shlex.join([sys.executable or "python", "-m", "pip", "install", *extra.requirements])
        text = f"{extra.asked_by} needs the package `{module}`, which is not installed; install it with `{pip}`"
        raise MissingExtraError(text) from None


def require(*extras: Extra) -> None:
    """Find out before any work whether what it needs is installed.

    Raises:
        MissingExtraError: a package is not installed.
    """
    for extra in extras:
        with gate(extra):
            for module in extra.modules:
                import_module(module)
