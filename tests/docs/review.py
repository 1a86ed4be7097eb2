"""Writes docs/review.md: how `cellc diff` grades changes, from the tables that it grades by.

`python -m tests.docs.review` writes it again after a row was added, removed or changed.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.deploy.gates import gate_texts
from cellc.contract.grading import Graded
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.rows import ROWS
from cellc.tools.review.rules import APPROVAL, REPEATED, THINGS, Thing
from tests.cells import ROOT

PAGE = ROOT / "docs" / "review.md"
_HEAD = """# Review

`cellc diff` shows what changed from one state of a cell to another, and what that means: fact by fact, with figures
in mm, degrees and percent. Comments, order and the spelling of units are not changes; numbers in another
order are.

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

A side is a spec, a generated folder, or either of them in a git revision. From a revision, cellc takes the folder of
the spec, its includes and its devices; it follows no links, and reads git but never changes it. A spec in which
rules find errors is compared all the same, so that its repair can be reviewed: errors that are new stand first, and a
note says how many of before are still there. One that cannot be read or linked is refused; `cellc check` lists why.

The exit code is 0 where nothing changed, 1 where something did, 2 where a side cannot be read, and 70 where cellc
itself failed. With `--breaking` it is 1 only where a consumer outside the cell breaks. `--rehearse` runs the rehearsals
of both sides on the mock and compares how they end. `--format markdown` writes a comment for a pull request of at most
65,000 characters,
`--format json` the object of `review.schema.json` (`cellc schema review`).

What is printed fits on a screen of 25 lines, and so does what a comment shows unfolded; `--all` prints every value,
finding and gate. The first line counts the headings by their grade, and the changes below them. New errors come
first; other new findings stand below the line that they follow from. Each line of the spec that changed is a heading
with what it causes under it: the worst first, and of one grade the largest act:

1. a device that is new or has another model;
2. where a device is mounted, and which program runs where;
3. what stops, who commands and owns, and what happens after a fault;
4. where things are around the arms, the farthest move first;
5. bounds of motion and of force: positions, then velocities, then accelerations;
6. named poses and goals, the farthest move first;
7. addresses, versions, and how nodes exchange data;
8. payload, measurements, clocks and rates;
9. tolerances, timeouts, gains and parameters, and what moves by less than 1 mm and 1 deg;
10. what rests on others or is noted: first motions, rehearsals, open questions, scheduling.

A figure that is at least doubled or halved is two places before, but for the last ones.
Several lines with the same values, of several devices, named poses or goals, are one heading; so are both ends of one
rate, and one bound that the action, the rehearsal and the figure repeat. A line that only says again what its heading
says of the same thing is left out; why it counts is not. Lines that are too long are broken, and none is cut: where the
whole has no room, values that are alike are one line, then causes that are not dangerous are. Why a change is
dangerous, whose consumers it breaks and how nodes find each other always stand there. Two lines that exchanged their
values say so.
To know what a line causes, cellc builds the cell with that line alone, or with all but that line; what only several
lines cause together is listed under one of them. Lines
that cannot stand alone, such as a device and its controllers, are listed together; so are those of one part of the spec
where there are many. Folders have no spec: their changes are listed by area, and names that changed are found in the
contract. In a pull request the action annotates what is new, and what fails (`cellc check --format github --against
REVISION`), and draws both states of each cell that changed in one page (`cellc view SPEC --against REVISION`).

Of a device with another model the heading has reach, payload, stroke, largest and least force before and after, how
many shapes it has, how far they get from the mount, and what its links weigh in the description, of a camera range,
view and resolution. Of a new device it has what there is of these. Joints and
links that one model alone has are one change. What the spec states for the model before and was left (the payload of
the arm that carries it, frames on it, its mount, poses, the width of parts) is listed as left as it was.

No change is left out because it has words in common with another one. A value that repeats others is left out where it
says exactly the same of the same part, or where one line of the spec makes both and the other is graded no lower; lines
of documents are left out where each line of the spec that changes them is listed with what it means.

A part of the spec that has another name and says the same otherwise, or nearly, is renamed: one line with what it
names, with how many names follow and which of those may break consumers. What else changed is compared under the new
names. A namespace is a name too. A finding that says another figure of the same thing, or the same of a part with
another name, is neither new nor resolved.

## Another distribution

`cellc upgrade cells/ur5e_pick/cell.yaml --ros kilted` shows what another distribution of ROS 2, newer or older, would
change: each pin with its entry in the compatibility matrix and its date; parameters that appear, vanish or change
their default, and whether the cell sets them; names that nodes add to the ROS graph or remove from it; the package,
compiled in memory and compared as above; and the gates to repeat. A pin that no matrix knows for the distribution
becomes UNKNOWN, with a question. Where the cell has errors there, they are listed, and no package is compared.
`--write` puts the new pins into the spec and its includes, and touches nothing else. The exit code is 0 where nothing
would change, 1 where something would, and 2 where the spec cannot be read or edited.

## Grades

| grade | meaning |
|---|---|
| safe | nothing moves faster, further or with less monitoring than before, and no consumer loses anything |
| review | the owner of the approval area reads it |
| dangerous | something may move in a way that people at the cell do not expect, or a protection is weaker than it was |

A change that fits no row below is graded `review`, so that nothing is missed. A line of a generated file that no
listed change explains is listed with its file. Zero is not a bound:
ros2_control skips the check of a tolerance or time of zero.

