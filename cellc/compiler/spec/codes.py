"""Every code that the shape of a spec can cause, with its documentation page."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import CodePage

# Each is merged into a complete cell by a test, which finds it reported at its mark and nowhere else.
_EXAMPLES: Mapping[str, str] = {
    "empty-value": """
$ sed -i 's/^summary: .*/summary:/' cell.yaml
$ cellc check cell.yaml
""",
    "bad-name": """
nodes:
  task-2: {run: cell_tasks/pick_place, host: control_pc}  # expect at task-2
""",
    "fault-kind-missing": """
rehearsals:
  late: {use: pick_and_place, inject: {at: 1 s}, expect: stale_state}  # expect at inject
""",
    "interface-kind-missing": """
interfaces:
  /markers: {from: perception, to: task}  # expect at /markers
""",
    "missing-key": """
hosts:
  vision_pc:
    nics: {office: {carries: [camera]}}  # expect at office
""",
    "missing-unit": """
frames:
  tcp: {xyz: 0 0 162}  # expect at xyz
""",
    "not-a-choice": """
network: {discovery: broadcast}  # expect at discovery
""",
    "not-a-quantity": """
control: {update_rate: fast}  # expect at update_rate
""",
    "out-of-range": """
control: {update_rate: 0 Hz}  # expect at update_rate
""",
    "step-kind-missing": """
rehearsals:
  short: {steps: [{at: 1 s}]}  # expect at at
""",
    "unknown-key": """
control: {update_rat: 500 Hz}  # expect at update_rat
""",
    "unsupported-format": """
format: 2  # expect at format
""",
    "wrong-count": """
frames:
  tcp: {xyz: 0 162 mm}  # expect at xyz
""",
    "wrong-type": """
nodes:
  task: {lifecycle: often}  # expect at lifecycle
""",
    "wrong-unit": """
control: {update_rate: 500 ms}  # expect at update_rate
""",
}


def _page(code: str, title: str, why: str, fix: str) -> CodePage:
    return CodePage(code, Severity.ERROR, title, why, fix, _EXAMPLES.get(code, ""))


CODES: tuple[CodePage, ...] = (
    _page(
        "bad-name",
        "a name holds characters that are not legal in it",
        "Names of devices, nodes, frames and controllers become ROS graph names, package names and links, where a "
        "dash, a space or a leading digit is illegal or silently rewritten.",
        "use letters, digits and `_`, beginning with a letter; a package name in lower case",
    ),
    _page(
        "empty-value",
        "a key or a dash has no value",
        "An empty value looks like a forgotten one, and would mean a default that was never chosen.",
        "write a value, `UNKNOWN` where a version is not known, or delete the key",
    ),
    _page(
        "fault-kind-missing",
        "an injected fault does not say what fails",
        "The kind of a fault is the key that names what it hits, as in `freeze: camera`; without it nothing is "
        "injected and the rehearsal would prove the wrong thing.",
        "write one of the keys of a fault, and `at`",
    ),
    _page(
        "interface-kind-missing",
        "an interface is neither topic, service nor action",
        "The kind decides whether an exchange has progress, cancellation and a bounded answer; it is never guessed "
        "from the name of the type.",
        "write the type under the key `topic`, `service` or `action`",
    ),
    _page(
        "missing-key",
        "a required key is absent",
        "The part cannot be built without it, and no default would be safe.",
        "add the key",
    ),
    _page(
        "missing-unit",
        "a quantity is a bare number",
        "Degrees read as radians and millimeters read as meters move a robot by a factor of 57 or 1000. The unit "
        "is part of the text, so that the reviewer and the compiler read the same value.",
        "write the unit after the number",
    ),
    _page(
        "not-a-choice",
        "a value is not one of the choices of its key",
        "The key takes one of a few words; another would be ignored or mean something else to the next reader.",
        "write one of the choices",
    ),
    _page(
        "not-a-quantity",
        "a value is not a number with a unit",
        "A quantity is one number, or several, followed by one unit: `500 Hz`, `0 0 162 mm`. Expressions, several "
        "units and other text are not evaluated.",
        "write a number and its unit",
    ),
    _page(
        "out-of-range",
        "a count, a number or a length is out of range",
        "The bound is part of the meaning of the key: a queue holds at least one sample, a cell at least one device.",
        "write a value within the bound of the message",
    ),
    _page(
        "step-kind-missing",
        "a step does not say what it does",
        "The kind of a step is the key that names its target, as in `move: home`.",
        "write one of the keys `move`, `detect`, `grip` or `wait`",
    ),
    _page(
        "unknown-key",
        "the language has no such key in this place",
        "A misspelled key that is silently ignored leaves its default in force: a limit that is visible in "
        "the file and has no effect.",
        "correct the spelling, move the key to where it belongs, or delete it",
    ),
    _page(
        "unsupported-format",
        "the spec is written in another version of the language",
        "Keys and their meaning may differ between formats, so nothing else in the file is judged.",
        "write `format: 1`, or use the release of cellc that the spec was written for",
    ),
    _page(
        "wrong-count",
        "a vector has too few or too many numbers",
        "A position and a rotation have three numbers. Padding or cutting would move a frame without a word.",
        "write as many numbers as the message asks for, and one unit after them",
    ),
    _page(
        "wrong-type",
        "a value is of another kind than the key takes",
        "A list in place of a mapping, or a number in place of text: `4.10` as a number is 4.1, "
        "which is another version.",
        "write the kind of value that the message asks for; put text that looks like a number in quotes",
    ),
    _page(
        "wrong-unit",
        "the unit does not measure this quantity",
        "The spelling of units is fixed and case counts, because `m` and `mm`, `MHz` and `mHz` differ in little else.",
        "write one of the units that the help lists",
    ),
)
