"""What a text names by itself: the topic, node, manager or address on which its commands should run."""

from __future__ import annotations

import re

from cellc.tools.diagnose.fields import Scope

_TOPIC = re.compile(
    r"(?:\btopics?|\becho|\bhz|\bdelay|\binfo|\bsubscrib\w+ to|\bpublish\w* (?:to|on)|\breceiv\w+ (?:on|from))"
    r"(?: the| topic| --\w+)*[ :'\"`]+(/[A-Za-z]\w*(?:/\w+)*)(?![\w/.]*\.\w)"
)
_LOGGER = re.compile(r"\[ ?(?:ERROR|FATAL|WARN|INFO)\] ?(?:\[[\d. :-]+\]:? ?)?\[([A-Za-z]\w*(?:\.\w+)*)\]")
_GRAVE = re.compile(r"\[ ?(?:ERROR|FATAL)\]")
_IP = re.compile(r"(?<![\w.:])(\d{1,3}(?:\.\d{1,3}){3})(?![\w.])")
_PORT = re.compile(r"/dev/(?:tty|serial/|usb)[\w./-]*\w")
_MANAGER = "controller_manager"
NO_NODE = "NODE"
"""Is written for the node behind a logger that the cell does not have."""


def names_of(text: str, scope: Scope) -> dict[str, str]:
    """Return the fields of a subject that a text states."""
    if scope in ("device", "arm", "gripper", "camera"):
        address = _PORT.search(text) or _IP.search(text)
        return {} if address is None else {"address": address[0]}
    if scope == "topic":
        topic = _TOPIC.search(text)
        return {} if topic is None else {"topic": topic[1]}
    full = loggers(text)
    if scope == "manager":
        of_manager = next((name for name in full if name.endswith(f"/{_MANAGER}")), None)
        return (
            {} if of_manager is None else {"manager": of_manager, "namespace": of_manager.removesuffix(f"/{_MANAGER}")}
        )
    return {"node": NO_NODE} if scope == "node" and full else {}


def loggers(text: str) -> tuple[str, ...]:
    """Return what may be the full names of the nodes that wrote the lines of a text, those of errors first.

    A logger has the name of its node, with a point for each slash, or a name below it. Which of the two, and whether it
    is of a node at all, the graph alone knows: each beginning is a name that the cell may have.
    """
    lines = sorted(text.splitlines(), key=lambda line: _GRAVE.search(line) is None)
    found = (match[1].split(".") for line in lines for match in _LOGGER.finditer(line))
    return tuple(dict.fromkeys("/" + "/".join(name[:end]) for name in found for end in range(len(name), 0, -1)))
