"""Reads what tools of hand-eye calibration write: the pose of one frame in another, by the names of the tool.

- easy_handeye2 (b42cae6, handeye_calibration.py and handeye_publisher.py): YAML of a HandeyeCalibration message; the
  camera is ``tracking_base_frame``, in the effector or the base of the robot. The form of easy_handeye for ROS 1 too.
- MoveIt's calibration display for ROS 2: a launch file in Python whose static_transform_publisher has the pose as
  arguments. Its text is searched for them, and never run.
- a mapping in YAML or JSON with ``parent`` and ``child``, and a 4x4 ``matrix``, or ``xyz`` with ``xyzw``, ``wxyz`` or
  ``rotation``: meters.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NoReturn

from cellc.compiler.link.side_file import SideFile, compose_side_file, number
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Quaternion, Vector3, from_xyz_rpy, quaternion_of

CODE = "invalid-hand-eye"
_LARGEST_M = 20.0
"""A camera is nearer to its robot: what is farther is in millimeters."""
_UNIT = 1e-3
"""How far a quaternion or a column of a matrix may be from unit length: tools write four digits and more."""
_LITERAL = re.compile(r""""([^"\\\n]*)"|'([^'\\\n]*)'""")
_MOUNTING = re.compile(r"\bEYE-(IN-HAND|TO-HAND)\b")
_AXES = ("x", "y", "z", "w")


@dataclass(frozen=True, slots=True)
class HandEyeFile:
    """A pose of ``child`` in ``parent``, by the tool's names; None for names and a mounting that it does not tell.

    ``place`` is where the names stand, or the pose.
    """

    parent: str | None
    child: str | None
    pose: Pose
    in_hand: bool | None
    place: Span


