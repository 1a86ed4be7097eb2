"""Import yourdfpy without the four fifths of its import time that transforms do not need."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from types import ModuleType

_HEAVY = ("scipy", "networkx", "PIL", "shapely", "rtree")


def import_yourdfpy() -> ModuleType:
    """Return the package ``yourdfpy``.

    It builds its scene on trimesh, which imports libraries for operations on meshes where it finds them and does
    without where it does not. Hiding them from that one import saves 0.4 s of every build; whoever imports them
    afterwards gets them.
    """
    if "trimesh" in sys.modules:
        return importlib.import_module("yourdfpy")
    absent = _Absent()
    sys.meta_path.insert(0, absent)
    try:
        return importlib.import_module("yourdfpy")
    except ImportError:
        pass  # a trimesh that insists on them
    finally:
        sys.meta_path.remove(absent)
    return importlib.import_module("yourdfpy")


class _Absent(MetaPathFinder):
    """Finds that none of the heavy libraries is installed; those that are loaded already are not asked for."""

    def find_spec(self, name: str, path: Sequence[str] | None, target: ModuleType | None = None) -> None:
        """Raise ModuleNotFoundError for a heavy library, and leave any other module to the finders after this one."""
        if name.partition(".")[0] in _HEAVY:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
