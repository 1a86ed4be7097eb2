"""Values that programs stumble over: numbers, texts, shapes."""

from __future__ import annotations

import random

from tests.robustness.fuzz.tree import Raw, Tree

NUMBERS = (
    "0", "-0.0", "1", "-1", "0.5", "2", "3", "7", "100", "1e-320", "5e-324", "1e-12", "1e6", "1e9", "-1e9", "1e12",
    "1e18", "1e300", "-1e300", "1e308", "1e309", "1e400", "2147483647", "2147483648", "-2147483649", "4294967296",
    "9223372036854775808", "18446744073709551616", "9" * 400, "0." + "0" * 400 + "1", "3.141592653589793",
    "6.2831853", "0.1", "1e2", "255", "65535", "65536",
)  # fmt: skip
_YAML_NUMBERS = (
    ".nan",
    ".inf",
    "-.inf",
    "NaN",
    "nan",
    "inf",
    "0x1F",
    "0o17",
    "017",
    "1_000",
    "1:30",
    "+1",
    "0x" + "f" * 300,
    "1e",
    ".5",
    "5.",
)
_JSON_NUMBERS = ("NaN", "Infinity", "-Infinity", "1e999", "-1e999", "01", "1.", "+1", "9" * 5000)
UNITS = (
    "m", "mm", "cm", "deg", "rad", "s", "ms", "us", "ns", "Hz", "kHz", "%", "kg", "g", "N", "Nm", "m/s", "rad/s",
    "deg/s", "m/s^2", "rad/s^3", "x", "",
)  # fmt: skip
TEXTS = (
    "", " ", "  a", "UNKNOWN", "none", "null", "~", "true", "no", "on", "y", "2026-01-01", "2026-13-45", "latest",
    "world", "arm", "arm/", "/", "/arm", "a/b/c", "arm/base_link", "..", "../..", "./", "./device",
    "../../../etc/passwd", "/etc/passwd", "/dev/zero", "/dev/null", "CON", "a b", "a.b", "a:b", "a: b", "a #b", "#",
    "*", "*a", "&a", "!!python/object/apply:os.getcwd []", "!!binary aGk=", "%TAG", "---", "...", "{}", "[]", "{",
    "]", "'", '"', "\\", "`", "${1+1}", "$(env HOME)", "$(find x)", "$${x}", "${", "$(", "<script>alert(1)</script>",
    "</robot>", "<![CDATA[", "]]>", "&amp;", "&#0;", "::error::x", "##[error]x", "%0a::error::x", "a\nb", "a\r\nb",
    "\t", "\x00", "\x1b[31m", "\x9b31m", "\u202ex", "\u2066x", "\u200b", "\ufeff", "\ufffe", "\ud800", "é", "日本", "𝒳",
    "İ", "ß", "a" * 64, "a" * 300, "x" * 5000, "-", "--help", "-1", "0", "1e400", "nan m", "1e9 mm", "-5 m", "0 0 0",
    "0 0 0 deg", "0 0 0 0", "1 2 3 4 5 6 7 8", "0 0 0 m 0", "0 0 1e309 m", "nan nan nan rad", "=", "<<", "@", "|",
    ">", "?", "joint_1", "base", "tool0", "task", "{prefix}", "{device}", "{address}", "{nothing}", "{0}",
    "{prefix!r}", "{device.__class__}", "%s", "%(x)s", "package://x/y.stl", "file:///etc/passwd",
    "http://localhost/x", "sensor_msgs/msg/Image", "a/msg/b", "mock_components/GenericSystem", "1.0", "1.2.3",
    "999999999999.0.0", "v1", "reliable", "best_effort",
)  # fmt: skip
_SHAPES: tuple[Tree, ...] = (
    {},
    [],
    [[]],
    {"": ""},
    [None],
    {"a": {"b": {}}},
    [{}],
    ["", ""],
    {"*": {}},
    [0, 0, 0],
    {"x": 1},
    ["a"] * 20,
)
_DEPTHS = (3, 20, 63, 64, 65, 100, 500, 1000, 5000)


def hostile(chance: random.Random, *, json: bool = False) -> Tree:
    """Return a hostile value for a YAML document, or for a JSON one."""
    draw = chance.random()
    if draw < 0.35:
        return Raw(number(chance, json=json))
    if draw < 0.75:
        return chance.choice(TEXTS)
    if draw < 0.80 and not json:
        return Raw(f"{number(chance)} {chance.choice(UNITS)}")
    if draw < 0.92:
        return chance.choice((None, True, False, *_SHAPES))
    return nested(chance) if draw < 0.96 else crowd(chance)


def number(chance: random.Random, *, json: bool = False) -> str:
    """Return a number as text."""
    return chance.choice(NUMBERS + (_JSON_NUMBERS if json else _YAML_NUMBERS))


def nested(chance: random.Random) -> Tree:
    """Return a value that is deep."""
    depth = chance.choice(_DEPTHS)
    opening, closing = chance.choice((("[", "]"), ('{"a": ', "}")))
    return Raw(opening * depth + "0" + closing * depth)


def crowd(chance: random.Random) -> Tree:
    """Return a collection that is long."""
    size = chance.choice((50, 200, 1000, 3000))
    if chance.random() < 0.5:
        return {f"k{number}": "x" for number in range(size)}
    return [chance.choice(TEXTS)] * size
