"""Words that nothing in this project says to people, with what to write instead, and the texts that are searched."""

from __future__ import annotations

import ast
import json
import re
import subprocess
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from tests.cells import ROOT

BANNED = {
    # English that no engineer of the field would write.
    r"told": "gets, is set to, receives; passive: reported",
    r"went": "removed",
    r"came": "added; from",
    r"stands|stood": "is, was; standstill for motion",
    r"nobody|no-one": "no owner, no client, no node, no person",
    r"strangers?": "untrusted",
    r"heed(?:s|ed|ing)?": "accept commands",
    r"calm(?:s|ed)?": "restore",
    r"deaf": "ignores commands",
    r"crews?": "executor",
    r"hires?|hired": "executor factory",
    r"purses?": "budget",
    r"ways": "modes, paths, methods",
    r"at once": "together; immediately; in one step",
    r"is due|are due": "is expected, must be",
    r"says? of it": "reports",
    r"what it is of": "its subject",
    r"is none|are none": "is not one; there is no",
    r"for one in": "for NOUN in",
    r"answers? for": "is responsible for",
    r"mend(?:s|ed|ing)?": "fix, repair, correct",
    r"begun|beginn?s again": "started; repeat from the start",
    r"anew": "again",
    r"whoever": "any node, any person",
    r"gives? back|gave back|given back": "return",
    r"in vain": "without an answer",
    r"is at hand|are at hand": "is available",
    r"comes up|come up|coming up": "starts",
    r"thereof|therein|therewith": "of it, in it, with it",
    r"it is written down|is found out": "Record, Find",
    r"without a word": "silently, without notice",
    r"half way": "halfway",
    r"other way round": "other way around, in the other direction",
    # British spelling.
    r"behaviours?": "behavior",
    r"(?:centi|milli|micro|kilo)?metres?": "meter",
    r"cancell(?:ed|ing)": "canceled, canceling",
    r"centres?|centred|centring": "center",
    r"colour(?:s|ed|ing)?": "color",
    r"neighbour(?:s|ing)?": "neighbor",
    r"programmes?": "program",
    r"licences?": "license",
    r"catalogues?": "catalog",
    r"greys?": "gray",
    r"honour(?:s|ed)?|favour(?:s|ed|ite)?": "honor, favor",
    r"(?:model|label|travel|signal|level|fuel)l(?:ed|ing)": "one l: modeled, labeled, traveled",
    r"(?:author|organ|recogn|real|initial|serial|normal|synchron)is(?:e[sd]?|ing|ation)": "-iz-",
    r"(?:optim|minim|maxim|general)is(?:e[sd]?|ing|ation)": "-iz-",
    r"analys(?:e|es|ed|ing)": "analyze",
    r"artefacts?": "artifact",
    r"misspelt|learnt|spelt": "misspelled, learned",
    r"judgements?": "judgment",
}
"""Pattern → what to write instead. Keys, codes and values that a user types stay: only texts are searched."""

_PATTERN = re.compile("|".join(rf"\b(?:{word})\b" for word in BANNED))
_CODE = re.compile(
    r"```.*?```|``[^`]+``|`[^`\n]*`|\[[^\]]*\]\([^)]*\)|<[^>\n]*>|^## [a-z-]+ \(", re.DOTALL | re.MULTILINE
)
_QUOTED = re.compile(r"\"[^\s\"]*\"|'[^\s']*'")
_YAML_KEY = re.compile(r"^[ -]*[\w./~-]+:(?: +[\w./~-]+$)?|[{,] *\w+:", re.MULTILINE)
_SEAM = re.compile(r"_|(?<=[a-z])(?=[A-Z])")
_COMMENT = re.compile(r"(?:^ *|  )# (.*)$", re.MULTILINE)
_QUOTES = re.compile(
    r"^ *(?:(?:logged|said|not|image): *\[|shows_else: *\{).*$"
    r"|current goal cancelled during deactivate transition|^cancelled due to$",
    re.MULTILINE | re.IGNORECASE,
)
"""What users and programs of others write, and keys and values of a spec: their spelling is not ours."""


def banned(text: str) -> list[str]:
    """Return the banned words of a text outside of code, each as often as it is there."""
    return _PATTERN.findall(_CODE.sub(" ", _QUOTES.sub(" ", text).replace("None", "null").lower()))


def suggestion(word: str) -> str:
    """Return what to write instead of a banned word."""
    return next(instead for one, instead in BANNED.items() if re.fullmatch(one, word))


def files() -> Iterator[Path]:
    """Yield the files of this repository that people read, tests apart."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in sorted(listed.stdout.split("\0")):
        apart = name.startswith(("tests/", "schemas/", ".", "CHANGELOG", "LICENSE")) or "/compiled/" in name
        if name and not apart and (ROOT / name).is_file():
            yield Path(name)


def printed(file: Path) -> list[str]:
    """Return the texts of a file that are printed for people: messages, prose, comments of what is generated."""
    text = _QUOTES.sub(" ", _read(file))
    if file.suffix == ".py":
        return _of_module(_read(file))[0]
    if text.startswith("#!/usr/bin/env python3"):
        return [each for texts in _of_module(text) for each in texts]
    if file.suffix in (".yaml", ".yml", ".repos"):
        return [_QUOTED.sub(" ", _YAML_KEY.sub(" ", text))]
    if file.suffix == ".json":
        return [*_strings(json.loads(text or "null"))]
    return [text if file.suffix == ".md" else _QUOTED.sub(" ", text)]


def inner(file: Path) -> list[str]:
    """Return docstrings, comments and public names of a module: what readers of the code read."""
    return _of_module(_read(file))[1] if file.suffix == ".py" else []


@cache
def _read(file: Path) -> str:
    try:
        return (ROOT / file).read_text()
    except UnicodeDecodeError:
        return ""


@cache
def _of_module(text: str) -> tuple[list[str], list[str]]:
    """Return the literals that are printed, and docstrings, comments and names of a module; none where all is well."""
    if not _PATTERN.search(_SEAM.sub(" ", text).lower()):
        return [], []
    literals, names, prose = {}, [], set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value.strip():
            literals[id(node)] = node.value
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            prose.add(id(node.value))
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            names.append(node.name)
        elif isinstance(node, ast.arg):
            names.append(node.arg)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.append(node.target.id)
    read = [" ".join(_SEAM.split(name)) for name in names]
    shown = [value for key, value in literals.items() if key not in prose]
    explained = [value for key, value in literals.items() if key in prose]
    return shown, [*explained, *read, *_COMMENT.findall(text), *re.findall(r"\bfor one in\b", text)]


def _strings(value: object) -> Iterator[str]:
    if isinstance(value, str):
        if " " in value:
            yield value
    elif isinstance(value, list):
        for each in value:
            yield from _strings(each)
    elif isinstance(value, dict):
        for each in value.values():
            yield from _strings(each)
