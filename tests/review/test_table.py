"""The table of the grades: complete, written down, and each rule judged by hand."""

from __future__ import annotations

import datetime
from dataclasses import replace
from typing import Annotated

import pytest

from cellc.contract.base import ContractModel
from cellc.contract.grading import Graded, Rule
from cellc.contract.vocabulary import GateCode, Grade, ReviewArea
from cellc.tools.review.compare import _row, _unexplained, area_of_file
from cellc.tools.review.graded import graded_values, rows_of
from cellc.tools.review.grading import grade
from cellc.tools.review.leaves import Delta, Leaf, Path
from cellc.tools.review.rows import ROWS
from cellc.tools.review.rules import APPROVAL, REPEATED, THINGS, Row
from cellc.tools.review.sides import Package
from tests.cells import linked, spec_of
from tests.docs import review

_D, _R, _S = Grade.DANGEROUS, Grade.REVIEW, Grade.SAFE


def test_page_of_the_grades_is_their_table() -> None:
    # Written by `python -m tests.docs.review`.
    assert review.PAGE.read_text(encoding="utf-8") == review.page()


class _Valve(ContractModel):
    pressure_hz: Annotated[float, Graded(ReviewArea.LIMITS, rule=Rule.MORE)]
    unseen: int


class _Plant(ContractModel):
    valves: Annotated[dict[str, _Valve], Graded(ReviewArea.DEVICES, "valve", each="valve")]
    main: _Valve


def test_rows_are_read_from_fields_those_of_a_model_inside_before_its_own() -> None:
    named = Graded(ReviewArea.LIMITS, "pressure", Rule.MORE)
    assert list(rows_of(_Plant, "plant")) == [
        Row("plant valves {valve} pressure_hz", named),
        Row("plant valves {valve} ...", Graded(ReviewArea.DEVICES, "valve", each="valve")),
        Row("plant main pressure_hz", named),
    ]


def test_graded_fields_of_parts_of_a_device_are_compared_by_their_own_names() -> None:
    camera = linked(spec_of("ur5e_pick")).device("camera")
    moved = replace(camera, mount=replace(camera.mount, mounted_on=datetime.date(2026, 7, 1)))
    was, now = (dict(graded_values(each, ("device", "camera"))) for each in (camera, moved))
    assert {path: leaf for path, leaf in now.items() if was.get(path) != leaf} == {
        ("device", "camera", "mounted_on"): "2026-07-01"
    }
    assert was[("device", "camera", "stamp", "source")] == "hardware"


def test_no_two_rows_have_one_pattern() -> None:
    for table in ([row.pattern for row in ROWS], [thing.pattern for thing in THINGS]):
        assert len(table) == len(set(table))


def test_every_danger_has_its_reason() -> None:
    never = (Rule.SAFE, Rule.REVIEW, Rule.STRICTER, Rule.ADDED, Rule.PLACED)  # of a place the verdict says why
    assert not [row.pattern for row in ROWS if row.grade.rule not in never and not row.grade.why]
    assert not [thing.pattern for thing in THINGS if _D in (thing.added, thing.removed) and not thing.why]


def test_every_area_has_an_approval_and_its_gates() -> None:
    assert set(APPROVAL) == set(REPEATED) == set(ReviewArea)


def test_the_first_gate_of_an_area_is_the_one_that_looks_at_it() -> None:
    # By the tables of gates and layers: G1 is axis, limit, TCP, collision, frame; G5 area, stop, observer, tool load;
    # L1 the cable and the address, L5 offset, transform age and authority, L6 owner, cancel and tolerance.
    assert REPEATED[ReviewArea.FRAMES] == (GateCode.G1, GateCode.L5)
    assert REPEATED[ReviewArea.LIMITS] == (GateCode.G1,)
    assert REPEATED[ReviewArea.PAYLOAD] == REPEATED[ReviewArea.SAFETY] == (GateCode.G5,)
    assert REPEATED[ReviewArea.CONTROL] == (GateCode.G2, GateCode.L6)
    assert REPEATED[ReviewArea.NETWORK] == (GateCode.G3, GateCode.L1)


