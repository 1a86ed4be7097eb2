"""What is shown of a place: units that people read, the card of a model, the words of closed lists."""

from __future__ import annotations

import math
import re

import pytest

from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.meanings import MEANINGS
from cellc.compiler.spec.quantity import ANGLE, LENGTH, VELOCITY, Dimension, QuantityType
from cellc.tools.browse.search import entries
from cellc.tools.lsp.answers import completions, hover
from cellc.tools.lsp.cards import card
from cellc.tools.lsp.cells import Cells
from cellc.tools.lsp.units import in_other_units
from tests.cells import spec_of, spec_text


def _shown(cell: str, asked: str) -> str:
    """Return what is shown at the mark in a text of a cell."""
    cells, spec, text = Cells(), spec_of(cell).as_posix(), spec_text(cell)
    cells.check(spec, {})
    before = text[: text.index(asked.replace("^", "")) + asked.index("^")]
    shown = hover(text, before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1, cells.known(spec))
    assert shown is not None
    return shown[0]


_SHOWN = [
    ("ur5e_pick", "goal_tolerance: 0.0^1 rad", "`0.01 rad` is 0.573 deg."),
    ("ur5e_pick", "max_delta: 5^ deg", "`5 deg` is 0.0873 rad."),
    ("ur5e_pick", "limits: {velocity: 5^0 %", "| `elbow_joint` | 90 deg/s |"),
    ("rail_arm", "limits: {velocity: 5^0 %", "| `carriage_joint` | 500 mm/s |"),
    ("ur5e_pick", "update_rate: 500^ Hz", "`500 Hz` is every 2 ms."),
    ("ur5e_pick", "0 0 11^ mm", "`0 0 11 mm` is 0 0 0.011 m."),
    ("ur5e_pick", "cancel_within: 200^ ms", "`200 ms` is 0.2 s."),
    ("rail_arm", "goal_tolerance: 0.01^ rad 1 mm", "`0.01 rad 1 mm` is 0.573 deg 0.001 m."),
    ("ur5e_pick", "model: ur5^e", "| payload | 5 kg | UR5e technical specification |"),
    ("ur5e_pick", "model: ur5^e", "| joints that move | 6 |  |"),
    ("ur5e_pick", "model: ur5^e", "| driver for jazzy | 3.8.0 | rosdistro, "),
    ("ur5e_pick", "model: ur5^e", "| firmware | polyscope from 5.9.4, below 10 | "),
    ("ur5e_pick", "wants: new^est ", "`newest`: the newest sample alone."),
    ("ur5e_pick", "wan^ts: newest ", "| `every_sample` | each sample, in order |"),
    ("ur5e_pick", "carries: [contr^ol]", "`control`: commands and states of robots."),
]


@pytest.mark.parametrize(("cell", "asked", "shown"), _SHOWN)
def test_a_hover_shows(cell: str, asked: str, shown: str) -> None:
    assert shown in _shown(cell, asked)


_UNITS = [
    ((ANGLE,), "90 deg", 1, ("1.57 rad",)),
    ((ANGLE,), "0 -90 90 deg", 0, ("0 -1.57 1.57 rad",)),
    ((LENGTH,), "0.25 m", 1, ("250 mm",)),
    ((LENGTH,), "3 cm", 1, ("0.03 m", "30 mm")),
    ((VELOCITY,), "250 mm/s", 1, ("0.25 m/s",)),
]


@pytest.mark.parametrize(("dimensions", "text", "size", "others"), _UNITS)
def test_a_value_in_other_units(
    dimensions: tuple[Dimension, ...], text: str, size: int, others: tuple[str, ...]
) -> None:
    assert in_other_units(QuantityType(dimensions, "", size=size).read(text)) == others


def test_a_value_in_another_unit_is_the_same_value() -> None:
    (other,) = in_other_units(QuantityType((ANGLE,), "").read("57 deg"))
    assert math.isclose(float(other.split()[0]), math.radians(57.0), rel_tol=5e-3)


def test_every_model_of_the_catalog_has_a_card() -> None:
    for entry in entries():
        assert entry.model.vendor in card(entry.model.model).replace("\\", ""), entry.model.model
    assert card("of_nobody") == ""


def test_completion_says_what_the_words_mean() -> None:
    text = "network: {discovery: }\n"
    proposed = {one.word: one.meaning for one in completions(text, 1, len(text) - 1, Cells().known(""))}
    assert proposed["localhost"] == "participants of one computer alone find each other"


def test_meanings_are_those_of_words_that_the_language_has() -> None:
    schema = str(CellSpec.model_json_schema())
    for key, words in MEANINGS.items():
        listed = [set(re.findall(r"'([^']+)'|(\d+)", each)) for each in re.findall(r"'enum': \[([^]]*)\]", schema)]
        known = [{text or number for text, number in each} for each in listed]
        assert any(each <= set(words) for each in known), key
