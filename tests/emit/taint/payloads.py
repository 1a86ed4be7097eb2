"""Texts that some reader of a generated file would take for more than text, and a harmless twin of each."""

from __future__ import annotations

import re

PAYLOADS = {
    "xacro": "${1+1}",
    "launch": "$(env HOME)",
    "eval": "$(eval '1' == '1')",
    "dollars": "$$ $$(env HOME) $$${1+1} $$x$$",
    "backticks": "`touch taint`",
    "substitution": "$(touch taint)",
    "shell": "'; touch taint; '",
    "double shell": '"; touch taint; "',
    "double quote": 'a " b',
    "single quote": "a ' b",
    "backslash": "a \\",
    "escaped bar": "a \\| b \\` c",
    "yaml": "a\ntaint: 1\n- taint\n---\n",
    "workflow": "a\n::error::taint",
    "script": "<script>alert(1)</script>",
    "cdata": "a ]]> b",
    "comment": "a --> b -- > c",
    "entity": "&x; &amp; &#35; #35; #quot;",
    "link": "]: http://taint.example [a](http://taint.example)",
    "bar": "a | b || c",
    "percent": "%0A::error::taint %% %%{init: {}}%%",
    "direction": "a \u202e b",
    "control": "a \u009b31m b",
    "braces": "{{ taint }} {% taint %} {taint} {device}",
    "tag": "!!python/object:os.system a",
    "task": "- [x] taint",
    "heading": "# taint",
    "emphasis": "**a** __b__ ~~c~~ $d$ :e: \\*f\\*",
    "zero": "a \0 b",
    "option": "--upload-pack=taint",
    "transport": "ext::sh -c taint",
    "comment mark": "a # b // c /* d */ ; e",
}
"""The payloads of one line and several, each by what would misread it."""

PLACEHOLDER = "{device}"
"""What a device's own files may say for its name in the cell: it is filled in both twins, or in neither."""

HIDDEN = ("direction", "control", "zero")
"""Those that hold a character which no reader lets in."""

EVALUATED = ("xacro", "launch", "eval", "dollars", "substitution")
"""Those that no reader lets in because other programs evaluate them."""

WAYS = ("first", "last", "glued")
"""The payload before a mark of its own, behind it, or glued to what stood there and the mark."""


def text_of(payload: str, number: int, way: str, original: str) -> str:
    """Return a hostile text with a mark of its own, so that it is known wherever it turns up.

    Args:
        way: the payload before the mark, behind it, or glued to what stood there.
    """
    mark = f"tq{number:04}q"
    if way == "first":
        return f"{payload} {mark}"
    return f"{mark} {payload}" if way == "last" else f"{original}{mark}{payload}"


def twin_of(text: str, original: str = "") -> str:
    """Return a harmless text of the same length and the same words.

    Args:
        original: what the text may be glued to; it is harmless already, and its placeholders are filled in both.
    """
    kept = original if text.startswith(original) else ""
    line = re.sub(r"\s", " ", text[len(kept) :])
    parts = line.split(PLACEHOLDER)
    return kept + PLACEHOLDER.join(re.sub(r"[^\w ./-]|-(?=[->])|(?<=-)-|^[#-]", "x", part) for part in parts)
