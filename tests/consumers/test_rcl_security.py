"""What real nodes open against what the emitted policy grants them. Needs the extra ``ros``.

The wheels of rclpy are built without DDS security, so that nothing is enforced here (``test_security_enforced.py`` does
where the middleware can): the generated program of the bring-up and nodes of the cell run on the real client library,
the graph of ROS tells what each has opened, and each of those is looked up in what sros2 would make of the policy,
``permissions.py``.
"""

from __future__ import annotations

import importlib.util
import json
import os
import re
import subprocess
import sys
from functools import lru_cache
from pathlib import Path

import pytest

from tests.consumers.matrix import HERE, build
from tests.consumers.permissions import Permissions, Right, permissions
from tests.consumers.starting import plan, proven
from tests.emit.cells import contract_data

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None, reason="rclpy is not installed: the extra `ros` brings it"
)

_DISTRO = "kilted"  # that of the wheels
CELLS = ("ur5e_pick", "fr3_hand", "two_arms")
_SIDES: dict[str, tuple[Right, Right]] = {"topic": ("publish", "subscribe"), "service": ("reply", "request")}
# rcl_action: an action is three services and two topics, the other way round for who calls it.
_OF_ACTION = (
    *(("service", name) for name in ("send_goal", "cancel_goal", "get_result")),
    *(("topic", name) for name in ("feedback", "status")),
)


def _ends(cell: str, node: str) -> list[tuple[Right, str]]:
    """Return what a node has by the contract, an action as what rcl_action makes of it."""
    found: list[tuple[Right, str]] = []
    for name, one in contract_data(build(cell, _DISTRO).texts["contract.json"])["interfaces"].items():
        for side, key in enumerate(("sources", "sinks")):
            if not any(end["node"] == node for end in one[key]):
                continue
            if one["kind"] == "action":
                found += [(_SIDES[kind][side], f"{name}/_action/{part}") for kind, part in _OF_ACTION]
            else:
                found.append((_SIDES[one["kind"]][side], name))
    return found


@lru_cache(maxsize=8)
def opened(cell: str) -> dict[str, list[tuple[Right, str]]]:
    """Return what the nodes of a cell open, by their names."""
    nodes = [node for node in build(cell, _DISTRO).graph.cell.nodes if node.package == "cell_tasks" or node.lifecycle]
    steps = plan(cell, _DISTRO)
    phases = {step["phase"] for target in ("mock", "real") for step in steps[target]}
    job = {
        "program": build(cell, _DISTRO).texts["scripts/bring_up"],
        "plan": {**steps, **{target: proven(steps, target) for target in ("mock", "real")}},
        "phases": sorted(phases),
        "watch": build(cell, _DISTRO).texts.get("scripts/claim_watch", ""),
        "nodes": [
            {
                "name": node.name,
                "namespace": node.namespace,
                "lifecycle": node.lifecycle,
                "ends": _ends(cell, node.name),
            }
            for node in nodes
        ],
    }
    environment = {**os.environ, "ROS_DOMAIN_ID": "97", "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}
    run = subprocess.run(
        [sys.executable, str(HERE / "ros_endpoints.py")],
        input=json.dumps(job),
        text=True,
        capture_output=True,
        env=environment,
    )
    assert run.returncode == 0, run.stderr[-2000:]
    return {name: [(right, end) for right, end in found] for name, found in json.loads(run.stdout).items()}


def _enclave(cell: str, node: str) -> str:
    return f"/{cell}/bring_up" if node.startswith(("bring_up_", "claim_watch")) else f"/{cell}{node}"


def denied(cell: str, granted: dict[str, Permissions]) -> list[str]:
    """Return every end that a node opened and has no right to."""
    return [
        f"{node}: {right} {name}"
        for node, found in opened(cell).items()
        for right, name in found
        if not granted[_enclave(cell, node)].allow(right, name)
    ]


@pytest.mark.parametrize("cell", CELLS)
def test_whatever_a_real_node_opens_is_granted_to_it(cell: str) -> None:
    assert sum(map(len, opened(cell).values())) > 20
    assert denied(cell, permissions(build(cell, _DISTRO).texts)) == []


def test_each_grant_that_is_missing_refuses_a_real_node(capsys: pytest.CaptureFixture[str]) -> None:
    # Each end alone: what the node opened is taken out of the permissions, and the node is refused just there.
    granted = permissions(build("ur5e_pick", _DISTRO).texts)
    refused = 0
    for node, found in opened("ur5e_pick").items():
        enclave = _enclave("ur5e_pick", node)
        for right, name in found:
            without = {**granted, enclave: granted[enclave].without(right, name)}
            assert f"{node}: {right} {name}" in denied("ur5e_pick", without)
            refused += 1
    with capsys.disabled():
        print(f"\n{refused} ends of {len(opened('ur5e_pick'))} real nodes: granted, and refused without their grant")
    assert refused > 40


def test_the_bring_up_asks_managers_and_never_for_motion() -> None:
    own = (found for node, found in opened("ur5e_pick").items() if "up_" in node)
    asks = {name for found in own for right, name in found if right == "request"}
    assert {f"/controller_manager/{name}" for name in ("list_controllers", "switch_controller")} <= asks
    assert not [name for name in asks if "/_action/" in name]


_SOCKETS = """
import os, rclpy
rclpy.init()
node = rclpy.create_node("a")
own = {os.readlink(one.path)[8:-1] for one in os.scandir("/proc/self/fd") if os.path.islink(one.path)}
for line in open("/proc/self/net/udp").read().splitlines()[1:]:
    if line.split()[9] in own:
        address = line.split()[1].split(":")[0]
        print(".".join(str(int(address[at : at + 2], 16)) for at in (6, 4, 2, 0)))
"""


def test_a_real_node_opens_no_socket_beyond_the_cards_of_its_profile(tmp_path: Path) -> None:
    # Discovery is `localhost` there: under LOCALHOST sockets stood on every card and on 0.0.0.0, with the same profile.
    texts = build("ur5e_pick", _DISTRO).texts
    (tmp_path / "profile.xml").write_text(texts["middleware/control_pc.fastdds.xml"], encoding="utf-8")
    told = dict(re.findall(r'^export (\w+)="([^$"]*)"$', texts["middleware/control_pc.sh"], re.MULTILINE))
    told |= {"FASTDDS_DEFAULT_PROFILES_FILE": str(tmp_path / "profile.xml"), "ROS_DOMAIN_ID": "97"}
    run = subprocess.run(
        [sys.executable, "-c", _SOCKETS], env={**os.environ, **told}, capture_output=True, text=True, check=True
    )
    assert set(run.stdout.split()) == {"127.0.0.1"}, run.stderr
