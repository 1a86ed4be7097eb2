"""Figures that rules tell of the examples on their pages, worked out by hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.compiler.rules.motion.goals import _alone_s
from cellc.compiler.rules.run import ALL_RULES
from tests.cells import CORPUS, ROOT
from tests.rules.examples import diagnose_example, examples

FIGURES = {
    # 1280 * 720 pixels of 3 bytes, 30 times a second: 663.552 Mbit/s; 0.8 of 100 Mbit/s.
    "images-beyond-link": "must take at most 80 Mbit/s of its 100 Mbit/s, got 664 Mbit/s",
    # 10 / 30 Hz; 6 fit into 200 ms.
    "queue-older-than-max-age": "at most 200 ms, the `max_age` of `/markers`, got 333.3 ms",
    "max-age-too-short": "must be at least 100 ms (period 100, transport 0, exposure 0 ms), got 50 ms",  # 1 / 10 Hz
    # 1000/30 + 8 ms of exposure, then 1000/10.
    "age-budget-exceeded": "at least 141.3 ms (`/camera/camera/color/image_raw` 41.33 ms + `/object_pose` 100 ms)",
    "budget-beyond-buffer": "at least 0.7 s (`/object_pose` 0.2 s + plan to execute 0.5 s), got 0.6 s",
    "deadline-below-period": "at least its period of 100 ms, got 50 ms",  # 1 / 10 Hz
    "goal-out-of-reach": "is 3 m from `arm_base_link`",  # (3, 0, 0.8) from (0, 0, 0.8)
    # The goal lies at 850 - 20 mm, the top of the table at 820 + 40/2.
    "goal-inside-scene": "got 10 mm within it",
    "first-motion-cannot-end": "10 deg at 1 deg/s takes 10 s",
    "gain-against-vendor": "near the vendor's 6, at most 5 times more or less, got 600",
    "twins-apart": "got 100% and 24%",
    "unit-of-another-message": "carries m, by what its messages are, got `mm`",  # REP 103
    "grip-too-weak": "at least 3.92 N to hold 0.2 kg in motion, got 1 N",  # 0.2 * (9.81 + 9.81) / (2 * 0.5)
    "discovery-port-of-many": "got that of participant 75 of domain 17",  # 7400 + 250 * 17 + 11 + 2 * 75 = 11811
    "taken-discovery-port": "got that of participant 0 of domain 17",  # 7400 + 250 * 17 + 11
    "exposure-beyond-period": "at most 32.2 ms",
    "uneven-update-rate": "must divide 500 Hz, got 300 Hz",
    # 50 % of 3 rad/s over 500 Hz.
    "unmeetable-tolerance": "must be at least 0.003 rad or m, one update at full speed",
    "degrees-as-radians": "a limit of 180 rad, which is 28.6 turns",  # 180 / 6.2832
    "tip-within-tool": "got 0.15 mm towards it",  # 0.162 along z, to a finger at (0, 0.04, 0.1): 0.162 * 0.1/0.1077
    "shared-manager-name": "managers `control` and `second` are both in namespace `/`",
    "unreachable-goal": "no joint positions were found for goal `fetch`: the nearest tip stays",
}


@pytest.mark.parametrize("code", FIGURES)
def test_figure_of_a_rule_is_that_of_the_hand(code: str, folder: Path) -> None:
    (rule,) = (rule for rule in ALL_RULES if rule.code == code)
    told = [diagnostic.message for diagnostic in diagnose_example(examples(rule)[0], folder) if diagnostic.code == code]
    assert len(told) == 1
    assert FIGURES[code] in told[0]


@pytest.mark.parametrize(
    ("way", "velocity", "acceleration", "expected_s"),
    [
        (1.0, 1.0, 2.0, 1.5),  # two ramps of 0.5 s cover 0.5, and 0.5 is left at 1 rad/s
        (0.125, 1.0, 2.0, 0.5),  # never at full speed: twice sqrt(0.125/2)
        (0.5, 1.0, 2.0, 1.0),  # just at full speed
        (1.0, 0.25, None, 4.0),
    ],
)
def test_joint_alone_takes(way: float, velocity: float, acceleration: float | None, expected_s: float) -> None:
    assert _alone_s(way, velocity, acceleration) == pytest.approx(expected_s)


IN_A_DESCRIPTION = {
    "assumed-joint-limit": "<joint ",
    "circular-mimic": "<joint ",
    "mimic-of-fixed-joint": "<joint ",
    "missing-velocity-limit": "<joint ",
    "path-tolerance-without-effect": "<joint ",
    "pose-outside-limits": "<joint ",
    "several-root-links": "<link ",
    "speed-of-some-positions": "<joint ",
    "unplannable-joint": "<joint ",
}


@pytest.mark.parametrize(("code", "element"), IN_A_DESCRIPTION.items())
def test_what_a_rule_says_of_an_element_is_shown_where_the_description_has_it(
    code: str, element: str, folder: Path
) -> None:
    (rule,) = (rule for rule in ALL_RULES if rule.code == code)
    cases = sorted((CORPUS / "invalid").glob(f"{code}-*.yaml"))
    told = [diagnostic for case in cases for diagnostic in check(case)]
    told += diagnose_example(examples(rule)[0], folder)
    places = [related.span for finding in told if finding.code == code for related in finding.related]
    assert places
    for span in places:
        assert Path(span.file).suffix in (".urdf", ".xacro")
        assert element in (ROOT / span.file).read_text(encoding="utf-8").splitlines()[span.line - 1]


def test_a_joint_of_the_catalog_is_not_shown_there(tmp_path: Path) -> None:
    spec = (ROOT / "cells/ur5e_pick/cell.yaml").read_text(encoding="utf-8")
    file = tmp_path / "cell.yaml"
    file.write_text(spec.replace("0 -90 90 -90 -90 0 deg", "0 -90 190 -90 -90 0 deg"), encoding="utf-8")
    (finding,) = (diagnostic for diagnostic in check(file) if diagnostic.code == "pose-outside-limits")
    assert finding.related == ()
