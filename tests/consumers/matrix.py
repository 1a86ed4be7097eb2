"""Every cell of the repository, and one of two arms, compiled for every distribution, once a session."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import pytest

from tests.cells import CELLS, DISTROS, Compiled, compiled, spec_of, without_absent, written
from tests.foreign_yaml import safe_load

HERE = Path(__file__).resolve().parent
SPECS = {cell: spec_of(cell) for cell in CELLS} | {"two_arms": HERE / "two_arms.yaml"}

every_build = pytest.mark.parametrize(("cell", "distro"), [(cell, distro) for cell in SPECS for distro in DISTROS])
PLANNING = tuple(cell for cell, path in SPECS.items() if "move_group" in path.read_text(encoding="utf-8"))
every_planning_build = pytest.mark.parametrize(
    ("cell", "distro"), [(cell, distro) for cell in PLANNING for distro in DISTROS]
)
every_cell = pytest.mark.parametrize("cell", list(SPECS))


@dataclass(frozen=True, slots=True)
class Build(Compiled):
    """One cell compiled for one distribution."""

    cell: str
    distro: str

    def urdf(self, target: str) -> str:
        """Return the description that robot_state_publisher gets."""
        return self.texts[f"urdf/{self.cell}.{target}.urdf"]


_IN_PLACE: dict[tuple[str, str], Build] = {}


def build(cell: str, distro: str) -> Build:
    """Return a cell compiled for a distribution, or what was put in its place."""
    return _IN_PLACE.get((cell, distro)) or _compiled(cell, distro)


@contextmanager
def in_place(other: Build) -> Iterator[None]:
    """Put another build in place of the one that its cell makes, so that checks can be seen to fail."""
    _IN_PLACE[other.cell, other.distro] = other
    try:
        yield
    finally:
        del _IN_PLACE[other.cell, other.distro]


@lru_cache(maxsize=64)
def _compiled(cell: str, distro: str) -> Build:
    """Compile a cell for a distribution; errors and findings of foreign parsers fail the test."""
    with tempfile.TemporaryDirectory() as folder:
        build = compiled(written(Path(folder), spec_for(cell, distro)))
    return Build(build.graph, build.artifacts, cell, distro)


def spec_for(cell: str, distro: str) -> str:
    """Return the spec of a cell with the version tuple of a distribution in place of its own."""
    text = SPECS[cell].read_text(encoding="utf-8")
    tuple_ = safe_load((HERE / "version_tuples.yaml").read_text(encoding="utf-8"))[distro]
    text = re.sub(r"\bros: \w+", f"ros: {distro}", text, count=1)
    for name, version in tuple_.items():
        own = r"[^,}\s#][^,}\n#]*?(?=\s*(?:[,}#]|$))"
        if re.search(rf"^  {name}: ", text, re.MULTILINE):
            text = re.sub(rf"^(  {name}: ){own}", rf"\g<1>{version}", text, flags=re.MULTILINE)
        pinned = "UNKNOWN" if version == "UNKNOWN" else f"{name} {version}"
        text = re.sub(rf": (&\w+ )?{name} \d{own}", rf": \g<1>{pinned}", text, flags=re.MULTILINE)
    return without_absent(text, distro)
