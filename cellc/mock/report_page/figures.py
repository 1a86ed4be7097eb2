"""Numbers with their units, as people read them."""

from __future__ import annotations

_NONE = "–"


def seconds(value_s: float | None) -> str:
    """Return a time: milliseconds below one second."""
    if value_s is None:
        return _NONE
    if abs(value_s) < 1.0:
        return f"{value_s * 1e3:.3g} ms"
    return f"{value_s:.4g} s"


def at(stamp_ns: int) -> str:
    """Return an instant of simulated time."""
    return f"{stamp_ns / 1e9:.3f} s"


def span(low: float, high: float, unit: str) -> str:
    """Return the range of a joint's positions, with four digits after the point."""
    return f"{low:.4f} … {high:.4f} {unit}".replace("-", "−")


def small(value: float, unit: str) -> str:
    """Return a deviation in thousandths or millionths of its unit, whatever reads best; rounding is no deviation."""
    for factor, prefix in ((1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n")):
        if abs(value) * factor >= 1.0:
            return f"{value * factor:.3g} {prefix}{unit}"
    return f"0 {unit}" if value == 0.0 else f"below 1 n{unit}"


def plain(value: float | None, unit: str) -> str:
    """Return a figure of the checkpoint."""
    if value is None:
        return _NONE
    if unit == "s":
        return seconds(value)
    return f"{value:.0%}" if unit == "share" else f"{value:g} {unit.removesuffix('s') if value == 1 else unit}"


def count(number: int, noun: str) -> str:
    """Return a number with its noun, in the plural where there are several."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
