"""Writes docs/review.md: how `cellc diff` grades changes, from the tables that it grades by.

`python -m tests.docs.review` writes it again after a row came, went or changed.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.deploy.gates import gate_texts
from cellc.review.rows import ROWS
from cellc.review.rules import APPROVAL, REPEATED, THINGS, Row, Thing
from cellc.vocabulary import ReviewArea
from tests.cells import ROOT

PAGE = ROOT / "docs" / "review.md"
_HEAD = """# Review

`cellc diff` tells what changed from one state of a cell to another, and what that means: fact by fact, with figures
in mm, degrees and percent. Comments, order and the spelling of units are no change.

<!-- exit 1: acceleration -->
<!-- exit 1: velocity -->
<!-- exit 1: velocity -->
<!-- exit 1: velocity -->
<!-- exit 0: no change -->
<!-- exit 1: velocity -->
```sh
cellc diff cells/ur5e_pick/cell.yaml                 # HEAD and the work tree
cellc diff main cells/ur5e_pick/cell.yaml            # a revision and the work tree
cellc diff main..HEAD cells/ur5e_pick/cell.yaml      # two revisions
cellc diff main...HEAD cells/ur5e_pick/cell.yaml     # what HEAD did since it left main
cellc diff main:generated/ur5e_pick generated/ur5e_pick
cellc diff generated/ur5e_pick cells/ur5e_pick/cell.yaml
```

A side is a spec, a generated folder, or either of them in a git revision. Of a revision the folder of the spec is
taken, with what it includes and its devices; links are not followed, and git is read, never changed. A spec with
errors is not compared: `cellc check` tells them.

It ends with 0 where nothing changed, with 1 where something did, with 2 where a side cannot be read. `--breaking`
ends with 1 only where a consumer outside of the cell breaks. `--rehearse` runs the rehearsals of both sides on the
mock and compares how they end. `--format markdown` is a comment for a pull request of at most 65,000 characters,
`--format json` the object of `review.schema.json` (`cellc schema review`).

## Another distribution

`cellc upgrade cells/ur5e_pick/cell.yaml --ros kilted` tells what a distribution of ROS 2 would change, an older one
too: each pin with what the matrix says of it and since when; parameters that appear, vanish or change their default,
and whether the cell states them; names at the ROS graph that nodes gain and lose; the package, compiled in memory and
compared as above; and the gates to pass again. A pin that no matrix knows for the distribution becomes UNKNOWN, with a
question. Where the check refuses the cell there, its errors are told, and no package is compared. `--write` puts the
new pins into the spec and what it includes, and touches nothing else. It ends with 0 where nothing would change, with
1 where something would, with 2 where the spec cannot be read or edited.

## Grades

| grade | meaning |
|---|---|
| safe | nothing moves faster, further or with less watching than before, and no consumer loses anything |
| review | the owner of the approval area reads it |
| dangerous | something may move otherwise than people at the cell expect, or a protection is weaker than it was |

What no row below fits is `review`: nothing is passed over. A line of a generated file that no told change explains
is told with its file. A zero is no bound: ros2_control checks no tolerance and no time that is zero.

A transform that was measured does not change without another measurement: a frame with a calibration whose pose
changed is dangerous where the calibration has no new revision. How far tips move in each named pose and goals in
the root frame follows by forward kinematics, with dynamic frames where the mock puts them.

A finding that a comment in the spec excuses did not go: the excuse is told. Where two cells are not the same and no
file shows in what, each value is told by its name in the linked cell; of two folders alone that much is said.
"""


def page() -> str:
    """Return the page as it must be."""
    return _HEAD + "".join(f"{line}\n" for line in (*_areas(), *_values(), *_things()))


def _areas() -> Iterator[str]:
    yield ""
    yield "## Areas"
    yield ""
    yield "The owner is that of the approval area in `owners.approvals` before the change, with a new one beside them:"
    yield "nobody chooses who approves their own change. Gates and layers rest on those before them: from the first one"
    yield "on, the evidence counts no longer."
    yield ""
    yield "| area | approval | gate | layer |"
    yield "|---|---|---|---|"
    promotion = {gate.code for gate in gate_texts().promotion}
    for area in ReviewArea:
        codes = REPEATED[area]
        gates = ", ".join(code for code in codes if code in promotion) or "none"
        layers = ", ".join(code for code in codes if code not in promotion) or "none"
        yield f"| {area} | {APPROVAL[area]} | {gates} | {layers} |"


def _values() -> Iterator[str]:
    yield ""
    yield "## Values"
    yield ""
    yield "| area | what | grade | breaks consumers |"
    yield "|---|---|---|---|"
    for row in sorted(ROWS, key=_area):
        why = f"; {row.why}" if row.why else ""
        what = f"{row.quantity.rstrip(':')} (`{row.pattern}`)"
        yield f"| {row.area} | {what} | {row.rule.value}{why} | {_yes(row.breaking)} |"


def _things() -> Iterator[str]:
    yield ""
    yield "## What comes and goes"
    yield ""
    yield "| area | what | comes | goes | breaks consumers where it goes |"
    yield "|---|---|---|---|---|"
    for thing in sorted(THINGS, key=_area):
        yield f"| {thing.area} | {thing.noun} | {thing.came} | {thing.went} | {_yes(thing.breaking)} |"


def _area(of: Row | Thing) -> int:
    return tuple(ReviewArea).index(of.area)


def _yes(value: bool) -> str:
    return "yes" if value else ""


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
