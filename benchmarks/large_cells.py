"""Times the check of ever larger cells in one process: devices, frames and interfaces grow together.

``python benchmarks/large_cells.py [--runs 3]``. The largest has 50 devices, 500 frames and 1,000 interfaces. Prints a
Markdown table for ``benchmarks/README.md``; the last column is the time per interface, which stays level where growth
is linear.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from cellc.compiler.pipeline import check  # noqa: E402  the checkout comes before what is installed

_TOPIC = {
    "topic": "geometry_msgs/msg/PoseStamped", "wants": "newest", "frame": "world", "rate": "10 Hz",
    "max_age": "200 ms", "on_stale": "reject_goal",
}  # fmt: skip


def large_cell(devices: int) -> str:
    """Write a spec with ten frames and twenty topics for each device, one in ten of which is an arm that is driven."""
    arms = [f"device_{number}" for number in range(devices) if number % 10 == 0]
    spec = {
        "format": 1,
        "cell": f"large_{devices}",
        "versions": {"ros": "jazzy"},
        "devices": {
            f"device_{number}": {
                "model": "ur5e" if number % 10 == 0 else "robotiq_2f_85",
                "mount": {"parent": "world", "xyz": f"{2 * (number // 7)} {2 * (number % 7)} 0 m"},
            }
            for number in range(devices)
        },
        "frames": {
            f"frame_{number}": {
                "parent": "world" if number % 5 == 0 else f"frame_{number - 1}", "xyz": "0.1 0 0 m", "designed": True,
            }
            for number in range(10 * devices)
        },
        "nodes": {f"node_{number}": {"run": "tasks/node", "owner": "team"} for number in range(2 * devices)},
        "interfaces": {
            f"/topic_{number}": {
                **_TOPIC,
                "from": {f"node_{number % (2 * devices)}": {"depth": 1}},
                "to": {f"node_{(number + 1 + number // (2 * devices)) % (2 * devices)}": {"depth": 1}},
            }
            for number in range(20 * devices)
        },
        "control": {
            "update_rate": "500 Hz",
            "controllers": {"joint_states": {"type": "joint_state_broadcaster"}}
            | {
                f"{arm}_trajectory": {
                    "type": "scaled_joint_trajectory", "device": arm, "goal_time": "1 s", "client": "node_0",
                    "path_tolerance": "0.2 rad", "goal_tolerance": "0.01 rad",
                }
                for arm in arms
            },
        },
    }  # fmt: skip
    return json.dumps(spec, indent=1)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    runs = parser.parse_args().runs
    print("| devices | frames | interfaces | findings | first s | median s | ms per interface |\n" + "|---" * 7 + "|")
    with tempfile.TemporaryDirectory() as folder:
        for devices in (10, 20, 30, 40, 50):
            file = Path(folder) / f"large_{devices}.yaml"
            file.write_text(large_cell(devices), encoding="utf-8")
            times = []
            for _ in range(runs + 1):
                begin = time.perf_counter()
                checked = check(file)
                times.append(time.perf_counter() - begin)
            middle = statistics.median(times[1:])
            row = (devices, 10 * devices, 20 * devices, len(checked.diagnostics), f"{times[0]:.2f}", f"{middle:.2f}")
            print("|", " | ".join(str(value) for value in row), f"| {middle * 1e3 / (20 * devices):.2f} |", flush=True)


if __name__ == "__main__":
    main()
