"""Whatever text stands anywhere in a spec or a device: it is refused, or it is text in all that is made of them.

A share of ``python -m tests.emit.taint --all``, which gives every payload to every place.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.emit.taint.cells import variants
from tests.emit.taint.judge import differences
from tests.emit.taint.judges import readings
from tests.emit.taint.payloads import PAYLOADS, twin_of
from tests.emit.taint.rounds import run

# Each with another part of the payloads; places of descriptions take the longest, and are tried by the script.
_ROUNDS = (("ur5e_pick-humble", "single", 2), ("fr3_hand-lyrical", "single", 7), ("complete", "family", 1))


@pytest.mark.parametrize(("name", "kind", "turn"), _ROUNDS)
def test_every_place_refuses_a_hostile_text_or_it_is_text_everywhere(
    tmp_path: Path, name: str, kind: str, turn: int
) -> None:
    done = run(tmp_path, variants()[name], kind, turn, (".yaml",) if kind == "single" else (".yaml", ".urdf"))
    assert not done.faults
    assert len(done.trial.refused) > 200
    assert len(done.trial.taken) > 10


@pytest.mark.parametrize(
    ("path", "hostile"),
    [
        ("a.urdf", '<robot name="a"><link name="{}"/></robot>'),
        ("launch/a.launch.xml", '<launch><node exec="{}"/></launch>'),
        ("a.yaml", "a: {}\n"),
        ("a.json", '{{"a": "{}"}}'),
        ("a.bash", "echo {}\n"),
        ("README.md", "# a\n\nb {} c\n"),
        ("graph/a.mmd", 'flowchart LR\n  a["{}"]\n'),
        ("graph/a.svg", '<svg xmlns="http://www.w3.org/2000/svg"><text>{}</text></svg>'),
    ],
)
def test_a_text_that_is_written_as_it_is_would_be_seen(path: str, hostile: str) -> None:
    texts = {twin_of(f"tq0001q {payload}"): f"tq0001q {payload}" for payload in PAYLOADS.values()}
    seen = [
        payload
        for twin, payload in texts.items()
        if list(differences({path: hostile.format(payload)}, {path: hostile.format(twin)}, {twin: payload}))
    ]
    assert len(seen) >= 2, path
    assert readings(path, hostile.format("a"))
