"""What the real programs answered: our own inputs and recordings beside this file, and upstream's files outside.

OBSERVED.md tells the versions, the format of a case and what surprised us. ``declared_parameters.yaml`` is a table of
ours: names, types, defaults and validators that controllers declare. The files of upstream projects (schemas, messages,
vendors' demands) are not ours to copy: they lie in a folder beside the checkout. What reads them is skipped where it is
absent, and the last line of a run says so.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar

import pytest

from tests.foreign_yaml import safe_load

RECORDED = Path(__file__).resolve().parent
UPSTREAM = RECORDED.parents[2] / "shared" / "oracles"

needs_upstream = pytest.mark.skipif(not UPSTREAM.is_dir(), reason="upstream's own files are not beside this checkout")

_Value = TypeVar("_Value")


def here(cases: Iterable[_Value]) -> list[Any]:
    """Return cases that upstream's files give, or one that is skipped for their want."""
    return list(cases) or [pytest.param(None, marks=needs_upstream, id="none")]


# The content of a recorded case is data of another program: plain YAML without a type of ours.
Case = dict[str, Any]


def read_yaml(path: Path) -> Case:
    """Read one recorded case."""
    loaded = safe_load(path.read_text(encoding="utf-8"))
    assert isinstance(loaded, dict)
    return loaded


def recorded_cases(folder: str, pattern: str) -> list[Any]:
    """Return one pytest parameter per recorded case, named by its file, or by its folder where a case has one."""
    paths = sorted((RECORDED / folder).glob(pattern))
    assert paths, f"no recorded case in {folder}/{pattern}"
    return [pytest.param(path, id=path.parent.name if pattern.startswith("cases/*/") else path.stem) for path in paths]
