"""Runs the examples of a rule's page: a fragment merged into a complete cell, or into a description of it.

A first line such as ``# a cell of two computers`` names a situation, ``situations/two_computers.yaml``, which is merged
before the fragment: the page shows only what the rule is about.

The reported example marks what is found: ``# expect at KEY`` on the line of the key, ``# expect: CODE at KEY`` where it
is another code than the page's, ``<!-- expect -->`` in a description. A mark on a line of its own, such as
``# expect at a.b.KEY``, names a place of the complete cell, which the example does not show.
"""

from __future__ import annotations

import re
import shutil
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from cellc.compiler.rules.kit import Rule
from cellc.contract.diagnostics import Diagnostic
from tests.cells import CORPUS, diagnose, there
from tests.foreign_yaml import LOADER, safe_load

BASE = CORPUS / "invalid" / "base"
"""The parts of a complete cell of made-up devices; nothing in it is to be reported."""
HEAD = {"format": "1", "cell": "demo"}
_DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
_SITUATIONS = Path(__file__).with_name("situations")
_SITUATION = re.compile(r"# a cell of (.+)")
_FENCE = re.compile(r"```(yaml|xml)\n(.*?)```", re.DOTALL)
_MARK = re.compile(r"(?:#|<!--) expect(?:: (?P<code>[a-z0-9-]+))?(?: at (?P<key>\S+))?")


@dataclass(frozen=True, slots=True)
class Example:
    """A fragment of a page; ``language`` is yaml for the spec and xml for a description."""

    language: str
    text: str


def examples(rule: Rule) -> tuple[Example, Example]:
    reported, accepted = (Example(language, text) for language, text in _FENCE.findall(rule.page.text))
    return reported, accepted


@dataclass(frozen=True, slots=True)
class Place:
    """What is found where: the line of the example, 0 outside of it; the path, which a description has none of."""

    code: str
    line: int
    path: str


def matches(place: Place, expected: Place) -> bool:
    """Tell whether a place is the one of a mark, which gives the end of the path."""
    end = f".{place.path}".endswith(f".{expected.path}")
    return (place.code, place.line) == (expected.code, expected.line) and end


def marks(rule: Rule, example: Example) -> list[Place]:
    places = []
    for number, line in enumerate(example.text.splitlines(), start=1):
        for mark in _MARK.finditer(line):
            own_line = line.lstrip().startswith(("#", "<!--"))
            places.append(Place(mark["code"] or rule.code, 0 if own_line else number, mark["key"] or ""))
    return places


def places(diagnosed: Iterable[Diagnostic], example: Example, folder: Path) -> list[Place]:
    """Return where findings stand in an example that was merged into the complete cell in ``folder``."""
    return [_place(diagnosis, example, folder) for diagnosis in diagnosed]


def _place(found: Diagnostic, example: Example, folder: Path) -> Place:
    file = Path(found.span.file)
    if file.suffix != ".yaml":
        before = file.read_text(encoding="utf-8").partition(example.text)[0].count("\n")
        return Place(found.code, found.span.line - before, "")
    merged = {line: path for path, line in _lines((folder / "cell.yaml").read_text(encoding="utf-8")).items()}
    path = merged[found.span.line]
    line = _lines(example.text).get(path, 0) if example.language == "yaml" else 0
    return Place(found.code, line, ".".join(path))


@cache
def _lines(text: str) -> dict[tuple[str, ...], int]:
    """Return the line of every key and list item of a YAML text, outer ones first."""
    found: dict[tuple[str, ...], int] = {}

    def walk(node: yaml.Node, path: tuple[str, ...]) -> None:
        children: list[tuple[str, yaml.Node, yaml.Node]] = []
        if isinstance(node, yaml.MappingNode):
            children = [(key.value, key, value) for key, value in node.value]
        elif isinstance(node, yaml.SequenceNode):
            children = [(str(index), item, item) for index, item in enumerate(node.value)]
        for name, start, value in children:
            inner = (*path, name)
            found[inner] = start.start_mark.line + 1
            walk(value, inner)

    root = there(yaml.compose(text, Loader=LOADER))
    walk(root, ())
    return found


