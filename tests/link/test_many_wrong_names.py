"""A spec with thousands of wrong references is refused soon, and says how many were not looked at."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check

_MANY = 300
_MOST = 100  # docs of `MAX_FINDINGS`

_TOPIC = {"topic": "geometry_msgs/msg/PoseStamped", "wants": "newest", "frame": "world", "rate": "10 Hz"}
_STAGE = {"model": "pedestal", "mount": {"parent": "world", "xyz": "0 0 0 m"}}
_NODE = {"run": "tasks/node", "owner": "team"}

WRONG = {
    "frames": {"frames": {f"f{n}": {"parent": f"nothing{n}", "xyz": "0 0 0 m"} for n in range(_MANY)}},
    "models": {"devices": {f"d{n}": {"model": f"nothing{n}", "mount": _STAGE["mount"]} for n in range(_MANY)}},
    "mounts": {
        "devices": {f"d{n}": {**_STAGE, "mount": {"parent": f"nothing{n}", "xyz": "0 0 0 m"}} for n in range(_MANY)}
    },
    "hosts": {"nodes": {f"n{n}": {**_NODE, "host": f"nothing{n}"} for n in range(_MANY)}},
    "ends": {
        "nodes": {"n": _NODE},
        "interfaces": {f"/t{n}": {**_TOPIC, "from": "n", "to": f"nothing{n}"} for n in range(_MANY)},
    },
    "ends of one topic": {
        "nodes": {"n": _NODE},
        "interfaces": {"/t": {**_TOPIC, "from": "n", "to": [f"nothing{n}" for n in range(_MANY)]}},
    },
    "controllers": {
        "control": {
            "update_rate": "500 Hz",
            "controllers": {f"c{n}": {"type": f"nothing{n}", "device": "d"} for n in range(_MANY)},
        },
    },
}


@pytest.mark.parametrize("sections", WRONG.values(), ids=WRONG)
def test_binding_stops_and_says_what_it_left(sections: dict[str, object], tmp_path: Path) -> None:
    spec = {"format": 1, "cell": "large", "versions": {"ros": "jazzy"}, "devices": {"d": _STAGE}, **sections}
    (tmp_path / "cell.yaml").write_text(json.dumps(spec), encoding="utf-8")
    checked = check(tmp_path / "cell.yaml")
    assert not checked.ok
    assert {finding.code.partition("-")[0] for finding in checked} == {"unknown"}
    (last,) = (finding for finding in checked if "not checked after so many findings: " in finding.help)
    left = int(last.help.rpartition("findings: ")[2].split()[0])
    assert len(checked.diagnostics) == _MOST
    assert left == _MANY - _MOST


def _topics(comments: int) -> str:
    """Return a spec in which no topic says what its reader wants; the first ones have a comment that excuses it."""
    lines = ["format: 1", "cell: large", "versions: {ros: jazzy}", "nodes: {n: {run: tasks/node, owner: team}}"]
    lines += [f"devices: {{d: {json.dumps(_STAGE)}}}", "interfaces:"]
    for number in range(_MANY):
        excuse = "  # cellc: ignore unstated-need -- the reader is not ours" if number < comments else ""
        lines.append(f"  /t{number}: {{topic: std_msgs/msg/Empty, rate: 10 Hz, from: n, to: n}}{excuse}")
    return "\n".join(lines)


@pytest.mark.parametrize("excused", [0, 150])
def test_findings_of_one_code_are_cut_after_comments_have_excused_theirs(excused: int, tmp_path: Path) -> None:
    (tmp_path / "cell.yaml").write_text(_topics(excused), encoding="utf-8")
    found = [finding for finding in check(tmp_path / "cell.yaml") if finding.code == "unstated-need"]
    assert len(found) == _MOST
    assert found[0].span.line == 7 + excused
    assert found[-1].help.endswith(f"; not shown: {_MANY - excused - _MOST} more `unstated-need`")
