"""One line of a log: when it was written, how grave its program calls it, and what it says.

Read are what rcutils writes by default and what launch puts before it (`[LEVEL] [TIME] [name]: text`, rcutils 6.7
logging.c; `TIME [LEVEL] [name]: text`, launch 3.4 logging/__init__.py), spdlog and middleware with a local time, and
journals (systemd 255, `journalctl -o short`, its relatives with other times, and `-o json`, one entry a line).
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from enum import Enum

_COLOR = re.compile(r"\x1b\[[0-9;]*m")
_HEAD = 300
"""Characters in which time and level of a line are looked for."""
_LEVEL = re.compile(
    r"\[ ?(debug|info|warn|warning|error|critical|fatal)\]|^(warning|error|critical|fatal):", re.IGNORECASE
)
_MINOR = re.compile(r"\[(?:INFO|DEBUG)\]")
_EPOCH = re.compile(r"(?:^|[\[ ])(\d{9,10}\.\d{1,9})(?=[\] ])|\[(\d{19})\]")
_ISO = re.compile(
    r"\b(\d{4})-(\d\d)-(\d\d)[T ](\d\d):(\d\d):(\d\d)(?:[.,](\d{1,9}))?(?:\s?(Z|UTC|GMT|[+-]\d\d:?\d\d)(?!\w))?"
)
_SHORT = re.compile(r"^([A-Z][a-z]{2})\s+(\d{1,2}) (\d\d):(\d\d):(\d\d)(?:\.(\d{1,9}))?(?= )")
_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
_NO_YEAR = 2000
"""Year of a time that states none: one with a 29 February."""
_S = 1_000_000_000
_LARGEST_PRIORITY = 7


class Gravity(Enum):
    """What a program calls a line; a line that says nothing of it may be the last of a program that dies."""

    MINOR = 0
    WARNING = 1
    UNSAID = 2
    ERROR = 3


_GRAVITIES = {"debug": Gravity.MINOR, "info": Gravity.MINOR, "warn": Gravity.WARNING, "warning": Gravity.WARNING}
_PRIORITIES = {4: Gravity.WARNING, **dict.fromkeys(range(4), Gravity.ERROR)}
"""Of syslog; systemd gives 6 to whatever a program prints, so that a higher one says nothing."""


@dataclass(frozen=True, slots=True)
class Stamp:
    """A time as a line states it.

    Attributes:
        ns: since 1970 in UTC; where no zone is stated, of a clock that shows the same digits in UTC.
        zoned: the zone is known.
        dated: the year is known.
        local_ns: digits of the same instant on the clock of its computer, where the line has both.
    """

    ns: int
    zoned: bool = True
    dated: bool = True
    local_ns: int | None = None


@dataclass(frozen=True, slots=True)
class Entry:
    """One line: its time is None where it states none."""

    stamp: Stamp | None
    gravity: Gravity
    text: str


def is_minor(line: str) -> bool:
    """Tell fast that a line of a program of ROS 2 is of no gravity."""
    return _MINOR.search(line, 0, _HEAD) is not None and not line.startswith("{")


def entry_of(line: str) -> Entry:
    """Return what a line says."""
    if line.startswith("{"):
        found = _journal(line)
        if found is not None:
            return found
    text = _COLOR.sub("", line)
    return Entry(_stamp(text[:_HEAD]), _gravity(text[:_HEAD]), text)


def _gravity(head: str) -> Gravity:
    match = _LEVEL.search(head)
    if match is None:
        return Gravity.UNSAID
    return _GRAVITIES.get((match[1] or match[2]).lower(), Gravity.ERROR)


def _journal(line: str) -> Entry | None:
    """Return an entry of a journal in JSON; None where it is of another kind."""
    try:
        data = json.loads(line)
    except (ValueError, RecursionError):
        return None
    stated = data.get("__REALTIME_TIMESTAMP")
    if not isinstance(stated, str) or not re.fullmatch(r"[0-9]{1,18}", stated):
        return None
    text = _COLOR.sub("", _message(data.get("MESSAGE")))
    own, inner = _stamp(text[:_HEAD]), _gravity(text[:_HEAD])
    priority = str(data.get("PRIORITY", ""))
    given = int(priority) if re.fullmatch("[0-7]", priority) else _LARGEST_PRIORITY
    gravity = _PRIORITIES.get(given, Gravity.UNSAID) if inner is Gravity.UNSAID else inner
    return Entry(own if own is not None and own.zoned else Stamp(int(stated) * 1000), gravity, text)


def _message(value: object) -> str:
    """Return the text of an entry: journals write what is no UTF-8 as a list of bytes, and what is too long as null."""
    if isinstance(value, list) and all(isinstance(each, int) and 0 <= each < 256 for each in value):
        return bytes(value).decode("utf-8", "replace")
    return value if isinstance(value, str) else ""


def _stamp(head: str) -> Stamp | None:
    """Return the time in a line: seconds since 1970 are the best, a local time without a zone the least."""
    local = _calendar(head)
    epoch = _EPOCH.search(head)
    if epoch is None:
        return local
    if epoch[2]:
        ns = int(epoch[2])
    else:
        seconds, _, rest = epoch[1].partition(".")
        ns = int(seconds) * _S + int(rest.ljust(9, "0"))
    return Stamp(ns, local_ns=None if local is None or local.zoned else local.ns)


def _calendar(head: str) -> Stamp | None:
    short = _SHORT.match(head)
    if short is not None and short[1] in _MONTHS:
        month, day, hour, minute, second = (_MONTHS.index(short[1]) + 1, *map(int, short.group(2, 3, 4, 5)))
        return _made((_NO_YEAR, month, day, hour, minute, second), short[6], None)
    iso = _ISO.search(head)
    return None if iso is None else _made(tuple(map(int, iso.group(1, 2, 3, 4, 5, 6))), iso[7], iso[8])


def _made(digits: tuple[int, ...], fraction: str | None, zone: str | None) -> Stamp | None:
    """Return a time; None where its digits are of no day."""
    year, month, day, hour, minute, second = digits
    try:
        at = datetime(year, month, day, hour, minute, min(second, 59), tzinfo=timezone.utc)
    except ValueError:
        return None
    past = at - datetime(1970, 1, 1, tzinfo=timezone.utc)
    ns = (past.days * 86_400 + past.seconds) * _S + int((fraction or "").ljust(9, "0") or "0")
    return Stamp(ns - _offset_ns(zone), zoned=zone is not None, dated=year != _NO_YEAR)


def _offset_ns(zone: str | None) -> int:
    if zone is None or zone in ("Z", "UTC", "GMT"):
        return 0
    digits = zone.replace(":", "")
    away = timedelta(hours=int(digits[1:3]), minutes=int(digits[3:5]))
    return round(away.total_seconds()) * _S * (-1 if digits[0] == "-" else 1)


def in_year_of(stamp: Stamp, near_ns: int) -> int:
    """Return the time of a stamp without a year, in the year that puts it nearest to another time."""
    bare = datetime(1970, 1, 1, tzinfo=timezone.utc) + timedelta(microseconds=stamp.ns // 1000)
    near = datetime(1970, 1, 1, tzinfo=timezone.utc) + timedelta(microseconds=near_ns // 1000)
    years = (near.year - 1, near.year, near.year + 1)
    digits = (bare.month, bare.day, bare.hour, bare.minute, bare.second)
    made = [_made((year, *digits), f"{stamp.ns % _S:09d}", None) for year in years]
    return min((each.ns for each in made if each is not None), key=lambda ns: abs(ns - near_ns), default=stamp.ns)
