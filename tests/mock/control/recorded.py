"""Where the recorded answers of the real stack lie, and how they are read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

ORACLES = Path(__file__).resolve().parents[4] / "shared" / "oracles"
MS = 1_000_000
S = 1_000_000_000

# The content of a recorded case is data of another program: plain YAML without a type of ours.
Case = dict[str, Any]


def read_yaml(path: Path) -> Case:
    """Read one file of recorded cases."""
    loaded = yaml.load(path.read_text(encoding="utf-8"), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    assert isinstance(loaded, dict)
    return loaded


def case_parameters(folder: str, pattern: str) -> list[Any]:
    """One pytest parameter per recorded case, or one that is skipped where the folder is absent."""
    paths = sorted((ORACLES / folder).glob(pattern))
    if not paths:
        return [pytest.param(None, marks=pytest.mark.skip(reason=f"recorded answers are absent: {folder}"))]
    return [pytest.param(path, id=path.parent.name if pattern.startswith("cases/*/") else path.stem) for path in paths]
