"""Numbers, vectors and poses in URDF attributes, each refused with its place where it is malformed."""

from __future__ import annotations

import math
import re

from cellc.contract.diagnostics import Diagnostic, Severity
from cellc.contract.errors import CellcError
from cellc.contract.transforms import Pose, Vector3, from_xyz_rpy, identity
from cellc.robot.description.xml_tree import XmlElement

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_MAX_TEXT = 200
_MAX_REASON = 500
_FARTHEST = 1e6
"""Of lengths and angles, m and rad: what is farther off than a country is wide overflows in the geometry."""
_LARGEST = 1e20
"""Of every other number; exporters write 1e16 for a limit that there is not."""


class UrdfError(CellcError):
    """One link or joint cannot be read; ``diagnostic`` says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


def refused(code: str, element: XmlElement, message: str, help_text: str = "") -> UrdfError:
    """Build the exception that stops the reading of one link or joint."""
    return UrdfError(Diagnostic(code, Severity.ERROR, message, element.span, help=help_text))


def reason_of_urdfdom(said: list[str], otherwise: str) -> str:
    """Return in one line what the reader of URDF that others build on printed of a file that it refuses.

    Args:
        said: lines such as ``Error:   material 'a' is not unique.``, each followed by its place in the reader's source.
        otherwise: what its caller raised, for a reader that said nothing.
    """
    reasons = (line.removeprefix("Error:").strip().rstrip(".") for line in said if line.startswith("Error:"))
    return "; ".join(dict.fromkeys(reasons))[:_MAX_REASON] or otherwise


def required(element: XmlElement, attribute: str) -> str:
    """Return an attribute that URDF demands and that may not be empty."""
    value = element.attributes.get(attribute, "").strip()
    if not value:
        raise refused("urdf-missing-attribute", element, f"`<{element.tag}>` has no `{attribute}`")
    return value


def required_child(element: XmlElement, tag: str) -> XmlElement:
    """Return the child that URDF demands."""
    child = element.first(tag)
    if child is None:
        name = element.attributes.get("name")
        of = f"`<{element.tag}>`" if name is None else f'`<{element.tag} name="{name}">`'
        raise refused("urdf-missing-element", element, f"{of} has no `<{tag}>`")
    return child


def number(element: XmlElement, attribute: str) -> float:
    """Return a finite number of a required attribute."""
    return _bounded(element, attribute, required(element, attribute), _LARGEST)


def optional_number(element: XmlElement, attribute: str) -> float | None:
    """Return a finite number, or None where the attribute is absent."""
    return number(element, attribute) if attribute in element.attributes else None


def number_or(element: XmlElement, attribute: str, default: float) -> float:
    """Return a finite number, or the default of the URDF specification."""
    return number(element, attribute) if attribute in element.attributes else default


def length(element: XmlElement, attribute: str) -> float:
    """Return a finite length of a required attribute."""
    return _bounded(element, attribute, required(element, attribute), _FARTHEST)


def numbers(element: XmlElement, attribute: str, count: int) -> tuple[float, ...]:
    """Return exactly ``count`` finite numbers separated by white space: lengths, angles, factors or colors."""
    parts = required(element, attribute).split()
    if len(parts) != count:
        message = f"`{attribute}` of `<{element.tag}>` has {len(parts)} numbers, expected {count}"
        raise refused("urdf-bad-number", element, message)
    return tuple(_bounded(element, attribute, part, _FARTHEST) for part in parts)


def vector(element: XmlElement, attribute: str) -> Vector3:
    """Return three finite numbers."""
    x, y, z = numbers(element, attribute, 3)
    return (x, y, z)


def origin_pose(element: XmlElement) -> Pose:
    """Return the pose of the ``<origin>`` child: meters and fixed-axis roll, pitch, yaw; identity where absent."""
    origin = element.first("origin")
    if origin is None:
        return identity()
    zero = (0.0, 0.0, 0.0)
    xyz = vector(origin, "xyz") if "xyz" in origin.attributes else zero
    rpy = vector(origin, "rpy") if "rpy" in origin.attributes else zero
    return from_xyz_rpy(xyz, rpy)


def _bounded(element: XmlElement, attribute: str, text: str, most: float) -> float:
    value = float(text) if len(text) <= _MAX_TEXT and _NUMBER.fullmatch(text) else math.nan
    if not math.isfinite(value):
        message = f"`{text[:40]}` in `{attribute}` of `<{element.tag}>` is not a finite number"
        raise refused("urdf-bad-number", element, message)
    if abs(value) > most:
        message = f"`{attribute}` of `<{element.tag}>` must be from {-most:g} to {most:g}, got {value:g}"
        raise refused("urdf-bad-number", element, message)
    return value
