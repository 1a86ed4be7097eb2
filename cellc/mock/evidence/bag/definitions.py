"""The message definitions of the standard interfaces, as a bag carries them: `msg/<package>/<Type>.msg`.

They hold the fields of common_interfaces, geometry2 and control_msgs without their comments. Where a distribution has
another definition of a type, it stands under `msg/<distribution>/`.
"""

from __future__ import annotations

import re
from importlib.resources import files

_PRIMITIVES = ("byte", "float64", "int32", "string", "uint32")
"""Those that occur in the definitions here."""
_SEPARATOR = "=" * 80
_FIELD = re.compile(r"([A-Za-z][\w/]*)(?:\[[^\]]*\])? +\w+")


def schema(name: str, distro: str) -> str:
    """Return the definition of a message and of all messages in it, in the ros2msg encoding of MCAP.

    Args:
        name: full name, such as `sensor_msgs/msg/JointState`.
        distro: ROS 2 distribution whose definition counts.
    """
    package, _, kind = name.split("/")
    parts = _with_parts(f"{package}/{kind}", distro, [])
    texts = [_text(parts[0], distro), *(f"MSG: {part}\n{_text(part, distro)}" for part in parts[1:])]
    return f"{_SEPARATOR}\n".join(texts)


def _with_parts(name: str, distro: str, found: list[str]) -> list[str]:
    """Return a message and the messages in it, each once, in the order in which they are met."""
    if name not in found:
        found.append(name)
        for part in _parts(name, distro):
            _with_parts(part, distro, found)
    return found


def _parts(name: str, distro: str) -> list[str]:
    package = name.split("/")[0]
    types = [match[1] for match in map(_FIELD.match, _text(name, distro).splitlines()) if match]
    return [kind if "/" in kind else f"{package}/{kind}" for kind in types if kind not in _PRIMITIVES]


def _text(name: str, distro: str) -> str:
    folder = files("cellc.mock.evidence.bag") / "msg"
    own = folder / distro / f"{name}.msg"
    return (own if own.is_file() else folder / f"{name}.msg").read_text(encoding="utf-8")
