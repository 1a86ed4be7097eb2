"""The comment for a pull request: what GitHub makes of it, however much there is and whatever it is called."""

from __future__ import annotations

import re

from cellc.contract.printing import as_text
from cellc.contract.review import Review, ReviewChange, ReviewFinding, ReviewRehearsal, ReviewSide
from cellc.contract.vocabulary import Grade, ReviewArea
from cellc.tools.review.markdown import render_markdown
from cellc.tools.review.text import render_review

HOSTILE = (
    "a`b``c | d <img src=x onerror=1> @everyone #1 [l](http://x) </details> ::error::x ##[error]y \x1b[31m \u202e \n# h"
)


def _review(*changes: ReviewChange, rehearsals: tuple[ReviewRehearsal, ...] = ()) -> Review:
    side = ReviewSide(name=HOSTILE, cell="x", configuration_id="cfg-1")
    found = (ReviewFinding(code="a-code", severity="error", message=HOSTILE, place=HOSTILE),)
    return Review(
        format=1, before=side, after=side, changes=changes, new_findings=found, rehearsals=rehearsals, notes=(HOSTILE,)
    )


def _change(number: int = 0, grade: Grade = Grade.REVIEW) -> ReviewChange:
    return ReviewChange(
        area=ReviewArea.FRAMES,
        subjects=(f"frame_{number} {HOSTILE}",),
        quantity="pose",
        before=HOSTILE,
        after=HOSTILE,
        delta="moves 1 mm",
        grade=grade,
        why=HOSTILE,
        approval="time_tf",
        owner=HOSTILE,
    )


def _outside_of_code(line: str) -> str:
    """Return a line without its code spans, by CommonMark 0.31 section 6.1."""
    return re.sub(r"(?<!`)(`+)(?!`)(.+?)(?<!`)\1(?!`)", "", line)


def test_what_comes_from_a_file_is_code_and_no_mark_of_ours() -> None:
    text = render_markdown(_review(_change()))
    for line in text.splitlines():
        outside = _outside_of_code(line)
        assert not any(mark in outside for mark in ("@everyone", "<img", "http", "#1", "::error", "##["))
        assert outside.count("|") in (0, 6)
    assert "\x1b" not in text
    assert "\u202e" not in text
    assert text.count("<details") == text.count("</details>") - len(re.findall(r"`[^`\n]*</details>", text))


def test_a_comment_is_never_longer_than_github_takes_and_says_what_it_leaves_out() -> None:
    review = _review(*(_change(number, Grade.DANGEROUS if number < 5 else Grade.REVIEW) for number in range(500)))
    text = render_markdown(review)
    assert len(text) <= 65_000
    shown = len(re.findall(r"^\| (?:dangerous|review) \| frames", text, re.MULTILINE))
    told = re.search(r"\*\*(\d+) more changes do not fit into a comment", text)
    assert told is not None
    assert shown + int(told[1]) == 500
    assert shown > 30


def test_a_comment_of_a_few_changes_is_whole() -> None:
    text = render_markdown(_review(_change(grade=Grade.DANGEROUS), _change(1), _change(2, Grade.SAFE)))
    assert "do not fit" not in text
    assert re.findall(r"<details><summary>(.+)</summary>", text)[0] == "1 dangerous, 1 review, 1 safe"
    assert text.count("| frames |") == 3


def test_values_and_their_difference_are_one_cell_and_a_list_says_only_what_it_lost_and_gained() -> None:
    of_a_list = {"before": "a, b, c, d, e", "after": "a, b, c, d, f", "delta": "lost e; new f"}
    all_new = {"before": "a, b", "after": "c, d", "delta": "lost a, b; new c, d"}
    text = render_markdown(
        _review(
            _change().model_copy(update={"before": "850 mm", "after": "1300 mm", "delta": "+450 mm"}),
            _change(1).model_copy(update=of_a_list),
            _change(2).model_copy(update=all_new),
            _change(3).model_copy(update={"before": None, "after": "x" * 60, "delta": ""}),
        )
    )
    cells = [row.split(" | ")[3] for row in text.splitlines() if row.startswith("| review")]
    assert cells == [
        "850 mm -> 1300 mm<br>+450 mm",
        "lost e<br>new f",
        "`a, b` -> `c, d`",
        f"not stated<br>-> `{'x' * 60}`",
    ]


def test_outcomes_of_rehearsals_are_told_on_both_sides() -> None:
    ended = ReviewRehearsal(
        name="pick", before="succeeded", after="planning_failure", passed_before=True, passed_after=False
    )
    lost = ReviewRehearsal(name="stale", before="stale_state", passed_before=True)
    review = _review(rehearsals=(ended, lost))
    text = as_text(render_review(review), color=False)
    assert "  pick: succeeded -> planning_failure, not as declared\n" in text
    assert "  stale: stale_state -> not run\n" in text
    assert "- pick: succeeded -> `planning_failure`, not as declared" in render_markdown(review)


def test_what_a_terminal_would_obey_is_escaped() -> None:
    text = as_text(render_review(_review(_change())), color=True)
    assert "\x1b[31m \u202e" not in text
    assert all(not line.startswith("::") for line in text.splitlines())


def test_a_comment_that_is_cut_off_ends_with_a_whole_line() -> None:
    name = f"{'`' * 280}x <img src=x> @everyone"
    found = tuple(ReviewFinding(code="a-code", severity="error", message=name, place="") for _ in range(40))
    review = _review().model_copy(update={"new_findings": found, "gone_findings": found, "notes": (name,) * 40})
    whole = render_markdown(review, 1_000_000)
    assert len(whole) > 65_000
    for longest in (65_000, 30_000, *range(20_000, 20_100)):
        text = render_markdown(review, longest)
        assert len(text) <= longest
        assert whole.startswith(text)
        assert text.endswith("\n")