@cache
def complete_cell() -> dict[str, Any]:
    """Return the complete cell as nested texts; never changed."""
    cell: dict[str, Any] = dict(HEAD)
    for part in sorted(BASE.glob("*.yaml")):
        sections = yaml.load(part.read_text(encoding="utf-8"), Loader=yaml.BaseLoader)
        sections.pop("include", None)
        cell = _merged(cell, sections)
    return cell


def diagnose_example(example: Example, folder: Path) -> tuple[Diagnostic, ...]:
    """Merge an example into the complete cell, written to ``folder``, and diagnose the result."""
    if example.language == "xml":
        fragment = {"devices": {"stage": {"model": "./stage", "revision": "A", "firmware": "stage 1.0.0"}}}
    else:
        fragment = yaml.load(example.text, Loader=yaml.BaseLoader)
    merged = _typed(_merged(_with_first_motions(_merged(complete_cell(), _situation(example)), fragment), fragment))
    text = yaml.dump(merged, Dumper=_DUMPER, sort_keys=False)
    # Copied is what the cell names and is not there from the example before, but for the one that examples change.
    for named in (path for path in BASE.iterdir() if path.is_dir() and path.name in text):
        if named.name == "stage" or not (folder / named.name).exists():
            shutil.copytree(named, folder / named.name, dirs_exist_ok=True)
    if example.language == "xml":
        _merge_description(example.text, folder / "stage" / "stage.urdf")
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    return diagnose(folder / "cell.yaml")


def _situation(example: Example) -> Any:
    """Return what the first line of an example says of its cell."""
    named = _SITUATION.match(example.text)
    if named is None:
        return {}
    text = (_SITUATIONS / f"{named[1].replace(' ', '_')}.yaml").read_text(encoding="utf-8")
    return yaml.load(text, Loader=yaml.BaseLoader)


def _with_first_motions(cell: Any, fragment: Any) -> Any:
    """State the first motion of every further device that the example lets take trajectories."""
    extended = _merged(cell, fragment)
    takers = {name for name, device in extended["devices"].items() if device.get("architecture") == "direct_sdk"}
    managers = (extended["control"], *extended.get("managers", {}).values())
    for controller in (controller for manager in managers for controller in manager.get("controllers", {}).values()):
        if str(controller.get("type", "")).endswith("trajectory"):
            takers.add(controller.get("device", "arm"))
    motions = [cell["bringup"]["first_motion"]]
    for name in sorted((takers - {"arm"}) & extended["devices"].keys()):
        description = "".join(path.read_text() for path in (BASE / extended["devices"][name]["model"]).glob("*.urdf"))
        if joint := re.search(r'joint name="(\w+)" type="revolute"', description):
            motions.append(motions[0] | {"joint": f"{name}/{joint[1]}"})
    return cell if len(motions) == 1 else _merged(cell, {"bringup": {"first_motion": motions}})


def _merged(base: Any, fragment: Any) -> Any:
    """Merge mappings key by key; ``null`` takes a key out, anything else replaces."""
    if not isinstance(base, dict) or not isinstance(fragment, dict):
        return fragment
    result = dict(base)
    for key, value in fragment.items():
        if value == "null":
            result.pop(key, None)
        else:
            result[key] = _merged(result.get(key, {} if isinstance(value, dict) else None), value)
    return result


def _typed(value: Any) -> Any:
    """Turn the texts of BaseLoader back into the scalars that they are."""
    if isinstance(value, dict):
        return {key: _typed(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_typed(item) for item in value]
    return safe_load(value) if re.fullmatch(r"-?\d+(\.\d+)?|true|false|\[\]", value) else value


def _merge_description(fragment: str, path: Path) -> None:
    """Replace the links and joints that the fragment names, and add those that are new, all on their lines."""
    robot = ElementTree.fromstring(path.read_text(encoding="utf-8"))
    named = {(element.tag, element.get("name")) for element in ElementTree.fromstring(f"<robot>{fragment}</robot>")}
    for element in list(robot):
        if (element.tag, element.get("name")) in named:
            robot.remove(element)
    text = ElementTree.tostring(robot, encoding="unicode")
    path.write_text(text.replace("</robot>", f"\n{fragment}</robot>"), encoding="utf-8")
