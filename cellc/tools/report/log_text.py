"""What logs say, as lines for people: the layer that spoke first, then what was said, in the order of time."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime, timedelta, timezone
from typing import TYPE_CHECKING

from cellc.contract.attempt import Layer
from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Style, Styled
from cellc.tools.diagnose.log_entry import Gravity

if TYPE_CHECKING:
    from cellc.tools.diagnose.logs import Searched, Spoken, Unread

_STYLES = {Gravity.ERROR: Style.RED, Gravity.UNSAID: Style.RED, Gravity.WARNING: Style.YELLOW}
_WORDS = {Gravity.ERROR: "error", Gravity.UNSAID: "says", Gravity.WARNING: "warning"}
_MOST_NOTES = 50


def render_searched(searched: Searched, *, is_certain: bool) -> Iterator[Line]:
    """Yield which layer spoke first, and every symptom with its first line.

    Args:
        is_certain: the text of that line is of no other layer.
    """
    first = searched.first
    if first is None:
        yield f"no known symptom in {_size(searched)}"
    else:
        yield (
            "first layer: " if is_certain else "first layer, not sure: ",
            Styled(_layer(first), Style.BOLD),
            f", {first.match.symptom.name}",
        )
        yield f"  {_time(first)}  {first.file}:{first.line}"
        yield f"  {first.text}"
        yield ""
        yield f"in the order of time, of {_size(searched)}:"
    for each in searched.spoken:
        more = f", {count(each.count, 'line')}" if each.count > 1 else ""
        yield (
            f"  {_time(each)}  ",
            Styled(_WORDS[each.gravity], _STYLES[each.gravity]),
            f"  {_layer(each)}: {each.match.symptom.name}, {each.file}:{each.line}{more}",
        )
    if searched.unread is not None:
        yield from _unread(searched.unread)
    yield from (f"note: {note}" for note in searched.notes[:_MOST_NOTES])
    if len(searched.notes) > _MOST_NOTES:
        yield f"note: {len(searched.notes) - _MOST_NOTES} more notes"


def _unread(unread: Unread) -> Iterator[Line]:
    yield f"{count(unread.count, 'error')} that no symptom has; the first:"
    yield f"  {_time(unread)}  {unread.file}:{unread.line}"
    yield f"  {unread.text}"


def _size(searched: Searched) -> str:
    return f"{count(searched.lines, 'line')} of {count(searched.files, 'file')}"


def _layer(spoken: Spoken) -> str:
    return spoken.match.layer.title if spoken.layer in (None, Layer.UNKNOWN) else str(spoken.layer)


def _time(spoken: Spoken | Unread) -> str:
    if spoken.at_ns is None:
        return "no time"
    at = datetime(1970, 1, 1, tzinfo=timezone.utc) + timedelta(microseconds=spoken.at_ns // 1000)
    return f"{at:%Y-%m-%d %H:%M:%S}.{spoken.at_ns // 1_000_000 % 1000:03d} UTC"
