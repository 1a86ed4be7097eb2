"""The core schema of YAML 1.2.2, section 10.3.2: which plain scalars are not strings.

PyYAML resolves by YAML 1.1, where ``on`` is true, ``010`` is 8 and ``12:30:00`` is 45000; hence an own resolver.
"""

from __future__ import annotations

import math
import re

from cellc.compiler.source.document import PlainScalar
from cellc.contract.errors import CellcError

_WORDS: dict[str, PlainScalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((sign + word for sign in ("", "+") for word in (".inf", ".Inf", ".INF")), math.inf),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), -math.inf),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), math.nan),
}
# 010 is the decimal 10: octal is written 0o10 in YAML 1.2.
_DECIMAL = re.compile(r"[-+]?[0-9]+")
_OCTAL = re.compile(r"0o([0-7]+)")
_HEXADECIMAL = re.compile(r"0x([0-9a-fA-F]+)")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")

_BEGINS_NUMBERS = frozenset("+-.0123456789")

# ROS parameters, JSON readers and C++ take 64 bits; a longer literal is a name that lost its quotes.
_SMALLEST_INTEGER = -(2**63)
_LARGEST_INTEGER = 2**63 - 1
_LONGEST_INTEGER_TEXT = 80


class NumberOutOfRangeError(CellcError, ValueError):
    """A literal that has the form of a number but no 64-bit value."""


def resolve(text: str) -> PlainScalar:
    """Return the value of a plain (unquoted) scalar.

    Raises:
        NumberOutOfRangeError: an integer beyond 64 bits, or a finite decimal that a double cannot hold.
    """
    if text in _WORDS:
        return _WORDS[text]
    if text[0] not in _BEGINS_NUMBERS:
        return text
    if _DECIMAL.fullmatch(text):
        return _integer(text, 10)
    if match := _OCTAL.fullmatch(text):
        return _integer(match[1], 8)
    if match := _HEXADECIMAL.fullmatch(text):
        return _integer(match[1], 16)
    if _FLOAT.fullmatch(text):
        return _float(text)
    return text


def _integer(digits: str, base: int) -> int:
    # The length is bounded first: Python refuses or takes quadratic time on thousands of digits.
    if len(digits) > _LONGEST_INTEGER_TEXT:
        raise NumberOutOfRangeError
    value = int(digits, base)
    if not _SMALLEST_INTEGER <= value <= _LARGEST_INTEGER:
        raise NumberOutOfRangeError
    return value


def _float(text: str) -> float:
    value = float(text)
    if math.isinf(value):
        raise NumberOutOfRangeError
    return value
