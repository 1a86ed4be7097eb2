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
