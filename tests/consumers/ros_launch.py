"""Answers what the real `ros2 launch` starts: run by an interpreter that has launch, launch_xml, launch_ros and rclpy.

Reads a JSON list of requests on standard input, each a file with its arguments, and writes for each the command lines
in their order, or why launching stops. Nothing is started: what would start a process notes its command line.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from typing import Any
from unittest.mock import MagicMock

_ANSWERS, sys.stdout = sys.stdout, sys.stderr  # launching logs to standard output

if find_spec("composition_interfaces") is None:  # of composable nodes, which no wheel has and no file of ours has
    sys.modules["composition_interfaces"] = sys.modules["composition_interfaces.srv"] = MagicMock()

import launch_ros.actions  # noqa: E402, F401
from launch import LaunchService  # noqa: E402
from launch.actions import ExecuteProcess  # noqa: E402
from launch.frontend import Parser  # noqa: E402
from launch.utilities import perform_substitutions  # noqa: E402


def _visited(entity: Any, context: Any) -> Iterator[Any]:
    for inner in entity.visit(context) or ():
        yield inner
        yield from _visited(inner, context)


def answer(file: str, given: dict[str, str]) -> dict[str, object]:
    """Return what a file starts, or why it does not."""
    started: list[list[str]] = []

    def note(process: Any, context: Any) -> None:
        started.append([perform_substitutions(context, word) for word in process.cmd])

    ExecuteProcess.execute = note
    context = LaunchService(noninteractive=True).context
    context.launch_configurations.update(given)
    try:
        root, parser = Parser.load(file)
        for _ in _visited(parser.parse_description(root), context):
            pass
    except Exception as error:  # what the frontend, an action or a substitution says
        return {"stopped": str(error)}
    return {"started": started}


if __name__ == "__main__":
    json.dump([answer(**request) for request in json.load(sys.stdin)], _ANSWERS)
