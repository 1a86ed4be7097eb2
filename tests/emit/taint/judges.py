"""What foreign readers of each format make of a generated file, as plain values that can be compared.

A hostile text is only text if every reader tells the same of a file with it and of the file with its harmless twin, but
for the text itself.
"""

from __future__ import annotations

import ast
import json
import os
import re
import shlex
from collections.abc import Callable, Iterator
from typing import Any
from unittest.mock import patch
from xml.etree import ElementTree

import xacro
import yaml
from markdown_it import MarkdownIt
from markdown_it.token import Token

from tests.consumers.launch_text import World, expand, unescaped
from tests.emit.taint.shell import commands_of

_FENCE = re.compile(r"^ *```sh\n(.*?)^ *```$", re.M | re.S)
_ENVIRONMENT = re.compile(r"\$\(env (\w+)\)")
_SHARE = re.compile(r"\$\(find (\w+)\)")
_COMMONMARK = MarkdownIt("commonmark").enable(["table", "strikethrough"])
_SPACE = re.compile(r"\s+")
_HASH = re.compile(r"\b(cfg-)?[0-9a-f]{12,64}\b")

# What launch splits into words as a shell does.
_SPLIT = ("args", "cmd", "launch-prefix", "ros_args")

Reading = Any
"""Nested lists, mappings and texts."""


def readings(path: str, text: str) -> dict[str, Reading]:
    """Return what each reader of a file says, by the reader; a format that has none is an error."""
    for end, readers in _READERS.items():
        if path.endswith(end):
            return {reader.__name__: reader(text) for reader in readers}
    raise AssertionError(f"nobody reads {path}")


def xml(text: str) -> Reading:
    """Return elements with attributes, texts and comments."""
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
    return list(_element(ElementTree.fromstring(text, parser)))


def _element(node: ElementTree.Element) -> Iterator[Reading]:
    yield node.tag if isinstance(node.tag, str) else "comment"
    yield dict(node.attrib)
    yield (node.text or "").strip() if len(node) else node.text or ""
    yield [list(_element(child)) for child in node]


def processed(text: str) -> Reading:
    """Return what the real xacro makes of a description, as the launch files have it made."""
    document = xacro.parse(_SHARE.sub(r"/share/\1", text))
    with patch.dict(os.environ, dict.fromkeys(_ENVIRONMENT.findall(text), "set as the cell is launched")):
        xacro.process_doc(document)
    return xml(document.toxml())


def launched(text: str) -> Reading:
    """Return a launch file as `ros2 launch` takes it: substitutions apart, everything else without its escapes."""
    root = ElementTree.fromstring(text)
    seen = World(_Variables(), lambda line: f"[what {line} says]")
    for node in root.iter():
        for name, value in node.attrib.items():
            told = node.tag == "choice" or (node.tag == "arg" and name in ("name", "description"))
            taken = unescaped(value) if told else expand(value, seen)
            node.attrib[name] = "\n".join(shlex.split(taken)) if name in _SPLIT else taken
    return list(_element(root))


class _Variables(dict[str, str]):
    """Every launch configuration, by its name."""

    def __contains__(self, key: object) -> bool:
        return True

    def __missing__(self, key: str) -> str:
        return f"[variable {key}]"


def pictured(text: str) -> Reading:
    """Return the kinds of elements of a picture, and its texts without spaces: it breaks lines where they are full."""
    root = ElementTree.fromstring(text)
    texts = [_SPACE.sub("", "".join(node.itertext())) for node in root.iter("{http://www.w3.org/2000/svg}text")]
    attributes = {name for node in root.iter() for name in node.attrib}
    return [sorted({str(node.tag) for node in root.iter()}), sorted(attributes), "".join(texts)]


def yaml_1_1(text: str) -> Reading:
    """Return the values of a YAML file, and its comments."""
    return [yaml.load(text, Loader=yaml.CSafeLoader), re.findall(r"^\s*#.*", text, re.M)]