class _MalformedError(Exception):
    """Ends the reading of a file at what is wrong with it."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


def read_hand_eye(file: SideFile) -> Outcome[HandEyeFile]:
    """Return the calibration in a file, whose format follows from its content; a problem is located at its line."""
    try:
        if "static_transform_publisher" in file.text:
            return Outcome(_of_launch(file))
        content = compose_side_file(file)
        return Outcome(None, content.diagnostics) if content.value is None else Outcome(_of_data(content.value))
    except _MalformedError as wrong:
        return Outcome(None, (wrong.diagnostic,))


def _fail(place: Span, message: str, help_: str = "export the calibration again") -> NoReturn:
    raise _MalformedError(Diagnostic(CODE, Severity.ERROR, message, place, (), help_))


def _of_data(content: SourceDocument) -> HandEyeFile:
    if content.has(("parameters",)):
        return _of_easy_handeye(content)
    parent, child = (_name(content, keys) for keys in (("parent", "frame_id"), ("child", "child_frame_id")))
    return HandEyeFile(parent, child, _pose(content, ()), None, content.locate(("child",)))


def _of_easy_handeye(content: SourceDocument) -> HandEyeFile:
    path = ("parameters", "calibration_type")
    if content.has(path):
        kind = content.text_at(path)
        if kind not in ("eye_in_hand", "eye_on_base"):
            _fail(content.locate(path), f"`calibration_type` must be `eye_in_hand` or `eye_on_base`, got `{kind}`")
        in_hand, at = kind == "eye_in_hand", ("transform",)
    else:
        in_hand, at = content.text_at(("parameters", "eye_on_hand")).lower() == "true", ("transformation",)
    key = "robot_effector_frame" if in_hand else "robot_base_frame"
    names = [content.text_at(("parameters", name)) for name in (key, "tracking_base_frame")]
    for name, value in zip((key, "tracking_base_frame"), names, strict=True):
        if not value:
            _fail(content.locate(("parameters", name)), f"`parameters.{name}` is missing")
    return HandEyeFile(names[0], names[1], _pose(content, at), in_hand, content.locate(("parameters", key)))


def _name(content: SourceDocument, keys: Sequence[str]) -> str | None:
    return next((content.text_at((key,)) for key in keys if content.has((key,))), None)


def _pose(content: SourceDocument, at: YamlPath) -> Pose:
    if not content.has(at):
        _fail(content.locate(()), f"`{at[-1]}` is missing")
    if content.has((*at, "matrix")):
        return _of_matrix(content, (*at, "matrix"))
    position = _vector(content, at, ("xyz", "translation"))
    return Pose(position, _unit(_rotation(content, at), content.locate(at)))


def _vector(content: SourceDocument, at: YamlPath, keys: Sequence[str]) -> Vector3:
    """Return a translation, as a list or a mapping, or beside the rotation."""
    path = next(((*at, key) for key in keys if content.has((*at, key))), at)
    steps: Sequence[str | int] = (0, 1, 2) if content.has((*path, 0)) else _AXES[:3]
    x, y, z = (_figure(content, (*path, step)) for step in steps)
    return (x, y, z)


def _rotation(content: SourceDocument, at: YamlPath) -> Quaternion:
    for key, steps in (("xyzw", (0, 1, 2, 3)), ("wxyz", (1, 2, 3, 0))):
        if content.has((*at, key)):
            x, y, z, w = (_figure(content, (*at, key, step)) for step in steps)
            return (x, y, z, w)
    for key in ("quaternion", "rotation"):
        if content.has((*at, key, 0)):
            place = content.locate((*at, key))
            _fail(place, f"`{key}` is a list that does not say whether w is first or last", "name it `xyzw` or `wxyz`")
    rotation = next(((*at, key) for key in ("rotation", "quaternion") if content.has((*at, key))), None)
    path, names = (at, ("qx", "qy", "qz", "qw")) if rotation is None else (rotation, _AXES)
    x, y, z, w = (_figure(content, (*path, name)) for name in names)
    return (x, y, z, w)


def _figure(content: SourceDocument, at: YamlPath) -> float:
    text = content.text_at(at)
    value = number(text, _LARGEST_M)
    name = ".".join(map(str, at))
    if not content.has(at):
        _fail(content.locate(at), f"`{name}` is missing")
    if math.isnan(value):
        bounds = f"a number of meters between -{_LARGEST_M:g} and {_LARGEST_M:g}, or of a rotation"
        _fail(content.locate(at), f"`{name}` must be {bounds}, got `{text}`", "write meters, and a plain number")
    return value


def _of_matrix(content: SourceDocument, at: YamlPath) -> Pose:
    """Return the pose of a homogeneous matrix: rows as lists, or sixteen figures row by row."""
    nested = content.has((*at, 0, 0))
    rows = [[_figure(content, (*at, i, j) if nested else (*at, 4 * i + j)) for j in range(4)] for i in range(4)]
    place = content.locate(at)
    if any(abs(value - expected) > 1e-9 for value, expected in zip(rows[3], (0.0, 0.0, 0.0, 1.0), strict=True)):
        _fail(place, "the last row of `matrix` must be 0 0 0 1", "write the matrix row by row, translation last")
    columns = [[rows[i][j] for i in range(3)] for j in range(3)]
    products = [
        (sum(a * b for a, b in zip(columns[i], columns[j], strict=True)), 1.0 if i == j else 0.0)
        for i in range(3)
        for j in range(i, 3)
    ]
    if any(abs(value - expected) > 2.0 * _UNIT for value, expected in products) or _determinant(columns) < 0.0:
        _fail(place, "the rotation in `matrix` must be orthonormal and right-handed", "export the calibration again")
    return Pose((rows[0][3], rows[1][3], rows[2][3]), _unit(quaternion_of(rows), place))


def _determinant(columns: list[list[float]]) -> float:
    a, b, c = columns
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return sum(factor * other for factor, other in zip(cross, c, strict=True))


def _unit(quaternion: Quaternion, place: Span) -> Quaternion:
    length = math.sqrt(sum(value * value for value in quaternion))
    if abs(length - 1.0) > _UNIT:
        _fail(place, f"the rotation must be a quaternion of length 1, got {length:.4g}")
    x, y, z, w = (value / length for value in quaternion)
    return (x, y, z, w)


def _of_launch(file: SideFile) -> HandEyeFile:
    """Return the arguments of the publisher: each option's text is the literal after it."""
    literals = list(_literals(file))
    options: dict[str, tuple[str, Span]] = {}
    for (name, place), (value, _) in pairwise(literals):
        if name.startswith("--"):
            if name in options:
                _fail(place, f"`{name}` is given twice; a file has one transform")
            options[name] = (value, place)
    start = Span(file.name, 1, 1, 1, 1)

    def figures(*names: str) -> Iterator[float]:
        for name in names:
            text, place = options.get(name, ("0", start))
            value = number(text, _LARGEST_M)
            if math.isnan(value):
                _fail(place, f"`{name}` must be a number of meters or of a rotation, got `{text}`")
            yield value

    x, y, z = figures("--x", "--y", "--z")
    if "--qw" in options:
        qx, qy, qz, qw = figures("--qx", "--qy", "--qz", "--qw")
        pose = Pose((x, y, z), _unit((qx, qy, qz, qw), options["--qw"][1]))
    else:
        roll, pitch, yaw = figures("--roll", "--pitch", "--yaw")
        pose = from_xyz_rpy((x, y, z), (roll, pitch, yaw))
    for name in ("--frame-id", "--child-frame-id"):
        if name not in options:
            _fail(start, f"no argument `{name}` of `static_transform_publisher` is found")
    mounting = _MOUNTING.search(file.text)
    in_hand = None if mounting is None else mounting[1] == "IN-HAND"
    parent, place = options["--frame-id"]
    return HandEyeFile(parent, options["--child-frame-id"][0], pose, in_hand, place)


def _literals(file: SideFile) -> Iterator[tuple[str, Span]]:
    """Yield the text literals of a program in order, those of comments left out."""
    for number_, line in enumerate(file.text.split("\n"), start=1):
        if not line.lstrip().startswith("#"):
            for match in _LITERAL.finditer(line):
                text = match[1] if match[1] is not None else match[2]
                yield text, Span(file.name, number_, match.start() + 1, number_, match.end() + 1)
