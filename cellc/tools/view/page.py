"""The whole page as HTML: elements for people, one script for the drawing, and a policy that lets nothing else in."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from importlib.resources import files
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from xml.etree.ElementTree import Element

from cellc.contract.diagnostics.diagnostic import counted
from cellc.contract.store.regular_file import own_bytes, own_text
from cellc.mock.report_page.html import Child, pairs, section, tag, to_page
from cellc.tools.view.attempt_section import attempt_facts, attempt_section
from cellc.tools.view.content import Content
from cellc.tools.view.playback import Run
from cellc.tools.view.sections import (
    absent_section,
    changes_section,
    findings_section,
    gates_section,
    interfaces_section,
    rehearsals_section,
)

_SCRIPTS = ("orbit.js", "scene.js", "page.js")
_LAYERS = (
    ("frames", "frames of the cell", True),
    ("links", "frames of links", False),
    ("names", "names", True),
    ("goals", "goals", True),
    ("cones", "fields of view", False),
    ("before", "its pose before", True),
    ("ghost", "the ghost beside it", True),
)
_LOOKS = ("around", "front", "side", "above")
_CAPTIONS = {
    "graph/cell.svg": ("sides", "From two sides", "The cell from two sides"),
    "graph/nodes.svg": ("graph", "Who talks to whom", "The graph of nodes, controllers and devices"),
    "graph/responsibility.svg": ("arrows", "What each arrow promises", "Every arrow of the cell with its owner"),
}


_WHOLE = re.compile(r'(?<=viewBox=")[^"]*')
_VIEWS = re.compile(r'<view id="page_\d+" viewBox="([\d. ]+)"')
_MOST_SHEETS = 100
"""Each holds the whole picture once more."""


def to_html(content: Content, library: str | None) -> str:
    """Return the page; the same content gives the same bytes.

    Args:
        library: text of three.js; without it the page has pictures and words alone.
    """
    style = "".join(_asset(package, name) for package, name in _STYLES)
    scripts = () if content.scene is None or library is None else (library, _script())
    main = tag("main", *_parts(content, drawn=bool(scripts)))
    data = tag("script", id="cell-data", type="application/json")
    data.text = _json(content)
    body = tag("body", main, *([data] if scripts else []))
    for text in scripts:
        body.append(_with_text("script", text))
    shown = "the cell" if content.attempt is None else "an attempt, played back"
    return to_page(f"{content.subject.name}: {shown}", style, body, policy=_policy(style, scripts))


_ARCHIVE, _TEMPLATE = "resources/templates/viewer.zip", "viewer.html.template"
_LARGEST = 4 * 1024 * 1024
# From the license to the end of the module; behind it the template has controls and loaders of its own.
_MODULE = re.compile(r"<script>(/\*\*\n \* @license\n[^/]*Three\.js Authors.*?\}\)\);)\n", re.DOTALL)


def three_js() -> str | None:
    """Return the text of three.js; None where no package ships it in the form that is known here.

    trimesh, which yourdfpy needs, has a page of its own with three.js in it (release 140, MIT) for its
    `scene_to_html`: https://github.com/mikedh/trimesh/tree/5.2.0/trimesh/resources/templates. The library alone is
    taken from there, with its license at the head, and trimesh is not imported, which would load numerics for a text.
    """
    spec = find_spec("trimesh")
    for folder in (spec.submodule_search_locations or ()) if spec is not None else ():
        try:
            content = BytesIO(own_bytes(Path(folder) / _ARCHIVE))
            with zipfile.ZipFile(content) as archive, archive.open(_TEMPLATE) as template:
                text = template.read(_LARGEST).decode("utf-8")
        except (OSError, KeyError, ValueError, zipfile.BadZipFile):
            continue
        module = _MODULE.search(text)
        if module is not None and "</script" not in module[1]:
            return module[1]
    return None


_STYLES = (("cellc.mock.report_page", "style.css"), ("cellc.tools.view.assets", "page.css"))


def _asset(package: str, name: str) -> str:
    return own_text(Path(str(files(package) / name)))


def _script() -> str:
    return '"use strict";\n' + "".join(_asset("cellc.tools.view.assets", name) for name in _SCRIPTS)


def _with_text(name: str, text: str) -> Element:
    element = Element(name)
    element.text = text
    return element


def _json(content: Content) -> str:
    """Return what the script reads; no text of the cell ends the element that holds it."""
    scene, before = content.scene, None if content.before is None else content.before.scene
    if scene is not None and before is not None and before.meshes == scene.meshes:
        before = replace(before, meshes=())  # those of the scene are taken
    data = {
        "scene": None if scene is None else asdict(scene),
        "before": None if before is None else asdict(before),
        "runs": [asdict(run) for run in content.runs],
    }
    return json.dumps(data, ensure_ascii=True, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _policy(style: str, scripts: Sequence[str]) -> str:
    """Return what the browser may load and run: what is in this page, and nothing from anywhere."""
    allowed = " ".join(map(_hash, scripts)) or "'none'"
    sources = f"img-src data:; style-src {_hash(style)}; script-src {allowed}"
    return f"default-src 'none'; {sources}; base-uri 'none'; form-action 'none'"


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _parts(content: Content, *, drawn: bool) -> Iterator[Element]:
    subject, folder = content.subject, content.subject.folder
    yield _header(content)
    if content.scene is not None and drawn:
        yield _stage(content)
    if content.attempt is not None:
        yield attempt_section(content.attempt)
    if content.not_drawn:
        yield absent_section(content.not_drawn)
    if content.before is not None:
        yield changes_section(content.before.review)
    rehearsals = _rehearsals(content)
    if rehearsals:
        yield rehearsals_section(rehearsals, len(content.runs) - len(rehearsals))
    if subject.findings is not None:
        yield findings_section(subject.findings)
    if folder is not None:
        yield interfaces_section(folder.contract)
        yield from _pictures(subject.pictures)
        yield gates_section(folder.contract)


def _rehearsals(content: Content) -> tuple[Run, ...]:
    """Return the runs that the mock made: the last ones."""
    return content.runs if content.attempt is None else content.runs[len(content.runs) - content.attempt.rehearsals :]


def _header(content: Content) -> Element:
    subject, folder = content.subject, content.subject.folder
    contract = None if folder is None else folder.contract
    facts: list[tuple[str, Child]] = (
        [] if contract is None else [("configuration", contract.configuration_id), ("ROS 2", contract.distro.value)]
    )
    facts += [] if subject.findings is None else [("findings", counted(subject.findings.diagnostics))]
    facts += [] if content.attempt is None else list(attempt_facts(content.attempt))
    notes = [*(() if folder is None else folder.notes), *_drawn_less(content)]
    return tag(
        "header",
        tag("p", "Robot cell" if content.attempt is None else "Attempt, played back from a bag", class_="kicker"),
        tag("h1", subject.name),
        *([] if contract is None else [tag("p", contract.summary, class_="summary")]),
        pairs(facts, "facts"),
        *(tag("p", tag("b", "Note: "), note, class_="note") for note in notes),
        tag("nav", *(tag("a", words, href=f"#{id_}") for id_, words in _places(content))),
    )


def _drawn_less(content: Content) -> Iterator[str]:
    findings = content.subject.findings
    if content.subject.folder is not None or findings is None:
        return
    if findings.ok:
        yield "a robot alone: a cell that mounts it has rehearsals, interfaces and gates too"
    elif content.scene is None:
        yield "nothing is drawn: an error keeps the cell from being linked"
    else:
        yield "errors keep the package from being made; what can be linked without them is drawn, and nothing is run"


def _places(content: Content) -> Iterator[tuple[str, str]]:
    if content.attempt is not None:
        yield "attempt", "Attempt"
    if content.not_drawn:
        yield "absent", "Not drawn"
    if content.before is not None:
        yield "changes", "Changes"
    if _rehearsals(content):
        yield "rehearsals", "Rehearsals"
    if content.subject.findings is not None:
        yield "findings", "Findings"
    if content.subject.folder is not None:
        yield from (("interfaces", "Interfaces"), ("graph", "Graph"), ("gates", "Gates"))


def _pictures(pictures: Mapping[str, str]) -> Iterator[Element]:
    for file, text in pictures.items():
        id_, title, words = _CAPTIONS[file]
        # As a picture, nothing in it runs, even in an untrusted file.
        sheets = [tag("img", src=_source(sheet), alt=words) for sheet in _sheets(text)]
        pushed = tag("div", *sheets, class_="wide", tabindex="0", role="group", aria_label=title)
        yield section(title, tag("figure", pushed), id_=id_)


def _source(picture: str) -> str:
    return f"data:image/svg+xml;base64,{base64.b64encode(picture.encode()).decode()}"


def _sheets(picture: str) -> list[str]:
    """Return a picture in the views that it names, between which paper may be cut; else whole."""
    views = _VIEWS.findall(picture)[:_MOST_SHEETS]
    return [_WHOLE.sub(view, picture, count=1) for view in views] or [picture]


def _stage(content: Content) -> Element:
    drawing = tag("div", tag("div", class_="labels"), tag("p", class_="picked"), class_="drawing")
    offered = _offered(content)
    looks = [tag("button", name, type="button", data_look=name) for name in _LOOKS]
    layers = [_layer(name, words, checked) for name, words, checked in _LAYERS if name in offered]
    controls = tag(
        "div",
        *_titled("Look", tag("div", *looks, class_="buttons")),
        *_titled("Pose", tag("div", class_="buttons poses")),
        *_titled("Show", tag("div", *layers, class_="layers")),
        *_titled("Devices", tag("div", class_="swatches legend")),
        class_="controls",
    )
    time = tag(
        "div",
        tag("div", class_="line"),
        *([tag("div", class_="line ghost")] if "ghost" in offered else []),
        tag("input", type="range", aria_label="time of the rehearsal"),
        tag("div", class_="marks"),
        class_="time",
    )
    choice = tag("select", aria_label="rehearsal")
    player = tag(
        "div", choice, tag("button", "Play", type="button"), time, tag("p", class_="status"), class_="player", hidden=""
    )
    return tag("div", drawing, controls, player, id="stage")


def _offered(content: Content) -> set[str]:
    scene = content.scene
    there = {
        "before": content.before is not None,
        "ghost": any(run.ghost is not None for run in content.runs),
        "goals": scene is not None and bool(scene.goals),
        "cones": scene is not None and bool(scene.cones),
    }
    return {"frames", "links", "names", *(name for name, is_there in there.items() if is_there)}


def _titled(title: str, content: Element) -> tuple[Element, Element]:
    content.attrib.update({"role": "group", "aria-label": title})
    return tag("p", title, class_="title"), content


def _layer(name: str, words: str, checked: bool) -> Element:
    box = tag("input", type="checkbox", data_layer=name)
    if checked:
        box.set("checked", "")
    parts: tuple[Child, ...] = (box, words)
    return tag("label", *parts, class_="layer")
