"""Import yourdfpy without the four fifths of its import time that transforms do not need."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType

_HEAVY = ("scipy", "networkx", "PIL", "shapely", "rtree")


def import_yourdfpy() -> ModuleType:
    """Return the package ``yourdfpy``.

    It builds its scene on trimesh, which imports libraries for operations on meshes where it finds them and does
    without where it does not. Hiding them from that one import saves 0.4 s of every build; whoever imports them
    afterwards gets them.
    """
    hidden = [] if "trimesh" in sys.modules else [name for name in _HEAVY if name not in sys.modules]
    for name in hidden:
        sys.modules[name] = None  # type: ignore[assignment]  # how the import system is told that a module is absent
    try:
        return importlib.import_module("yourdfpy")
    except ImportError:
        pass  # a trimesh that insists on them
    finally:
        for name in hidden:
            del sys.modules[name]
    return importlib.import_module("yourdfpy")
