"""The canonical form, written by hand beside what it comes from."""

from __future__ import annotations

import pytest

from cellc.tools.layout import layout
from cellc.tools.layout.layout import formatted

FORMS = {
    "two spaces a level, and lists below their key": (
        "cell: x\ndevices:\n      arm:\n          model: y\n"
        "safety:\n    stop:\n        evidence:\n        - a\n        - b\n",
        "cell: x\ndevices:\n  arm:\n    model: y\nsafety:\n  stop:\n    evidence:\n      - a\n      - b\n",
    ),
    "one space behind a colon and a comma, none within braces": (
        "cell:   x\nnetwork: { domain_id:   42 ,discovery: localhost}\n",
        "cell: x\nnetwork: {domain_id: 42, discovery: localhost}\n",
    ),
    "keys in the order of the reference, with the comments above and beside them": (
        "# of the file\ndevices:   # of the devices\n  arm:\n    # of the mount\n"
        "    mount: {xyz: 0 0 0.80 m, parent: world}\n    model: y\n\n# of the name\ncell: x\n",
        "# of the file\n# of the name\ncell: x\n\ndevices:   # of the devices\n  arm:\n"
        "    model: y\n    # of the mount\n    mount: {parent: world, xyz: 0 0 0.80 m}\n",
    ),
    "names in the order of their author": (
        "hosts: {b: {scheduling: generic}, a: {scheduling: generic}}\n",
        "hosts: {b: {scheduling: generic}, a: {scheduling: generic}}\n",
    ),
    "a key that nobody knows comes last": (
        "frames: {a: {colour: red, xyz: 0 0 0 m, parent: world}}\n",
        "frames: {a: {parent: world, xyz: 0 0 0 m, colour: red}}\n",
    ),
    "the kind of a fault before its moment": (
        "rehearsals: {a: {inject: {at: 2s, by: 1.5deg, jog: arm/wrist}, use: b}}\n",
        "rehearsals: {a: {use: b, inject: {jog: arm/wrist, by: 1.5 deg, at: 2 s}}}\n",
    ),
    "one space between numbers and before the unit, each number as it was written": (
        "frames:\n  a: {parent: world, xyz: 0  0 .50m, rpy: 0 0 9.0e1deg}\n  b: {parent: world, xyz: '0 0 5m'}\n",
        "frames:\n  a: {parent: world, xyz: 0 0 .50 m, rpy: 0 0 9.0e1 deg}\n  b: {parent: world, xyz: '0 0 5m'}\n",
    ),
    "commas between numbers go": (
        "frames:\n  a:\n    xyz: 0, 0,5 mm\n    rpy: 0 0 90 deg\n",
        "frames:\n  a:\n    xyz: 0 0 5 mm\n    rpy: 0 0 90 deg\n",
    ),
    "a text that is no quantity stays, whatever it looks like": (
        "summary: 5m  away, 7mm\ndevices: {a: {model: b, serial: 5m}}\n",
        "summary: 5m  away, 7mm\ndevices: {a: {model: b, serial: 5m}}\n",
    ),
    "a comment stays in its column where it can": (
        "cell: x        # far\nsummary: a b# c   # near\n",
        "cell: x        # far\nsummary: a b# c   # near\n",
    ),
    "a comment stands two spaces behind a longer value": (
        "frames:\n  a: {parent: world,xyz: 0 0 5mm} # c\n",
        "frames:\n  a: {parent: world, xyz: 0 0 5 mm}  # c\n",
    ),
    "one empty line at most, and none at the ends": (
        "\n\ncell: x\n\n\n\nsummary: y\n\n\n",
        "cell: x\n\nsummary: y\n",
    ),
    "braces that are too long are filled, aligned behind the brace": (
        f"kpis: {{cancel: 200 ms, missed_cycles: 0, {', '.join(f'name_of_figure_{n}: {n}' for n in range(5))}}}\n",
        "kpis: {cancel: 200 ms, missed_cycles: 0, name_of_figure_0: 0, name_of_figure_1: 1, name_of_figure_2: 2,\n"
        "       name_of_figure_3: 3, name_of_figure_4: 4}\n",
    ),
    "lines of an author within braces stay where the whole is too long for one": (
        f"owners:\n  responsibilities: {{frames: {'a' * 40}, time: {'b' * 40},\n    limits: c, command: d}}\n",
        f"owners:\n  responsibilities: {{frames: {'a' * 40}, time: {'b' * 40},\n"
        "                     limits: c, command: d}\n",
    ),
    "lines within braces become one where it fits": (
        "network: {domain_id: 42,\n    discovery: localhost}\n",
        "network: {domain_id: 42, discovery: localhost}\n",
    ),
    "a comment within braces keeps its line": (
        "network: {domain_id: 42,  # of the site\n  # of ours\n  discovery: localhost}\n",
        "network: {domain_id: 42,  # of the site\n          # of ours\n          discovery: localhost}\n",
    ),
    "what is said of a key stays beside it": (
        "rehearsals:\n  a:   # why\n      {use: b}\n",
        "rehearsals:\n  a:   # why\n    {use: b}\n",
    ),
    "pairs in brackets need no braces": (
        "rehearsals: {a: {steps: [ move: home,move: pick ]}}\n",
        "rehearsals: {a: {steps: [move: home, move: pick]}}\n",
    ),
    "the text of a block stays, with its own indentation": (
        "summary: |2-   # why\n     a\n   # b\n\nversions: {ros: jazzy}\n",
        "summary: |2-   # why\n     a\n   # b\n\nversions: {ros: jazzy}\n",
    ),
    "a block moves with its key": (
        "devices:\n    arm:\n        serial: >-\n            a\n              b\n",
        "devices:\n  arm:\n    serial: >-\n        a\n          b\n",
    ),
    "a text of several lines is indented below its key": (
        "summary: a\n b\n\n  c\ncell: 'd\n      e'\n",
        "cell: 'd\n  e'\nsummary: a\n  b\n\n  c\n",
    ),
    "an anchor stays before what takes it": (
        "frames:\n  a: &a\n    rpy: &r 0 0 0 deg\n    parent: world\n  b: {rpy: *r, parent: world}\n",
        "frames:\n  a: &a\n    parent: world\n    rpy: &r 0 0 0 deg\n  b: {parent: world, rpy: *r}\n",
    ),
    "keys stay in order where one takes what another gives": (
        "frames:\n  a: {rpy: &r 0 0 0 deg,  parent: *r}\n",
        "frames:\n  a: {rpy: &r 0 0 0 deg, parent: *r}\n",
    ),
    "the file of a device has the order of its schema, and the author's names stay": (
        "# head\n\n"
        "limits: {payload: {source: s, value: 5kg},  velocity_everywhere: {b: {source: s, value: 2rad/s}, a: {}}}\n"
        "# whose\nvendor:  nobody\nmodel: arm\nown: x\nkind: arm\nformat: 1   # of the file\n",
        "# head\n\nformat: 1   # of the file\nmodel: arm\n# whose\nvendor: nobody\nkind: arm\n"
        "limits: {velocity_everywhere: {b: {value: 2 rad/s, source: s}, a: {}}, payload: {value: 5 kg, source: s}}\n"
        "own: x\n",
    ),
    "a comment at the end of a section stays in it": (
        "frames:\n    a: {parent: world}\n    # no more\n# of hosts\nhosts: {}\n",
        "# of hosts\nhosts: {}\nframes:\n  a: {parent: world}\n  # no more\n",
    ),
    "the mark of a document stays": ("# a\n---\n# b\ncell:  x\n", "# a\n---\n# b\ncell: x\n"),
    "a value that is missing stays missing": ("network: {domain_id:  }\ncell:\n", "cell:\nnetwork: {domain_id: }\n"),
    "a mapping that a dash begins": (
        "rehearsals:\n  a:\n    steps:\n    -   move: home\n        within: 2s\n    # c\n    - # d\n      grip: open\n",
        "rehearsals:\n  a:\n    steps:\n      - move: home\n"
        "        within: 2s\n      # c\n      - # d\n        grip: open\n",
    ),
}


