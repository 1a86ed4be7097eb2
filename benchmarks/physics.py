"""How much faster than real time rehearsals run with masses: `python -m benchmarks.physics [CELL …]`.

Time on the processor of one process, which other processes do not add to; the median of some runs after a first one
that plans the motions. Without masses beside it, and the share that MuJoCo itself takes: its steps alone, as many.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from statistics import median
from time import process_time

from cellc.contract.printing import show
from cellc.mock.cell import MockCell, load
from cellc.robot.physics.scene import Bodies, Scene

_RUNS = 7
_STEPS = 5000


def main() -> None:
    """Print one line for each cell."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cells", nargs="*", default=["ur5e_pick"])
    for name in parser.parse_args().cells:
        folder = Path("generated") / name
        having, without = load(folder, physics=True), load(folder)
        scene = having.folder.scene
        assert scene is not None, "it was loaded with masses"
        longest = max(having.rehearsals, key=lambda each: having.run(each).sim_time_s)
        figures = f"{_times(having, longest):.0f} x real time with masses, {_times(without, longest):.0f} x without"
        show(f"{name}, {longest}: {figures}; steps of MuJoCo alone {_steps(scene):.0f} x")


def _times(cell: MockCell, rehearsal: str) -> float:
    cell.run(rehearsal)
    found: list[float] = []
    for _ in range(_RUNS):
        start_s = process_time()
        simulated_s = cell.run(rehearsal).sim_time_s
        found.append(simulated_s / (process_time() - start_s))
    return median(found)


def _steps(scene: Scene) -> float:
    bodies = Bodies(scene)
    aims = scene.aims(bodies.state())
    start_s = process_time()
    bodies.run(_STEPS, aims)
    return _STEPS * scene.step_ns / 1e9 / (process_time() - start_s)


if __name__ == "__main__":
    main()
