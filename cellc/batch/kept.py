"""Answers of earlier calls, which hold while the program and every file that they were computed from are the same."""

from __future__ import annotations

import hashlib
import json
import os
import sys
from pathlib import Path

from cellc.batch.answer import Answer, answer_of, plain_of
from cellc.batch.compute import Kind
from cellc.cache.program import PACKAGE
from cellc.cache.store import read_entry, write_entry
from cellc.disk import Record
from cellc.disk.again import still_says


def recall_answer(kind: Kind, file: str, program: str) -> Answer | None:
    """Return the kept answer for a spec where it still holds.

    Args:
        file: the spec as the user named it.
        program: mark of the program, from before its code was loaded.
    """
    name = _entry(kind, file)
    content = None if name is None else read_entry(name)
    if content is None:
        return None
    try:
        entry = json.loads(content)
        if entry["program"] != program or not still_says(Record.from_plain(entry["asked"]).marks):
            return None
        return answer_of(entry["answer"])
    except (KeyError, TypeError, ValueError, RecursionError):
        return None  # not what this program writes


def keep_answer(kind: Kind, file: str, program: str, answer: Answer, asked: Record) -> None:
    """Keep an answer in the place of the former one for the same spec."""
    name = _entry(kind, file)
    if name is not None and asked.holds:
        entry = {"program": program, "asked": asked.to_plain(), "answer": plain_of(answer)}
        write_entry(name, json.dumps(entry, separators=(",", ":")).encode())


def _entry(kind: Kind, file: str) -> str | None:
    """Name the entry after the installation, the interpreter, the current folder and the spec."""
    try:
        folder = Path.cwd()
    except OSError:  # it was removed
        return None
    question = "\0".join((str(PACKAGE), sys.implementation.cache_tag or "", str(folder), file))
    return f"{kind}/{hashlib.sha256(os.fsencode(question)).hexdigest()}.json"
