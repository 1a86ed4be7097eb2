"""Each mistake of shape gives one diagnostic: its code, at its place, with a help that names what would do."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.cells import there
from tests.spec.reading import ARM, CELLS, HEAD, parsed

FRAME = "frames: {a: {parent: world, "
TOPIC = "interfaces: {/a: {topic: sensor_msgs/msg/Image, from: arm, "
RUN = "rehearsals: {r: {steps: [{move: home}], "

# text after the head and the arm, code, marked text, part of the message, part of the help
CASES = [
    ("summry: x", "unknown-key", "summry", "`summry`", "did you mean `summary`?"),
    ("xyz: 0 0 0 m", "unknown-key", "xyz", "the spec has no key `xyz`", "use one of the keys that are allowed"),
    ("hosts: {pc: {domain: ros}}", "unknown-key", "domain", "`hosts.pc`", "move it under `clock`"),
    ("safety: {stop: {recovery: {}}}", "unknown-key", "recovery", "`safety.stop`", "move it out of `safety.stop` into"),
    ("targets: {mok: {}}", "unknown-key", "mok", "`targets` has no key `mok`", "did you mean `mock`?"),
    (TOPIC + "service: a/srv/B}}", "unknown-key", "service", "`interfaces./a`", "allowed"),
    (TOPIC + "to: {b: {depht: 1}}}}", "unknown-key", "depht", "`interfaces./a.to.b`", "did you mean `depth`?"),
    ("hosts: {pc: {nics: {a: {}}}}", "missing-key", "a", "`hosts.pc.nics.a` has no `address`", "192.168.56.10/24"),
    (RUN + "inject: {freeze: arm}}}", "missing-key", "inject", "has no `at`", "such as `2 s`"),
    (RUN + "inject: [{freeze: arm}]}}", "missing-key", "{freeze: arm}", "inject[0]` has no `at`", "such as `2 s`"),
    (FRAME + "xyz: 0 0 162}}", "missing-unit", "0 0 162", "its unit, got `0 0 162`", "`mm`, `cm`, `m` or `um`"),
    (
        TOPIC + "rate: 30}}",
        "missing-unit",
        "30",
        "its unit, got `30`",
        "`Hz`, `kHz` or `MHz`, such as `500 Hz`",
    ),
    (FRAME + "rpy: 0 0 90 mm}}", "wrong-unit", "0 0 90 mm", "`mm` is not a unit of an angle", "`deg` or `rad`"),
    (FRAME + "xyz: somewhere}}", "not-a-quantity", "somewhere", "`somewhere`", "such as `0 0 162 mm`"),
    (
        FRAME + "xyz: [0, 0, 1]}}",
        "not-a-quantity",
        "xyz",
        "expected a length for",
        "such as `0 0 162 mm`",
    ),
    (FRAME + "xyz: 0 0 m}}", "wrong-count", "0 0 m", "must have 3 numbers, got 2", "write 3 numbers"),
    ("hosts: []", "wrong-type", "hosts", "expected a mapping for `hosts`, got a list", "write a mapping"),
    ("frames: {a: 5}", "wrong-type", "5", "expected a mapping for `frames.a`, got the number `5`", "write a mapping"),
    ("summary: 4.10", "wrong-type", "4.10", "expected text for `summary`, got the number `4.10`", '`"4.10"`'),
    (FRAME + "dynamic: yes}}", "wrong-type", "yes", "expected `true` or `false`", "such as `true`"),
    (FRAME + "reference_points: 2.5}}", "wrong-type", "2.5", "expected a whole number", "such as `3`"),
    (TOPIC + "to: 5}}", "wrong-type", "5", "expected a name, a list of names, or a mapping", "write a name"),
    (TOPIC + "to: [b, 5]}}", "wrong-type", "5", "`interfaces./a.to[1]`, got the number `5`", '`"5"`'),
    ("interfaces: {/a: text}", "wrong-type", "text", "expected a mapping", "write a mapping"),
    (RUN + "inject: 7}}", "wrong-type", "7", "expected a fault or a list of faults", "write a fault"),
    ("bringup: {gates: 7}", "wrong-type", "7", "expected `standard` or a list of names", "write `standard`"),
    (TOPIC + "wants: newst}}", "not-a-choice", "newst", "must be one of its choices", "did you mean `newest`?"),
    (
        "bringup: {gates: standart}",
        "not-a-choice",
        "standart",
        "must be one of its choices",
        "did you mean `standard`?",
    ),
    ("nodes: {a-b: {run: x/y}}", "bad-name", "a-b", "`a-b` cannot be used in `nodes`", "such as `a_b`"),
    ("frames: {a: {parent: tool 0}}", "bad-name", "tool 0", "`tool 0` cannot be used", "such as `tool_0`"),
    (TOPIC + "to: [9b]}}", "bad-name", "9b", "`9b` cannot be used as `interfaces./a.to[0]`", "letter"),
    (FRAME + "reference_points: -1}}", "out-of-range", "-1", "must be at least 0, got `-1`", "at least 0"),
    (
        'calibrations: {a: {revision: 1, owner: ""}}',
        "out-of-range",
        '""',
        "characters, got 0",
        "at least 1",
    ),
    ("interfaces: {/a: {from: arm}}", "interface-kind-missing", "/a", "`topic`, `service`, `action`", "write one of"),
    ("interfaces: {/a: {topik: x/y}}", "interface-kind-missing", "/a", "interfaces./a", "did you mean `topic`"),
    ("rehearsals: {r: {steps: [{}]}}", "step-kind-missing", "{}", "steps[0]` has none of the keys `move`", "write one"),
    (
        RUN + "inject: {at: 1 s}}}",
        "fault-kind-missing",
        "inject",
        "has none of the keys `freeze`",
        "write one of the keys",
    ),
    ("hosts: {pc: }", "empty-value", "pc", "`hosts.pc` has no value", "delete the key"),
    (FRAME + "xyz: }}", "empty-value", "xyz", "`frames.a.xyz` has no value", "delete the key"),
    (TOPIC + "to: [null]}}", "empty-value", "null", "to[0]` has no value", "delete the dash"),
]


@pytest.mark.parametrize(("text", "code", "marked", "message", "help_"), CASES, ids=[case[0][:40] for case in CASES])
def test_mistake_is_reported_once_at_its_place(
    text: str, code: str, marked: str, message: str, help_: str, tmp_path: Path
) -> None:
    lines = (HEAD + ARM + text).split("\n")
    found = parsed("\n".join(lines), tmp_path).diagnostics
    assert [d.code for d in found] == [code]
    span = found[0].span
    assert lines[span.line - 1][span.column - 1 : span.end_column - 1] == marked
    assert message in found[0].message
    assert help_ in found[0].help
    assert "\n" not in found[0].message


@pytest.mark.parametrize("path", CELLS, ids=lambda path: path.parent.name)
def test_cells_of_the_repository_parse(path: Path, tmp_path: Path) -> None:
    outcome = parsed(path.read_text(encoding="utf-8"), tmp_path)
    assert outcome.ok
    assert there(outcome.value).cell == path.parent.name


def test_misspelt_required_key_is_one_error(tmp_path: Path) -> None:
    found = parsed(HEAD + "devices: {arm: {modle: ur5e}}", tmp_path).diagnostics
    assert [(d.code, d.help) for d in found] == [("unknown-key", "did you mean `model`?")]


def test_all_mistakes_come_at_once_in_the_order_of_the_file(tmp_path: Path) -> None:
    text = "format: 1\ncell: A\nversions: {ros: 2}\ndevices: {}\nframes: {a: {parent: world, xyz: 1}}\n"
    found = parsed(text, tmp_path).diagnostics
    expected = [("bad-name", 2), ("wrong-type", 3), ("out-of-range", 4), ("missing-unit", 5)]
    assert [(d.code, d.span.line) for d in found] == expected


def test_missing_section_is_reported_at_the_start_of_the_file(tmp_path: Path) -> None:
    found = parsed("format: 1\ncell: small\nversions: {ros: jazzy}\n", tmp_path).diagnostics
    assert [(d.code, d.message, str(d.span)[-4:]) for d in found] == [
        ("missing-key", "the spec has no `devices`", ":1:1")
    ]


@pytest.mark.parametrize("written", ["2", "true", "1.0", '"1"', "[1]"])
def test_another_format_is_the_only_error(written: str, tmp_path: Path) -> None:
    found = parsed(f"format: {written}\nanything: else\n", tmp_path).diagnostics
    assert [(d.code, d.span.line, d.span.column) for d in found] == [
        ("unsupported-format", 1, 1 if written == "[1]" else 9)
    ]


def test_name_that_ends_in_a_line_break_is_bad(tmp_path: Path) -> None:
    found = parsed(HEAD + 'devices: {"arm\\n": {model: ur5e}}', tmp_path).diagnostics
    assert [(d.code, d.message) for d in found] == [("bad-name", "`arm ` cannot be used in `devices`")]


def test_quantity_keeps_value_and_text(tmp_path: Path) -> None:
    spec = there(parsed(HEAD + ARM + "frames: {tcp: {parent: world, xyz: 0 0 162 mm}}", tmp_path).value)
    xyz = there(spec.frames["tcp"].xyz)
    assert (xyz.si, xyz.text) == ((0.0, 0.0, 0.162), "0 0 162 mm")


def test_parameters_keep_the_type_that_was_written(tmp_path: Path) -> None:
    text = "nodes: {a: {run: x/y, parameters: {i: 1, f: 1.0, b: true, s: '1', l: [a]}}}"
    spec = there(parsed(HEAD + ARM + text, tmp_path).value)
    values = spec.nodes["a"].parameters
    assert [(type(value), value) for value in values.values()] == [
        (int, 1), (float, 1.0), (bool, True), (str, "1"), (tuple, ("a",))
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("written", "si", "units"),
    [
        ("400 mm 0 -90 deg", (0.4, 0.0, -math.pi / 2), ("mm", "deg", "deg")),
        ("0.5 rad, 20 30 mm, 1 rad", (0.5, 0.02, 0.03, 1.0), ("rad", "mm", "mm", "rad")),
        ("400mm 90deg", (0.4, math.pi / 2), ("mm", "deg")),
        ("1 2 m", (1.0, 2.0), ("m", "m")),
    ],
)
def test_each_value_of_a_pose_has_the_unit_behind_it(
    written: str, si: tuple[float, ...], units: tuple[str, ...], tmp_path: Path
) -> None:
    spec = there(parsed(HEAD + ARM + f'motion: {{poses: {{home: {{all: "{written}"}}}}}}\n', tmp_path).value)
    pose = spec.motion.poses["home"]["all"]
    assert pose.si == pytest.approx(si)
    assert pose.units == units


@pytest.mark.parametrize("written", ["400 mm 0 -90", "400 mm 0 -90 kg", "deg 400 mm", "1 2 mm 3", "0 mm,, x deg"])
def test_pose_with_a_value_without_its_unit_is_refused(written: str, tmp_path: Path) -> None:
    found = parsed(HEAD + ARM + f'motion: {{poses: {{home: {{all: "{written}"}}}}}}\n', tmp_path).diagnostics
    assert [finding.code for finding in found] in (["wrong-unit"], ["not-a-quantity"])


def test_tolerance_has_at_most_one_figure_of_a_kind(tmp_path: Path) -> None:
    controller = "type: joint_trajectory, device: arm, path_tolerance: 0.1 rad 5 deg"
    control = f"control: {{update_rate: 100 Hz, controllers: {{moves: {{{controller}}}}}}}\n"
    (found,) = parsed(HEAD + ARM + control, tmp_path).diagnostics
    message = "expected an angle, a length, or one of each for `control.controllers.moves.path_tolerance`"
    assert (found.code, found.message) == ("not-a-quantity", f"{message}, got the text `0.1 rad 5 deg`")


@pytest.mark.parametrize("day", ["2026-02-30", "2026-7-1", "2026-W27-3", "last week"])
def test_day_of_a_mounting_is_a_date(day: str, tmp_path: Path) -> None:
    text = f"devices: {{arm: {{model: ur5e, mount: {{parent: world, since: {day}}}}}}}"
    (found,) = parsed(HEAD + text, tmp_path).diagnostics
    assert (found.code, found.yaml_path) == ("wrong-type", ("devices", "arm", "mount", "since"))
    assert found.message.startswith("expected a date, such as `2026-07-01`")
