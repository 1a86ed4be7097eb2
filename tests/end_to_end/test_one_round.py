"""A spec with several mistakes: one check names them all, those that stop a stage and those behind it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from tests.cells import spec_text, written

_TEN = {
    "synchronized_by: chrony": ("synchronised_by: chrony", "unknown-key"),
    "domain_id: 42": ("domain_id: 420", "domain-id-out-of-range"),
    "model: robotiq_2f_85": ("model: robotiq_2f_855", "unknown-model"),
    "mount: {parent: arm/tool0, xyz: 0 0 11 mm": ("mount: {parent: arm/tool00, xyz: 0 0 11 mm", "unknown-frame"),
    "velocity: 50 %, acceleration": ("velocity: 500 %, acceleration", "limit-share-above-full"),
    "buffer: 10 s\n": ("buffer: 10 sec\n", "wrong-unit"),
    "address: 192.168.56.101": ("address: 192.168.56.10", "duplicate-address"),
    "reference_points: 3": ("reference_pointss: 3", "unknown-key"),
    "expect: canceled": ("expect: cancelled", "not-a-choice"),
    "mass: 1.0 kg": ("mass: 100 kg", "payload-above-limit"),
}
"""One mistake each of shape, name, unit and value."""


def _codes(path: Path) -> set[tuple[str, int]]:
    return {(found.code, found.span.line) for found in check(path)}


def test_ten_mistakes_are_named_in_one_round(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    before = _codes(written(tmp_path, text))
    wanted = set()
    for right, (wrong, code) in _TEN.items():
        assert text.count(right) == 1, right
        wanted.add((code, text[: text.index(right)].count("\n") + 1))
        text = text.replace(right, wrong)
    assert wanted - before <= _codes(written(tmp_path, text))


_KEY = re.compile(r"(?:^ *|[{,] *)([a-z_]{4,}):(?= )", re.MULTILINE)
_PLACES = tuple(found.span(1) for found in _KEY.finditer(spec_text("ur5e_pick")))[::6]


@pytest.mark.parametrize("place", _PLACES, ids=str)
def test_a_slip_in_a_key_gives_findings_of_its_line_and_of_names_alone(place: tuple[int, int], tmp_path: Path) -> None:
    """The letter that ends it is written twice: what is meant is near, and nothing follows from it."""
    text, (begin, end) = spec_text("ur5e_pick"), place
    line = text[:begin].count("\n") + 1
    before = _codes(written(tmp_path, text))
    more = _codes(written(tmp_path, f"{text[:end]}{text[end - 1]}{text[end:]}")) - before
    assert {code for code, at in more if at != line} <= {
        "unknown-frame",
        "unknown-goal",
        "unknown-host",
        "unknown-device",
    }


def test_what_is_left_out_is_no_reason_for_findings_of_rules(tmp_path: Path) -> None:
    """Without its place the part would lie in the robot; nobody knows what `qqqq` was meant to be."""
    text = spec_text("ur5e_pick")
    place = text.index("  fixture_A:")
    xyz = text.index("xyz:", place)
    more = _codes(written(tmp_path, f"{text[:xyz]}qqqq:{text[xyz + 4 :]}")) - _codes(written(tmp_path, text))
    assert {code for code, _ in more} == {"unknown-key"}


def test_names_are_resolved_behind_a_value_that_is_left_out(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("scheduling: preempt_rt", "scheduling: 17")
    before, line = _codes(written(tmp_path, text)), text[: text.index("move: home")].count("\n") + 1
    assert len(before) == 1
    more = _codes(written(tmp_path, text.replace("move: home", "move: moon", 1))) - before
    assert more == {("unknown-goal", line)}


def test_a_comment_that_excuses_a_finding_excuses_it_behind_a_mistake_too(tmp_path: Path) -> None:
    clean = "    grasp: {width: 77 mm, tolerance: 2 mm, mass: 0.2 kg, size: 77 77 77 mm, friction: 0.5}"
    text = spec_text("ur5e_pick")
    coarse = text.replace("residual: 0.8 mm", "residual: 80 mm")
    ((code, line),) = _codes(written(tmp_path, coarse)) - _codes(written(tmp_path, text))
    rows = coarse.split("\n")
    rows[line - 1] += f"  # cellc: ignore {code} (measured again on Monday)"
    excused = "\n".join(rows)
    slip = (clean, clean.replace("grasp:", "graspp:"))
    assert (code, line) in _codes(written(tmp_path, coarse.replace(*slip)))
    assert not {code, "unused-ignore"} & {code for code, _ in _codes(written(tmp_path, excused.replace(*slip)))}