One act is one cause, and its heading says how far things moved: a new measurement with its lines in `calibrations` and
the poses of frames and mounts that it measured; another model with its mount, pins and serial number, and with the
calibration that was renewed for it; both ends of a topic; a list that repeats addresses of other lines.

What was measured is graded by whether it was measured again, not by how far it moved: with a new revision it is graded
`review`, without one dangerous. The TCP set in a robot follows the frames on it. A payload has no revision. It is
graded `review` while the mass differs by less than a tenth of what the arm is rated for and its center by less than
50 mm, as when it is weighed again, or where the arm carries other devices; dangerous above that, beyond the rating, and
where it is gone.

Another model is dangerous where an arm ends elsewhere in the same joint positions, where calibrations that measured the
one before have no new revision, and where a tool is heavier or lighter by a tenth of the rating and the payload of its
arm was left; else it is graded `review`. A pin that is UNKNOWN from the start is a blocker, and not dangerous. The
bound of a clock counts where stamps with an age limit are made on it, or are judged on it and it is above a tenth of
the limit.

What was UNKNOWN and is stated now only makes something known: pins, owners and what else is graded `review` are then
safe, where no matrix says that they do not work together. A limit or a bound is a figure all the same.

A measured transform changes only with a new measurement: a changed pose of a calibrated frame is dangerous unless
the calibration has a new revision. So is another model, serial number, mount or day of mounting of a device that a
calibration measured: the device of the frame, and those that carry it, up to the next joint that moves.

Collision shapes are compared by the room that they take up, those of a device in the frame by which it is mounted.
One that shrank or lies elsewhere is dangerous, as is one
that is gone: planning no longer avoids where it was. One that grew is graded `review`. Of an obstacle, pose, parent and
size count together; it says how far it moved, which room is free now, and how far it is from what it touched. A box,
also that of a shared area, says what it loses and gains on each side. One arm at a time is in
a shared area: a larger one keeps arms apart in more room and is graded `review`, for what grants access must be set to
the same box, and the review names it; one that loses room is dangerous. Of an area that is released to several arms, a
larger one is dangerous.

An arm whose base is elsewhere in the root frame is dangerous, whatever moved it: its mount, or what carries it.

A step of the bring-up is what it does: one of another name is the same step. One that only compares versions, as a
further computer takes it, is graded `review`.

A named pose or a goal that is edited is graded `review`, however far the tip moves: motion to it is planned around
what the cell knows. A bound that allows less, of a tolerance, a timeout or an age, is safe.

How far tips move in each named pose, and goals in the root frame, is computed by
forward kinematics, with dynamic frames at their pose on the mock.

A finding that a comment in the spec excuses is not resolved: the excuse is listed. Where two cells differ and no file
shows how, each value is listed by its name in the linked cell; two generated folders do not hold such a value:
their difference is dangerous, and the review says to compare the specs.
"""


def page() -> str:
    """Return the page as it must be."""
    return _HEAD + "".join(f"{line}\n" for line in (*_areas(), *_values(), *_things()))


def _areas() -> Iterator[str]:
    yield ""
    yield "## Areas"
    yield ""
    yield "The owner is that of the approval area in `owners.approvals` before the change, with a new one beside them;"
    yield "a change cannot choose its own approver. Another owner of an area is approved by the old and the new one,"
    yield "in that area and in that of the owners. The owner of the recovery is asked of its states, too. What only"
    yield "follows, such as a tip that moves, asks no owner but that of its cause; a new name asks where"
    yield "consumers may break. Of what is safe, limits and matters of safety are asked."
    yield "Stiffness and damping of joints are approved by safety and control; so is what says how soon motion stops:"
    yield "watchdogs, times to stop, bounds of rehearsed stops. An owner of what is new who approves nothing is named."
    yield "Some values ask more areas: the table of values lists them. A parameter has the area of"
    yield "its node: control for a controller, motion for MoveIt, devices for the driver of a device, else interfaces."
    yield "A parameter that only follows from another line asks no owner but that of the line."
    yield "Gates and layers rest on those before them, so that"
    yield "the evidence from the first one on is no longer valid. Under the same configuration id none is."
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
    yield "| area | what | grade | also asks | breaks consumers |"
    yield "|---|---|---|---|---|"
    for row in sorted(ROWS, key=lambda row: _area(row.grade)):
        why = f"; {row.grade.why}" if row.grade.why else ""
        what = f"{row.grade.quantity.rstrip(':')} (`{row.pattern}`)"
        asks = ", ".join(row.grade.asks)
        cells = (row.grade.area, what, f"{row.grade.rule.value}{why}", asks, _yes(row.grade.breaking))
        yield f"| {' | '.join(cells)} |"


def _things() -> Iterator[str]:
    yield ""
    yield "## What comes and goes"
    yield ""
    yield "| area | what | comes | goes | breaks consumers where it goes |"
    yield "|---|---|---|---|---|"
    for thing in sorted(THINGS, key=_area):
        yield f"| {thing.area} | {thing.noun} | {thing.added} | {thing.removed} | {_yes(thing.breaking)} |"


def _area(of: Graded | Thing) -> int:
    return tuple(ReviewArea).index(of.area)


def _yes(value: bool) -> str:
    return "yes" if value else ""


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
