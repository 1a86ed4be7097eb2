"""The page of the mock names every part of the package, in the order in which one rests on the other."""

from __future__ import annotations

import re
from itertools import pairwise

from importlinter.api import read_configuration

from tests.cells import ROOT


def _layers() -> list[set[str]]:
    contracts = read_configuration(str(ROOT / "pyproject.toml"))["contracts_options"]
    layers = next(each["layers"] for each in contracts if each.get("containers") == ["cellc.mock"])
    return [set(str(layer).split(" | ")) for layer in reversed(layers)]


def test_page_names_the_parts_in_the_order_of_the_import_contract() -> None:
    page = (ROOT / "docs" / "mock.md").read_text(encoding="utf-8")
    table = page.partition("## How it is put together")[2].partition("## Faults")[0]
    rows = [re.findall(r"`(\w+)`", row.split("|")[1]) for row in table.splitlines() if row.startswith("| `")]
    place = {part: number for number, layer in enumerate(_layers()) for part in layer}
    assert sorted(part for row in rows for part in row) == sorted(place)
    for lower, upper in pairwise(rows):
        assert max(place[part] for part in lower) <= min(place[part] for part in upper)
