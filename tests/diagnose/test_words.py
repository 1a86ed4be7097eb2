"""Words of users and what they mean: beginnings, terms, rarity; weights by hand, from the logarithm of 1 + N/n."""

from __future__ import annotations

import pytest

from cellc.tools.diagnose.words import Words

GROUPS = {"host": ["pc", "machine"], "not": ["not", "cant"]}
WORDS = Words(GROUPS, [["host not see", "estop"], ["host timeout"]], together=["time out", "times out", "timed out"])


def whole(words: Words, text: str) -> list[int]:
    """Return the symptoms of which a text has a whole phrase, the likest first."""
    return [each.number for each in words.likenesses(text) if each.whole]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("my machines can't see it", [0]),
        ("PCs do NOT see it", [0]),
        ("the pcl does not see it", []),
        ("the E-Stop", [0]),
        ("my_machine cannot see_it", []),
        ("my_machine does not see_it", [0]),
        ("coffee", []),
        ("", []),
    ],
)
def test_words_are_known_by_their_beginnings_and_short_ones_as_a_whole(text: str, found: list[int]) -> None:
    assert whole(WORDS, text) == found


def test_term_of_two_words_is_one_word_however_it_is_joined() -> None:
    words = Words(
        {"late": ["timeout", "timedout"], "out": ["out"]}, [["late"], ["out"]], together=["time out", "timed out"]
    )
    assert [whole(words, text) for text in ("it times", "the time out", "it timed-out", "it is out")] == [
        [],
        [0],
        [0],
        [1],
    ]


def test_word_that_is_ignored_says_nothing() -> None:
    words = Words({}, [["real robot"], ["robot"]], ignored=["real"])
    assert whole(words, "the real robot") == [1]


def test_sentence_that_was_heard_is_found_by_other_forms_of_its_words() -> None:
    words = Words({}, [["stops"], ["starts"]], [["the suction lost pressure"], []])
    (like,) = words.likenesses("pressures of suctions")
    # Two of four words that one symptom of two has: each weighs log2(3) = 1.58; 3.17 * 3.17 / 6.34 + 0.3 * 3.17 = 2.54.
    assert (like.number, like.whole) == (0, 0)
    assert like.points == pytest.approx(253.6, abs=1)


def test_phrase_as_a_whole_counts_more_than_the_same_words_of_a_longer_one() -> None:
    words = Words({}, [["plan late image"], ["plan late"], ["image"]])
    assert [each.number for each in words.likenesses("a late plan")] == [1, 0]
    assert whole(words, "a late plan") == [1]


def test_rare_words_say_more_than_common_ones() -> None:
    words = Words({}, [["robot stops"], ["robot moves"], ["robot"], ["robot"], ["octopus"]])
    assert words.likenesses("the robot of the octopus")[0].number == 4


def test_word_counts_once_however_much_it_means() -> None:
    words = Words({"fall": ["drop"], "lose": ["drop"], "sag": ["drop"]}, [["fall"], ["lose"], ["sag"], ["octopus"]])
    # One of four: log2(5) = 2.32.
    assert words.weight("it drops") == 232
    assert {each.whole for each in words.likenesses("it drops")} == {232}


def test_of_two_that_are_as_like_the_one_that_is_listed_first_comes_first() -> None:
    words = Words({}, [["robot stops"], ["robot moves"]])
    assert [each.number for each in words.likenesses("robot")] == [0, 1]
