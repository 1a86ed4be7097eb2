"""Reads parameter files with the real parser: one node a request, `--params-file`, values back with their types.

Run as a program, because the middleware belongs into a process of its own: requests as JSON on standard input (name,
namespace, files), answers as JSON on standard output (parameters by name, each a type and a value).
"""

from __future__ import annotations

import json
import sys
from typing import Any

import rclpy
from rclpy.node import Node


def answer(request: dict[str, Any]) -> dict[str, tuple[str, object]]:
    """Start a node as its process is started and return what it was told."""
    arguments = ["--ros-args", *(part for file in request["files"] for part in ("--params-file", file))]
    node = Node(
        request["name"],
        namespace=request["namespace"] or "/",
        cli_args=arguments,
        use_global_arguments=False,
        start_parameter_services=False,
        enable_rosout=False,
        allow_undeclared_parameters=True,
        automatically_declare_parameters_from_overrides=True,
    )
    try:
        told = node.get_parameters_by_prefix("")
        return {
            name: (one.type_.name, list(one.value) if one.type_.name.endswith("ARRAY") else one.value)
            for name, one in told.items()
        }
    finally:
        node.destroy_node()


def main() -> None:
    """Answer every request of standard input."""
    requests = json.load(sys.stdin)
    rclpy.init(args=[])
    json.dump([answer(request) for request in requests], sys.stdout)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
