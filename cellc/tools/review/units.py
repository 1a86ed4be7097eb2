"""Values of a package as people read them: mm, degrees and percent."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Collection, Sequence

from cellc.contract.transforms import Pose, apart
from cellc.tools.review.leaves import Leaf, Prose, said
from cellc.tools.review.tokens import UNITS

_FIGURE = re.compile(r"-?[0-9]{1,15}(?:\.[0-9]{1,15})?")
_FEW = 6
"""Entries of a list that are shown; of a longer one, those that differ."""
_PLACE = 3
_TURNED = math.radians(1e-3)


def shown_both(
    before: Leaf | None,
    after: Leaf | None,
    units: tuple[str, str],
    wanted: tuple[Collection[str], Collection[str]] = ((), ()),
) -> tuple[str | None, str | None]:
    """Return two values with their units, each as a person wrote it, with few digits where these tell them apart."""
    in_unit = [
        _as_written(leaves, unit, each)
        for leaves, unit, each in zip(((before, after),) * 2, units, wanted, strict=True)
    ]
    few, all_digits = (
        (shown(before, units[0], in_unit[0], digits), shown(after, units[1], in_unit[1], digits))
        for digits in (_LEGIBLE, _EVERY)
    )
    return all_digits if few[0] == few[1] else few


def _as_written(leaves: Sequence[Leaf | None], unit: str, wanted: Collection[str]) -> Collection[str]:
    """Return the units that are wanted, with that of SI where figures are round in it alone: so a vendor has them."""
    figures = [float(leaf) for leaf in leaves if isinstance(leaf, (int, float)) and not isinstance(leaf, bool)]
    if (
        unit not in _OF_TURNS
        or not figures
        or any(UNITS[each][0] == UNITS[unit][0] for each in wanted if each in UNITS)
    ):
        return wanted
    is_round = all(math.isclose(_rounded(figure), figure, rel_tol=1e-9) for figure in figures)
    degrees = map(math.degrees, figures)
    return (
        wanted if not is_round or all(math.isclose(_rounded(f), f, rel_tol=1e-9) for f in degrees) else {*wanted, unit}
    )


_OF_TURNS = ("rad/s", "rad/s^2", "rad/s^3")
_LEGIBLE, _EVERY = 5, 7
"""Digits of a figure that people compare, and of any other."""


def shown(value: Leaf | None, unit: str, wanted: Collection[str] = (), digits: int = 7) -> str | None:
    """Return a value with its unit.

    Args:
        unit: SI unit of numbers, empty where they have none.
        wanted: units in which a person wrote it: of one dimension the one of them, else what reads best.
        digits: of a number that is no part of a list or a pose.
    """
    if value is None:
        return None
    if isinstance(value, Prose):
        return value.text
    if isinstance(value, Pose):
        turn = " ".join(_number(math.degrees(angle)) for angle in value.rpy())
        return f"xyz {_numbers(value.position, 1e3)} mm, rpy {turn} deg"
    if isinstance(value, tuple):
        return _shown_list(value, unit, wanted)
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else _with_unit(value, unit, wanted, digits)


_ENDS = (("_s", "s"), ("_hz", "Hz"), ("_m", "m"), ("_kg", "kg"), ("center_of_mass", "m"))


def unit_in(name: str) -> str:
    """Return the unit that the name of a value ends in, or that it always has."""
    return next((unit for end, unit in _ENDS if name.endswith(end)), "")


def _shown_list(value: tuple[str | float | int | bool, ...], unit: str, wanted: Collection[str]) -> str:
    if value and all(isinstance(item, (int, float)) and not isinstance(item, bool) for item in value):
        factor, name = _scale(unit, wanted)
        return f"{_numbers(tuple(float(item) for item in value), factor)} {name}".rstrip()
    return ", ".join(said(item) for item in value) if len(value) <= _FEW else f"{len(value)} entries"


_SHOWN = {
    "m": (1e3, "mm"),
    "rad": (math.degrees(1.0), "deg"),
    "ratio": (100.0, "%"),
    "m/s": (1e3, "mm/s"),
    "rad/s": (math.degrees(1.0), "deg/s"),
    "m/s^2": (1e3, "mm/s^2"),
    "rad/s^2": (math.degrees(1.0), "deg/s^2"),
    "m/s^3": (1e3, "mm/s^3"),
    "rad/s^3": (math.degrees(1.0), "deg/s^3"),
}


def _with_unit(value: float, unit: str, wanted: Collection[str] = (), digits: int = 7) -> str:
    factor, name = _scale(unit, wanted)
    if name == unit == "s" and 0.0 < abs(value) < 1.0 and unit not in wanted:
        return f"{_number(value * 1e3, digits)} ms"
    return f"{_number(value * factor, digits)} {name}".rstrip()


def _scale(unit: str, wanted: Collection[str]) -> tuple[float, str]:
    """Return the factor from SI and the name of the unit in which a value is shown."""
    of_kind = [each for each in wanted if each in UNITS and unit in UNITS and UNITS[each][0] == UNITS[unit][0]]
    if "/" in unit and len(of_kind) == 1:
        return 1.0 / UNITS[of_kind[0]][1], of_kind[0]
    base, slash, rest = unit.partition("/")
    kind = UNITS.get(base, ("", 1.0))[0]
    written = {each for each in wanted if each and kind and UNITS[each][0] == kind}
    if len(written) != 1:
        return _SHOWN.get(unit, (1.0, unit))
    (name,) = written
    return 1.0 / UNITS[name][1], name + slash + rest


def units_in(text: str) -> frozenset[str]:
    """Return the units of the quantities in a text of a spec."""
    return frozenset(word for word in _APART.split(text) if word in UNITS)


_APART = re.compile(r"[\s,:{}\[\]]+")


def _numbers(values: tuple[float, ...], factor: float) -> str:
    return " ".join(_number(value * factor) for value in values)


def _number(value: float, digits: int = 7) -> str:
    return f"{round(value, 6) + 0.0:.{digits}g}" if abs(value) < 10.0 ** (digits - 1) else f"{value:.7g}"


def difference(
    before: Leaf | None, after: Leaf | None, unit: str, *, share: bool = True, wanted: Collection[str] = ()
) -> str:
    """Return how much a value differs; empty where that has no size.

    Args:
        share: whether it is shown as a share of what was there.
        wanted: as of `shown`.
    """
    if isinstance(before, Pose) and isinstance(after, Pose):
        return motion(*apart(before, after))
    if isinstance(before, tuple) and isinstance(after, tuple):
        return _of_lists(before, after)
    if isinstance(before, Prose) and isinstance(after, Prose):
        return _of_quantities(before.text, after.text) if share else ""
    if isinstance(before, (bool, str, Prose)) or isinstance(after, (bool, str, Prose)):
        return ""
    if not isinstance(before, (int, float)) or not isinstance(after, (int, float)):
        return ""
    if isinstance(before, int) and isinstance(after, int):
        return ""
    if unit == "ratio":
        return f"{'+' * (after > before)}{_number(100.0 * (after - before))} points"
    if share and before > 0.0 <= after and (after or unit not in ("m", "rad")):
        return f"{_rounded(100.0 * (after - before) / before):+.10g} %"
    sign = "+" if after > before else ""
    return sign + _with_unit(after - before, unit, wanted)


def _of_quantities(before: str, after: str) -> str:
    """Return the share by which a quantity differs from another of its kind, or how far a place is from another."""
    (was, kind), (now, other) = (quantity_of(text) for text in (before, after))
    if not kind or kind != other or len(was) != len(now):
        return ""
    if len(was) == _PLACE and kind == "length":
        return motion(math.dist(was, now), 0.0)
    if len(was) != 1:
        return ""
    if was[0] > 0.0 <= now[0]:
        return f"{_rounded(100.0 * (now[0] - was[0]) / was[0]):+.10g} %"
    unit = _SI.get(kind)
    return "" if unit is None else f"{'+' * (now[0] > was[0])}{_with_unit(now[0] - was[0], unit)}"


_SI = {kind: unit for unit, (kind, factor) in UNITS.items() if factor == 1.0}


def quantity_of(text: str) -> tuple[tuple[float, ...], str]:
    """Return the figures of a text in SI, and of which kind they are; nothing where it is no quantity."""
    *figures, unit = text.split() or [""]
    name, factor = UNITS.get(unit, ("", None))
    if not figures or not all(_FIGURE.fullmatch(figure) for figure in figures):
        return (), ""
    return tuple(float(figure) * (1.0 if factor is None else factor) for figure in figures), name or unit


def motion(meters: float, radians: float) -> str:
    """Return how far something moves and turns."""
    parts = [f"moves {length(meters)}"] if meters > 1e-9 else []
    # Beside a motion, what rounding turns is left out.
    turns = radians > (1e-7 if meters <= 1e-9 else _TURNED)
    parts += [f"turns {_number(_rounded(math.degrees(radians)))} deg"] if turns else []
    return ", ".join(parts)


def length(meters: float) -> str:
    """Return a length of three digits."""
    shown = _rounded(meters)
    return f"{shown * 1e3:.9f}".rstrip("0").rstrip(".") + " mm" if shown < 1.0 else f"{shown:.10g} m"


def _rounded(value: float) -> float:
    """Return three digits of a value, which is then written without a power of ten."""
    return float(f"{value:.3g}")


def _of_lists(before: tuple[str | float | int | bool, ...], after: tuple[str | float | int | bool, ...]) -> str:
    if max(len(before), len(after)) <= 1 or not all(isinstance(item, str) for item in (*before, *after)):
        return ""
    gone, come = Counter(map(said, before)), Counter(map(said, after))
    lost, new = sorted((gone - come).elements()), sorted((come - gone).elements())
    parts = [f"lost {', '.join(lost)}"] if lost else []
    parts += [f"new {', '.join(new)}"] if new else []
    return "; ".join(parts) or "in another order"