def json_file(text: str) -> Reading:
    """Return the values of a JSON file."""
    return json.loads(text)


def json5(text: str) -> Reading:
    """Return the values of the JSON5 that is written here, which without its comments is YAML."""
    return [yaml.safe_load(re.sub(r"(?m)^\s*//.*$", "", text)), re.findall(r"^\s*//.*", text, re.M)]


def shell(text: str) -> Reading:
    """Return the words of every command that bash runs."""
    return commands_of(text)


def fences(text: str) -> Reading:
    """Return the words of every command that a page shows, once a shell has read them."""
    return commands_of("".join(_FENCE.findall(text)))


def commonmark(text: str) -> Reading:
    """Return headings, lists, tables and links of a page, and its texts."""
    return [one for token in _COMMONMARK.parse(text) for one in _token(token)]


def _token(token: Token) -> Iterator[Reading]:
    if token.type == "inline":
        yield list(_inline(token.children or []))
    elif token.type == "fence":
        yield [token.type, token.info]  # its content is read by a shell
    else:
        yield [token.type, token.tag, dict(token.attrs), token.content]


def _inline(tokens: list[Token]) -> Iterator[Reading]:
    text = ""
    for token in tokens:
        if token.type in ("text", "text_special", "softbreak"):
            text += token.content or " "
        elif token.type == "code_inline":
            # Whether a text of the user is set as code is a matter of looks: it says the same without backticks.
            text += token.content
        else:
            yield from [text.replace("`", "")] if text else []
            yield [token.type, token.tag, dict(token.attrs), token.content]
            text = ""
    yield from [_SPACE.sub(" ", text).replace("`", "")] if text else []


def github_pages(text: str) -> Reading:
    """Return what GitHub adds to Markdown and finds outside of code: formulas, struck words, mentions."""
    # A backtick behind an odd number of backslashes opens nothing.
    prose = re.sub(r"(?<![\\`])(?:\\\\)*(`+)(?!`).*?(?<!`)\1(?!`)", "", _FENCE.sub("", text))
    return re.findall(r"(?<!\\)\$|(?<!\\)~~", prose)


def python(text: str) -> Reading:
    """Return the program and its comments."""
    return [ast.dump(ast.parse(text)), re.findall(r"^\s*#.*", text, re.M)]


def plain(text: str) -> Reading:
    """Return the text itself, of a format in which nothing of a spec may stand but names."""
    return text


_READERS: dict[str, tuple[Callable[[str], Reading], ...]] = {
    ".urdf": (processed,),
    ".svg": (pictured,),
    ".launch.xml": (launched,),
    ".xml": (xml,),
    ".srdf": (xml,),
    ".yaml": (yaml_1_1,),
    ".repos": (yaml_1_1,),
    ".rviz": (yaml_1_1,),
    ".json": (json_file,),
    ".json5": (json5,),
    ".md": (commonmark, github_pages, fences),
    ".bash": (shell,),
    ".sh": (shell,),
    "CMakeLists.txt": (plain,),
    "scripts/bring_up": (python,),
    "scripts/claim_watch": (python,),
    "scripts/first_goal": (python,),
    "scripts/installed_versions.py": (python,),
    "scripts/observe": (python,),
    "scripts/observe_checks.py": (python,),
    "scripts/observe_host.py": (python,),
    "scripts/observe_listener.py": (python,),
    "scripts/observe_reports.py": (python,),
    "scripts/required": (python,),
}


def without_hashes(reading: Reading) -> Reading:
    """Return a reading without what follows from every byte: ids of the configuration and hashes of files."""
    if isinstance(reading, str):
        return _HASH.sub("HASH", reading)
    if isinstance(reading, dict):
        return {without_hashes(key): without_hashes(value) for key, value in reading.items()}
    return [without_hashes(one) for one in reading] if isinstance(reading, list) else reading
