"""Says where the CPU time of a rehearsal goes, and how much faster than real time it runs.

``python benchmarks/rehearsal_speed.py [FOLDER] [--rehearsal NAME] [--processes 7]`` prints Markdown tables for
``benchmarks/README.md``. Every figure is the median over fresh processes of CPU time, which a busy machine disturbs
little. The first run of a process has no plan kept, a later one has all of them. Parts are measured in processes of
their own, because measuring takes time itself; time of a part within another one is not counted twice.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
LATER_RUNS = 5
PARTS = {
    "planning": [
        "cellc.mock.nodes.motion_planner:MotionPlanner.plan",
        "cellc.mock.nodes.motion_planner:MotionPlanner.attach",
    ],
    "control": [
        "cellc.mock.engine.control_stack:ControlStack.advance",
        "cellc.mock.control:ControllerManager.send_goal",
        "cellc.mock.control:ControllerManager.cancel_goal",
    ],
    "perception": [
        "cellc.mock.nodes.perception:Camera._deliver",
        "cellc.mock.nodes.perception:Perception._look",
        "cellc.mock.nodes.perception:Perception._publish",
    ],
    "transforms": [
        "cellc.mock.tf.buffer:TransformBuffer.lookup",
        "cellc.mock.nodes.robot_state_publisher:RobotStatePublisher.catch_up",
    ],
    "bring-up": ["cellc.mock.cell:assemble", "cellc.mock.bringup:Bringup.run"],
}
"""Functions by part, as module:name; what is in none of them is the task, the clock and the records."""


class Meter:
    """Attributes CPU time to the innermost part that runs."""

    def __init__(self) -> None:
        self.spent_ns: dict[str, int] = {}
        self._running = ["rest"]
        self._since_ns = time.thread_time_ns()

    def switch(self) -> None:
        """Attribute the time since the last switch."""
        now_ns = time.thread_time_ns()
        part = self._running[-1]
        self.spent_ns[part] = self.spent_ns.get(part, 0) + now_ns - self._since_ns
        self._since_ns = now_ns

    def enter(self, part: str) -> None:
        self.switch()
        self._running.append(part)

    def leave(self) -> None:
        self.switch()
        self._running.pop()

    def watch(self, part: str, place: str) -> None:
        """Replace a function by one that is measured; of a generator each step is."""
        module_name, _, path = place.partition(":")
        owner: Any = __import__(module_name, fromlist=["_"])
        *outer, name = path.split(".")
        for attribute in outer:
            owner = getattr(owner, attribute)
        function: Callable[..., Any] = getattr(owner, name)

        @wraps(function)
        def measured(*arguments: Any, **named: Any) -> Any:
            self.enter(part)
            try:
                result = function(*arguments, **named)
            finally:
                self.leave()
            return self._steps(part, result) if hasattr(result, "send") else result

        setattr(owner, name, measured)

    def _steps(self, part: str, body: Any) -> Any:
        value = None
        while True:
            self.enter(part)
            try:
                wait = body.send(value)
            except StopIteration as end:
                return end.value
            finally:
                self.leave()
            value = yield wait


def work(folder: Path, rehearsal: str, with_parts: bool) -> dict[str, Any]:
    """Measure in this process, which has imported nothing of cellc yet; times are ms of CPU."""
    begun = time.process_time()
    import cellc.mock.command.rehearsals  # noqa: F401 - what the command imports

    imported = time.process_time()
    from cellc.mock import load

    cell = load(folder)
    loaded = time.process_time()
    meter = Meter()
    for part, places in PARTS.items() if with_parts else ():
        for place in places:
            meter.watch(part, place)
    runs = []
    for _ in range(1 + LATER_RUNS):
        meter.spent_ns.clear()
        meter.switch()
        meter.spent_ns.clear()
        start = time.process_time()
        result = cell.run(rehearsal)
        total = time.process_time() - start
        meter.switch()
        parts = {part: spent / 1e6 for part, spent in meter.spent_ns.items()}
        runs.append({"ms": total * 1e3, "parts": parts, "simulated_s": result.sim_time_s})
    control = control_alone(folder)
    return {"import": (imported - begun) * 1e3, "load": (loaded - imported) * 1e3, "runs": runs, "control": control}


def control_alone(folder: Path, seconds: int = 30) -> float:
    """Return how much faster than real time a manager runs one long trajectory, heard and woken as in a rehearsal."""
    from cellc.mock.control import ControllerManager, TrajectoryGoal, TrajectoryPoint
    from cellc.mock.folder import read_folder

    read = read_folder(folder)
    contract = read.contract
    name, manager = next(iter(contract.managers.items()))
    control = ControllerManager(
        read.urdf, read.parameters[name], distro=contract.distro, plugin_behaviors=contract.plugin_behaviors
    )
    control.spawn(list(manager.controllers))
    arm, facts = next(entry for entry in manager.controllers.items() if "trajectory" in (entry[1].behavior or ""))
    for controller, entry in manager.controllers.items():
        if entry.behavior == "joint_state_broadcaster":
            control.subscribe_joint_states(controller)
    rest = (0.0,) * len(facts.joints)
    points = tuple(
        TrajectoryPoint((0.05 * (tick % 4),) * len(rest), rest, rest, time_from_start_ns=tick * 500_000_000)
        for tick in range(1, 2 * seconds + 1)
    )
    control.advance(1_000_000_000)
    assert control.send_goal(arm, TrajectoryGoal(facts.joints, points)).accepted
    start, until_ns = time.process_time(), control.now_ns + seconds * 1_000_000_000
    while control.now_ns < until_ns:
        control.advance(min(until_ns, control.now_ns + 200_000_000))
        for controller, entry in manager.controllers.items():
            if entry.behavior == "joint_state_broadcaster":
                control.take_joint_states(controller)
    return seconds / (time.process_time() - start)


def processes(arguments: argparse.Namespace, with_parts: bool) -> list[dict[str, Any]]:
    """Measure in fresh processes, one after the other.

    The first one is not counted: it compiles the modules, as it is done once on a user's machine, and warms the disk.
    """
    command = [sys.executable, __file__, arguments.folder, "--rehearsal", arguments.rehearsal, "--work"]
    environment = {**os.environ, "CELLC_NO_CACHE": "1", "CELLC_PARTS": "1" if with_parts else ""}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    found = []
    with tempfile.TemporaryDirectory() as compiled:
        environment["PYTHONPYCACHEPREFIX"] = compiled
        for _ in range(arguments.processes + 1):
            done = subprocess.run(command, env=environment, cwd=ROOT, check=True, capture_output=True, text=True)
            found.append(json.loads(done.stdout))
    return found[1:]


def middle(of: Callable[[dict[str, Any]], float], among: list[dict[str, Any]]) -> float:
    """Return the median over processes."""
    return float(statistics.median(of(each) for each in among))


def later(each: dict[str, Any], of: Callable[[dict[str, Any]], float]) -> float:
    """Return the median over all runs of a process but the first."""
    return float(statistics.median(of(run) for run in each["runs"][1:]))


def spent(part: str) -> Callable[[dict[str, Any]], float]:
    """Return what reads the time of a part from a run."""
    return lambda run: float(run["parts"].get(part, 0.0))


def report(whole: list[dict[str, Any]], split: list[dict[str, Any]]) -> None:
    """Print the tables."""
    simulated_ms = whole[0]["runs"][0]["simulated_s"] * 1e3
    first_ms = middle(lambda each: each["runs"][0]["ms"], whole)
    later_ms = middle(lambda each: later(each, lambda run: run["ms"]), whole)
    print("| CPU time, median | ms | times real time |\n|---|---|---|")
    print(f"| imports | {middle(lambda each: each['import'], whole):.0f} | |")
    print(f"| loading the folder | {middle(lambda each: each['load'], whole):.1f} | |")
    print(f"| first run, {simulated_ms / 1e3:.2f} s simulated | {first_ms:.1f} | {simulated_ms / first_ms:.0f} |")
    print(f"| later runs, plans kept | {later_ms:.1f} | {simulated_ms / later_ms:.0f} |")
    print(f"| control loop alone, in a trajectory | | {middle(lambda each: each['control'], whole):.0f} |")
    print("\n| part | first run ms | later run ms |\n|---|---|---|")
    for read in ((part, spent(part)) for part in (*PARTS, "rest")):
        first = statistics.median(read[1](each["runs"][0]) for each in split)
        kept = statistics.median(later(each, read[1]) for each in split)
        print(f"| {read[0]} | {first:.1f} | {kept:.1f} |")


def main() -> None:
    """Parse the command line and measure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", nargs="?", default="generated/ur5e_pick", help="folder that `cellc build` wrote")
    parser.add_argument("--rehearsal", default="pick_and_place")
    parser.add_argument("--processes", type=int, default=7)
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.work:
        sys.path.insert(0, str(ROOT))
        print(json.dumps(work(Path(arguments.folder), arguments.rehearsal, bool(os.environ.get("CELLC_PARTS")))))
    else:
        report(processes(arguments, with_parts=False), processes(arguments, with_parts=True))


if __name__ == "__main__":
    main()