@pytest.mark.parametrize("form", FORMS)
def test_form(form: str) -> None:
    text, expected = FORMS[form]
    assert formatted("cell.yaml", text).value == expected
    assert formatted("cell.yaml", expected).value == expected


@pytest.mark.parametrize(
    "text", ["? cell\n: x\n", "%YAML 1.2\n---\ncell:   x\n", "cell:   x\n...\n", "a: &a x\n*a :   y\n"]
)
def test_form_that_nobody_writes_by_hand_stays(text: str) -> None:
    assert formatted("cell.yaml", text).value == text


@pytest.mark.parametrize("spoilt", ["cell: y # c\n", "cell: x\n", "cell: [x # c\n"])
def test_text_that_would_be_spoilt_stays(spoilt: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layout, "write_written", lambda written: spoilt)
    assert formatted("cell.yaml", "cell:   x # c\n").value == "cell:   x # c\n"


@pytest.mark.parametrize("text", ["a: {b: 1\n", "a: 1\na: 2\n", "a: !!str 1\n", "\tcell: x\n", "a: 1\n---\nb: 2\n"])
def test_file_that_cellc_does_not_read_is_refused_with_its_place(text: str) -> None:
    made = formatted("cell.yaml", text)
    assert made.value is None
    assert made.diagnostics[0].span.file == "cell.yaml"
