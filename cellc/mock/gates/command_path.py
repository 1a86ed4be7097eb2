"""L6 of the network, discovery and time gate: goal to mock controller; owner, cancel, tolerance trace."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.mock.gates.description import read_description
from cellc.mock.gates.gate import GateCheck, judged
from cellc.mock.gates.trace import cancel_trace, commanded, goal_trace, owners, tolerance_trace
from cellc.mock.gates.witness import Testimony

_MOCK_PACKAGE = "mock_components/"
"""Package of ros2_control whose plugins have nothing behind them."""


def command_path_checks(testimony: Testimony) -> Iterator[GateCheck]:
    """Yield the lines of L6."""
    yield _no_real_interface(testimony)
    yield owners(testimony)
    for name, _ in commanded(testimony):
        yield goal_trace(testimony, name)
        yield cancel_trace(testimony, name)
        yield tolerance_trace(testimony, name)


def _no_real_interface(testimony: Testimony) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for component, plugin in read_description(testimony.folder.urdf).plugins.items():
        (good if plugin.startswith(_MOCK_PACKAGE) else bad).append(f"{component}: {plugin or 'no plugin'}")
    name = testimony.contract.files.urdf_mock
    return judged(f"No component of {name} is a route to a real interface", good, bad, "a hardware component")
