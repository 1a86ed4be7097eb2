"""What a run among real nodes is asked for."""

from __future__ import annotations

import sys
from pathlib import Path

from cellc.contract.frozen import dataclass

OWN_DOMAIN = 100
"""Apart from the domains that cells state, and free of ephemeral ports on every system (0 to 101 are):
https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Domain-ID.html"""


@dataclass(frozen=True, slots=True)
class Timing:
    """What was asked for.

    Attributes:
        pace: seconds of the run in one second of the host; None for lockstep: time stays until the answers are there
            that the contract expects.
        patience_s: how long an answer is waited for, in seconds of the host.
    """

    pace: float | None = 1.0
    patience_s: float = 5.0


@dataclass(frozen=True, slots=True)
class AmongNodes:
    """What is asked for.

    Attributes:
        without: names of nodes of the contract that are not played.
        interpreter: Python of a ROS environment.
        domain: of the graph.
        launch: command that starts the nodes under test for each rehearsal; empty where somebody else does.
        appear_s: how long they may take to appear, in seconds of the host.
    """

    without: tuple[str, ...]
    interpreter: str
    timing: Timing = Timing()
    domain: int = OWN_DOMAIN
    launch: str = ""
    appear_s: float = 30.0

    def words(self) -> tuple[str, ...]:
        """Return the options that ask for this."""
        pace = ("--lockstep",) if self.timing.pace is None else ("--pace", f"{self.timing.pace:g}")
        started = ("--launch", self.launch) if self.launch else ()
        return ("--ros", "--without", ",".join(self.without), *pace, "--domain", str(self.domain), *started)


def usual_interpreter() -> str:
    """Return the Python of a ROS installation: the system's, for which the packages of a distribution are built."""
    system = Path("/usr/bin/python3")
    return str(system) if system.exists() else sys.executable
