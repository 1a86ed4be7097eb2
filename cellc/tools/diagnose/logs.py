"""Logs of any number and size, searched once for what the symptoms know; kept is the first line of each symptom.

No more is read than the limit `log-bytes`, a line is cut at 64 KiB, and what is left out is named.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import BinaryIO

from cellc.contract.attempt import Layer
from cellc.contract.errors import CellcError, reason_of
from cellc.contract.limits import limits, option
from cellc.contract.printing import stage
from cellc.contract.store.regular_file import open_regular
from cellc.tools.diagnose.classify import Match, logged
from cellc.tools.diagnose.log_entry import Gravity, Stamp, entry_of, in_year_of, is_minor

_LONGEST = 1 << 16
"""Bytes of a line; what follows is left out."""
_HEAD = 8192
_READ_WHOLE = 1000
"""Lines of a file of which each is read for its time; later ones of no gravity are passed over."""
_MOST_FILES = 10_000
_MOST_ODD = 5
"""Errors of a file that no symptom has which are kept."""
_MOST_TOLD = 8
_MOST_SHORT = 8192
"""Letters of a log that can be answered as a whole, as if it had been pasted."""
_FAILS = re.compile(
    r"\b(error|fail\w*|fault|cannot|can't|can not|could not|couldn't|unable|refused|denied|rejected|invalid|timeout"
    r"|timed? out|not (found|available|started|possible|responding|valid|supported|(fully )?set)|disconnect\w*|lost"
    r"|abort\w*|died|crash\w*|exception|unexpected|violat\w*|incompatible|mismatch|undefined|no such)\b",
    re.IGNORECASE,
)
_QUARTER_NS = 15 * 60 * 1_000_000_000
"""Zones are whole quarters of an hour away from UTC."""


class LogError(CellcError):
    """There is no log to read."""


@dataclass(frozen=True, slots=True)
class Spoken:
    """The first line of a symptom.

    Attributes:
        at_ns: since 1970 in UTC; None where neither the line nor one before it in its file states a time.
        file: with `line` the place, from 1.
        count: lines of the symptom, in all files.
        layer: of an attempt; None where the symptom is of none.
    """

    at_ns: int | None
    file: str
    line: int
    gravity: Gravity
    text: str
    match: Match
    count: int = 1

    @property
    def layer(self) -> Layer | None:
        """The layer that the line shows."""
        return self.match.symptom.shown_by(self.match.template)


@dataclass(frozen=True, slots=True)
class Unread:
    """The first error that no symptom has.

    Attributes:
        at_ns, file, line: as of ``Spoken``.
        count: such errors, in all files.
    """

    at_ns: int | None
    file: str
    line: int
    text: str
    count: int = 1


@dataclass(frozen=True, slots=True)
class Searched:
    """What some logs say.

    Attributes:
        spoken: in the order of time, at last those without one.
        unread: None where every error is one that a symptom has.
        notes: what was left out, or is less certain, one line each.
        odd: the first errors that no symptom has, in the order of time.
        short: the whole text of a log that is no longer than what people paste; empty for others.
    """

    spoken: tuple[Spoken, ...]
    files: int
    lines: int
    notes: tuple[str, ...]
    unread: Unread | None = None
    odd: tuple[Unread, ...] = ()
    short: str = ""

    @property
    def pasted(self) -> str:
        """The first errors, a line each, and known warnings before them; the first warning where there is no error."""
        grave: list[Spoken | Unread] = [each for each in self.spoken if each.gravity is not Gravity.WARNING]
        lines = sorted([*grave, *self.odd], key=_order)
        first = _order(lines[0]) if lines else None
        early = [each for each in self.spoken if first is not None and _order(each) < first]
        lines = [*early[:1], *lines] if lines else list(self.spoken[:1])
        return "\n".join(dict.fromkeys(each.text for each in lines[:_MOST_TOLD]))

    @property
    def answered(self) -> str:
        """What is answered as if it had been pasted: all of a short log, the first lines of gravity of a long one.

        A short log whose lines are all of no gravity is of a start without trouble: it is empty. One that states no
        gravity speaks by a known line, or by a word of failure.
        """
        lines = [line for line in self.short.splitlines() if line.strip()]
        grave = [line for line in lines if entry_of(line).gravity is not Gravity.MINOR]
        speaks = self.pasted or (grave and (logged(self.short) or any(map(_FAILS.search, grave))))
        return self.short if speaks and self.short else self.pasted

    @property
    def first(self) -> Spoken | None:
        """The line that names the layer: the first error; without an error, the first warning."""
        of_layer = [each for each in self.spoken if each.layer not in (None, Layer.UNKNOWN)]
        grave = [each for each in of_layer if each.gravity is not Gravity.WARNING]
        return next(iter(grave or of_layer or self.spoken), None)


_Key = tuple[str, Layer | None, bool]
"""Symptom, layer, and whether it is a warning."""


@dataclass(slots=True)
class _File:
    """What is kept of one file: lines by symptom, once for each way to state a time.

    Attributes:
        offset_ns: how far its local time is ahead of UTC.
        epoch_ns: the first time whose zone is known.
        passed: the line before, where it was passed over.
        odd: the first errors that no symptom has; ``odd_count`` all of them.
        unstated: what its times do not state.
        text: its beginning, of up to what people paste.
    """

    name: str
    kept: dict[tuple[_Key, bool, bool], tuple[Stamp | None, Spoken]] = field(default_factory=dict)
    counts: dict[_Key, int] = field(default_factory=dict)
    lines: int = 0
    offset_ns: int | None = None
    epoch_ns: int | None = None
    passed: str = ""
    odd: list[tuple[Stamp | None, Unread]] = field(default_factory=list)
    odd_count: int = 0
    unstated: dict[str, None] = field(default_factory=dict)
    text: str = ""


def search(path: Path) -> Searched:
    """Search a file, or every file below a folder.

    Raises:
        LogError: no log can be read.
    """
    notes: list[str] = []
    left = limits().log_bytes
    read: list[_File] = []
    for number, place in enumerate(_files(path, notes), start=1):
        stage(f"reading {place.name}, {number}")
        found, used = _read(path, place, left, notes)
        left -= used
        read += [] if found is None else [found]
    if not read:
        raise LogError(f"{path.as_posix()}: holds no log that can be read; {'; '.join(notes) or 'it is empty'}")
    return _joined(read, notes)


def _files(path: Path, notes: list[str]) -> Iterator[Path]:
    """Yield the files in the order of their names; links inside a folder, such as `latest`, are not followed."""
    if not path.exists():
        raise LogError(f"{path.as_posix()}: no such file or folder; name a log, or a folder such as `~/.ros/log`")
    if not path.is_dir():
        yield path
        return
    count = 0
    for folder, folders, names in os.walk(path):
        folders.sort()
        for name in sorted(names):
            place = Path(folder, name)
            if place.is_symlink():
                continue
            count += 1
            if count > _MOST_FILES:
                notes.append(f"{path.as_posix()}: has more than {_MOST_FILES} files; the others are not read")
                return
            yield place


def _read(root: Path, place: Path, most: int, notes: list[str]) -> tuple[_File | None, int]:
    """Return what one file says, and how many bytes of it were read."""
    name = place.relative_to(root).as_posix() if root.is_dir() else place.as_posix()
    if most <= 0:
        notes.append(f"{name}: is not read: {option('log-bytes')}")
        return None, 0
    try:
        with open_regular(place) as stream:
            size = os.fstat(stream.fileno()).st_size
            if b"\0" in stream.read(_HEAD):
                notes.append(f"{name}: is binary, and not read")
                return None, 0
            stream.seek(0)
            found = _File(name)
            used = _search(found, stream, most)
    except OSError as problem:
        notes.append(f"{name}: cannot be read: {reason_of(problem)}")
        return None, 0
    if used < size:
        notes.append(f"{name}: only the first {used} of its {size} bytes are read; {option('log-bytes')}")
    return found, used


def _search(found: _File, stream: BinaryIO, most: int) -> int:
    """Search the lines of a stream; return how many bytes were read."""
    used, before = 0, None
    while used < most:
        line = stream.readline(min(_LONGEST, most - used))
        if not line:
            break
        used += len(line)
        rest = line
        while not rest.endswith(b"\n") and used < most and (rest := stream.readline(min(_LONGEST, most - used))):
            used += len(rest)
        found.lines += 1
        if len(found.text) <= _MOST_SHORT:
            found.text += line.decode("utf-8", "replace")
        before = _take(found, line.decode("utf-8", "replace"), before)
    return used


def _take(found: _File, line: str, before: Stamp | None) -> Stamp | None:
    """Take a line; return its time, which is that of the line before where it states none."""
    if found.lines > _READ_WHOLE and is_minor(line):
        found.passed = line
        return before
    if found.passed:
        before, found.passed = entry_of(found.passed).stamp or before, ""
    entry = entry_of(line)
    stamp = entry.stamp or before
    if stamp is not None and stamp.zoned:
        found.epoch_ns = stamp.ns if found.epoch_ns is None else found.epoch_ns
        if stamp.local_ns is not None and found.offset_ns is None:
            found.offset_ns = _zone_ns(stamp)
    if entry.gravity is Gravity.MINOR:
        return stamp
    matches = logged(entry.text)[:1]
    if not matches and entry.gravity is Gravity.ERROR:
        _take_odd(found, entry.text, stamp)
    for match in matches:
        is_warning = entry.gravity is Gravity.WARNING
        spoken = Spoken(None, found.name, found.lines, entry.gravity, _shown(entry.text), match)
        key = (match.symptom.name, spoken.layer, is_warning)
        found.counts[key] = found.counts.get(key, 0) + 1
        slot = (key, stamp is not None, stamp is not None and stamp.zoned)
        old = found.kept.get(slot)
        if old is None or (stamp is not None and old[0] is not None and stamp.ns < old[0].ns):
            found.kept[slot] = (stamp, spoken)
    return stamp


def _take_odd(found: _File, text: str, stamp: Stamp | None) -> None:
    """Count an error that no symptom has, and keep the first of them."""
    found.odd_count += 1
    if len(found.odd) < _MOST_ODD:
        found.odd.append((stamp, Unread(None, found.name, found.lines, _shown(text))))


def _shown(text: str) -> str:
    return " ".join(text.split())[:_HEAD]


def _zone_ns(stamp: Stamp) -> int:
    """Return how far local time is ahead of UTC, by a line that has both; the year of the local time may be open."""
    bare = Stamp(stamp.local_ns or 0, zoned=False, dated=False)
    ahead_ns = in_year_of(bare, stamp.ns) - stamp.ns
    return round(ahead_ns / _QUARTER_NS) * _QUARTER_NS


def _joined(files: list[_File], notes: list[str]) -> Searched:
    """Return the lines of all files in the order of time, each symptom once."""
    epochs = [each.epoch_ns for each in files if each.epoch_ns is not None]
    first: dict[_Key, Spoken] = {}
    counts: dict[_Key, int] = {}
    for file in files:
        for key, number in file.counts.items():
            counts[key] = counts.get(key, 0) + number
        for (key, _, _), (stamp, spoken) in file.kept.items():
            timed = replace(spoken, at_ns=_utc_ns(file, stamp, epochs))
            if key not in first or _order(timed) < _order(first[key]):
                first[key] = timed
    ordered = sorted((replace(each, count=counts[key]) for key, each in first.items()), key=_order)
    odd = _first_odd(files, epochs)
    unread = replace(odd[0], count=sum(file.odd_count for file in files)) if odd else None
    uncertain = [
        f"{file.name}: its times state no {' and no '.join(file.unstated)}: its order among other files may be wrong"
        for file in files
        if file.unstated
    ]
    timeless = [f"{each.file}: line {each.line} has no time" for each in ordered if each.at_ns is None]
    lines = sum(file.lines for file in files)
    short = "\n".join(file.text for file in files)
    short = short.strip() if len(short) <= _MOST_SHORT else ""
    return Searched(tuple(ordered), len(files), lines, (*notes, *uncertain, *timeless), unread, odd, short)


def _first_odd(files: list[_File], epochs: list[int]) -> tuple[Unread, ...]:
    timed = [replace(odd, at_ns=_utc_ns(file, stamp, epochs)) for file in files for stamp, odd in file.odd]
    return tuple(sorted(timed, key=_order)[:_MOST_ODD])


def _utc_ns(file: _File, stamp: Stamp | None, epochs: list[int]) -> int | None:
    """Return the time in UTC of a line, whose year and zone other lines may tell."""
    if stamp is None:
        return None
    ns = stamp.ns
    near_ns = file.epoch_ns if file.epoch_ns is not None else min(epochs, default=None)
    if not stamp.dated and near_ns is not None:
        ns = in_year_of(stamp, near_ns)
    elif not stamp.dated:
        file.unstated["year"] = None
    if not stamp.zoned and file.offset_ns is None:
        file.unstated["zone (UTC is taken)"] = None
    elif not stamp.zoned:
        ns -= file.offset_ns or 0
    return ns


def _order(spoken: Spoken | Unread) -> tuple[bool, int, str, int]:
    return spoken.at_ns is None, spoken.at_ns or 0, spoken.file, spoken.line