@pytest.mark.parametrize(
    ("rule", "before", "after", "expected"),
    [
        (Rule.MORE, 1.0, 2.0, _D),
        (Rule.MORE, 2.0, 1.0, _S),
        (Rule.MORE, 2.0, None, _D),
        (Rule.MORE, None, 2.0, _S),
        (Rule.LESS, 2.0, 1.0, _D),
        (Rule.LESS, -2.0, -1.0, _S),
        (Rule.LOOSER, 0.1, 0.2, _D),
        (Rule.LOOSER, 0.1, None, _D),
        (Rule.LOOSER, 0.1, 0.0, _D),
        (Rule.LOOSER, 0.0, 0.1, _S),
        (Rule.LOOSER, None, 0.1, _S),
        (Rule.LOOSER, 0.2, 0.1, _S),
        (Rule.LOOSER, 0.1, 0.104, _R),
        (Rule.FIGURE, 0.2, 0.1, _R),
        (Rule.FIGURE, 0.1, 0.2, _D),
        (Rule.FIGURE, 0.1, 0.0, _D),
        (Rule.LOOSER, "a", "b", _D),
        (Rule.BACK, 3, 2, _D),
        (Rule.BACK, 3, 4, _R),
        (Rule.ADDED, ("/a",), ("/a", "/b"), _S),
        (Rule.ADDED, None, ("/a",), _S),
        (Rule.ADDED, ("/a", "/b"), ("/a",), _R),
        (Rule.ADDED, ("/a",), None, _R),
        (Rule.STRICTER, 300.0, 240.0, _S),
        (Rule.STRICTER, None, 240.0, _S),
        (Rule.STRICTER, 300.0, 301.0, _R),
        (Rule.STRICTER, 300.0, None, _R),
        (Rule.NAMED, "controls", "UNKNOWN", _D),
        (Rule.NAMED, "controls", "robot", _R),
        (Rule.NAMED, "controls", None, _D),
        (Rule.NAMED, "UNKNOWN", "controls", _S),
        (Rule.MATRIX, "OK: known", "UNKNOWN: new", _R),
        (Rule.MATRIX, "OK: known", "INCOMPATIBLE: it crashes", _D),
        (Rule.HEAVIER, 0.3, 0.32, _R),
        (Rule.HEAVIER, 0.3, 0.36, _D),
        (Rule.HEAVIER, 0.3, 0.1, _R),
        (Rule.MATRIX, "UNKNOWN: new", "OK: known", _S),
        (Rule.MATRIX, "OK: known", "OK: newer", _R),
        (Rule.CLAIM, "one", "other", _D),
        (Rule.CLAIM, "one", None, _R),
        (Rule.LOST, ("a", "b"), ("a",), _D),
        (Rule.LOST, ("a",), ("a", "b"), _R),
        (Rule.SAFE, 1.0, 2.0, _S),
        (Rule.REVIEW, 1.0, 2.0, _R),
        (Rule.DANGEROUS, 1.0, 2.0, _D),
    ],
)
def test_a_rule_grades(main: Package, rule: Rule, before: Leaf | None, after: Leaf | None, expected: Grade) -> None:
    assert grade(rule, Delta(("any",), before, after), main.facts, main.facts).grade is expected


@pytest.mark.parametrize(
    ("path", "area", "subject", "of"),
    [
        (("file", "config/mine.yaml", "node", "rate"), ReviewArea.CONTROL, ("config/mine.yaml",), ("node", "rate")),
        (("file", "config/moveit/mine.yaml", "a"), ReviewArea.MOTION, ("config/moveit/mine.yaml",), ("a",)),
        (("file", "gates/mine.md"), ReviewArea.GATES, ("gates/mine.md",), ()),
        (("file", "docs/mine.md", "a"), ReviewArea.DOCUMENTS, ("docs/mine.md",), ("a",)),
        (("mine",), ReviewArea.DOCUMENTS, ("mine",), ()),
        (("mine", "security/a", "b"), ReviewArea.DOCUMENTS, ("mine",), ("security/a", "b")),
    ],
)
def test_what_no_row_names_is_looked_at_under_the_area_of_its_file(
    path: Path, area: ReviewArea, subject: Path, of: Path
) -> None:
    row, fit = _row(path)
    assert row.grade == Graded(area, "value")
    assert (fit.subject, fit.of) == (subject, of)


@pytest.mark.parametrize(
    ("file", "area"),
    [
        ("middleware/profile.xml", ReviewArea.NETWORK),
        ("security/keystore", ReviewArea.NETWORK),
        ("launch/real.launch.py", ReviewArea.START_ORDER),
        ("scripts/check", ReviewArea.START_ORDER),
        ("sources.repos", ReviewArea.VERSIONS),
        ("package.xml", ReviewArea.VERSIONS),
        ("urdf/a.urdf", ReviewArea.MODEL),
        ("README.md", ReviewArea.DOCUMENTS),
    ],
)
def test_area_of_a_file(file: str, area: ReviewArea) -> None:
    assert area_of_file(file) is area


def test_what_other_parties_rely_on_breaks_them_where_it_goes() -> None:
    # A frame that they look up, an interface that they are bound to, who publishes what they read or answers their
    # calls. A client or a reader less breaks nobody.
    assert {thing.pattern for thing in THINGS if thing.breaking} == {
        "contract frames {frame}",
        "interface {interface}",
        "interface {interface} publishers {node}",
        "interface {interface} servers {node}",
    }


@pytest.mark.parametrize(
    ("path", "before", "after", "shown"),
    [
        (("cells", "delay_s"), 0.25, 0.5, ("250 ms", "500 ms")),
        (("cells", "rate_hz"), 30, 60, ("30 Hz", "60 Hz")),
        (("reach_m", "cells"), 0.5, 1.5, ("0.5", "1.5")),  # the name of the value has the unit, no other part does
        (("length_m",), 0.5, None, ("500 mm", None)),
    ],
)
def test_unit_of_a_value_that_no_file_shows_is_in_its_name(
    monkeypatch: pytest.MonkeyPatch,
    main: Package,
    path: Path,
    before: Leaf,
    after: Leaf | None,
    shown: tuple[str, str | None],
) -> None:
    monkeypatch.setattr("cellc.tools.review.compare.differences", lambda *_: [Delta(path, before, after)])
    manifest = main.facts.manifest
    inputs = manifest.configuration_inputs.model_copy(update={"cell_sha256": "0" * 64})
    other = replace(main.facts, manifest=manifest.model_copy(update={"configuration_inputs": inputs}))
    (change,) = _unexplained(main.facts, other)
    assert (change.before, change.after) == shown
    assert change.subject == " ".join(path)
