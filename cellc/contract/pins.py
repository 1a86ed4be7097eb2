"""What a spec pins: versions such as ``driver_package 3.8.0``, as a number or as a commit, and days."""

from __future__ import annotations

import datetime
import re

_NUMBER = re.compile(r"\d+(?:\.\d+)*")
_PACKAGE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]*")
_COMMIT = re.compile(r"(?=.*[a-f])[0-9a-f]{7,40}|[0-9a-f]{40}")


def last_word(text: str) -> str:
    """Return the version of a pin as it is written; empty where nothing is."""
    return text.split()[-1] if text.split() else ""


def pinned_package(text: str) -> str:
    """Return the package of a pin that is a package and its version; empty for a pin of another form."""
    words = text.split()
    return words[0] if len(words) == 2 and _PACKAGE.fullmatch(words[0]) else ""


def is_commit(version: str) -> bool:
    """Whether a version is the hash of a commit, in full or cut short; what has digits alone is a number."""
    return _COMMIT.fullmatch(version) is not None


def version_number(text: str) -> str:
    """Return the number in a pin; empty without one, as in one that names a commit."""
    last = last_word(text)
    match = None if is_commit(last) else _NUMBER.search(last)
    return match.group() if match else ""


def version_numbers(text: str) -> tuple[int, ...]:
    """Return a version as numbers that compare; empty for a commit."""
    return tuple(int(part) for part in version_number(text).split(".") if part)


def same_version(text: str, known: str) -> bool:
    """Whether a pin names a version of the catalog; a commit may be cut short."""
    pinned = last_word(text)
    if is_commit(known):
        return is_commit(pinned) and known.startswith(pinned)
    return not is_commit(pinned) and version_number(text) == version_number(known) != ""


def older(text: str, minimum: str) -> bool:
    """Whether a pin has a number below a minimum; one without a number is not."""
    ours = version_numbers(text)
    return bool(ours) and ours < version_numbers(minimum)


DAY_PATTERN = "[0-9]{4}-[0-9]{2}-[0-9]{2}"


def day_of(text: str) -> datetime.date | None:
    """Return the day of a text YYYY-MM-DD; None of any other, on every Python: newer ones read weeks of a year too."""
    try:
        return datetime.date.fromisoformat(text) if re.fullmatch(DAY_PATTERN, text) else None
    except ValueError:
        return None
