"""Which programs compute the figures: another version of one may give other bits."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from cellc.contract.store.regular_file import own_bytes
from cellc.version import installed

_PACKAGES = ("cellc", "numpy", "pin")


@cache
def versions() -> Mapping[str, str]:
    """Return what computes here; of cellc with a digest of its modules, since a version may be under work."""
    here = {name: installed(name) for name in _PACKAGES}
    digest = hashlib.sha256()
    root = Path(__file__).parents[2]
    for file in sorted(root.rglob("*.py")):
        digest.update(file.relative_to(root).as_posix().encode() + b"\0" + own_bytes(file))
    here["cellc"] += f" ({digest.hexdigest()[:12]})"
    return here


def difference(there: Mapping[str, object]) -> str:
    """Say what differs of what computed elsewhere, such as ``numpy 2.2.0, here is 2.4.0``; empty for nothing."""
    for name, here in versions().items():
        if there.get(name) != here:
            return f"{name} {there.get(name, 'UNKNOWN')}, here is {here}"
    return ""
