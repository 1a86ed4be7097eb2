"""Parameters as their programs declare them, and values of which the catalog knows what they spoil."""

import re
from collections.abc import Callable
from typing import Literal

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, DistroName, ParameterFact, Text, Token
from cellc.contract.vocabulary import Distro


class DiscouragedValue(CatalogModel):
    """A value of a parameter, or a range of values, that its program takes and that makes a cell worse.

    Attributes:
        value: The value; absent where a range is meant.
        below: What the values of a range are below.
        above: What the values of a range are above; with ``below``, it lies between them.
        below_of: Parameter whose value the range is below; ``update_rate`` is that of a controller.
        most_of: Parameter whose value is the end of the range, and in it.
        above_of: Parameter whose value the range is above.
        begins: What a text, or an item of a list, begins with.
        lacks: Text that no item of a list contains.
        ahead: Texts of two items of a list of which the first comes before the second.
        given: Other parameters with the values with which alone it is so.
        commands: Command interfaces of a controller of which it is so: it has the first, and no others; empty for any.
        does: What the program does with it, as the end of a sentence.
        source: Line of code or document from which this was read.
    """

    value: ParameterFact | None = None
    below: float | None = None
    above: float | None = None
    below_of: Text | None = None
    most_of: Text | None = None
    above_of: Text | None = None
    begins: Text | None = None
    lacks: Text | None = None
    ahead: tuple[Text, Text] | None = None
    given: dict[Text, ParameterFact] = Field(default_factory=dict)
    commands: tuple[Token, ...] = ()
    does: Text
    source: Text

    def holds(self, value: object, beside: Callable[[str], object] = lambda _: None) -> bool:
        """Tell whether a value is meant; of a list, whether an item is. ``beside`` has the other parameters."""
        if any(beside(name) != wanted for name, wanted in self.given.items()):
            return False
        if self.lacks is not None or self.ahead is not None:
            return isinstance(value, tuple) and self._of_list(tuple(map(str, value)))
        if isinstance(value, tuple):
            return any(self._holds(item, beside) for item in value)
        return self._holds(value, beside)

    @property
    def is_any(self) -> bool:
        """Whether every value is meant, under its conditions."""
        figures = (self.value, self.below, self.above, self.below_of, self.most_of, self.above_of)
        return all(end is None for end in (*figures, self.begins, self.lacks, self.ahead))

    def _of_list(self, items: tuple[str, ...]) -> bool:
        if self.lacks is not None:
            return not any(self.lacks in item for item in items)
        first, second = ([at for at, item in enumerate(items) if text in item] for text in self.ahead or ("", ""))
        return bool(first) and bool(second) and first[0] < second[0]

    def _holds(self, value: object, beside: Callable[[str], object]) -> bool:
        if self.is_any:
            return True
        if self.begins is not None:
            return isinstance(value, str) and value.startswith(self.begins)
        if isinstance(value, (bool, str)) or self.value is not None:
            return value == self.value and isinstance(value, bool) == isinstance(self.value, bool)
        below = self.below if self.below_of is None else _number(beside(self.below_of))
        above = self.above if self.above_of is None else _number(beside(self.above_of))
        most = None if self.most_of is None else _number(beside(self.most_of))
        number = _number(value)
        if number is None or (below is None and above is None and most is None):
            return False
        ends = (below is None or number < below, most is None or number <= most, above is None or number > above)
        return all(ends)


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


ParameterType = Literal[
    "bool", "int", "double", "string", "bool_array", "int_array", "double_array", "string_array", "none"
]


class ParameterVariant(CatalogModel):
    """What one distribution declares otherwise.

    Attributes:
        default: Default in this distribution.
        required: Whether this distribution requires a value.
        read_only: Whether this distribution refuses a change at run time.
        one_of: Values that this distribution takes.
        not_empty: Whether this distribution refuses an empty value.
    """

    default: ParameterFact | None = None
    required: bool | None = None
    read_only: bool | None = None
    one_of: tuple[Text, ...] | None = None
    not_empty: bool | None = None


class ParameterFacts(CatalogModel):
    """One declared parameter; dots nest, ``<joint>`` is any joint name.

    Attributes:
        type: Type of the value.
        default: Value if the parameter is not given.
        required: Whether it must be given if it has no default.
        read_only: Whether it cannot be changed at run time.
        minimum: Smallest value that is accepted.
        exclusive_minimum: Value that must be exceeded.
        maximum: Largest value that is accepted.
        one_of: Values that are accepted; empty for any.
        subset_of: Elements that a list may have; empty for any.
        not_empty: Whether an empty text or list is refused.
        unique: Whether the elements of a list must differ.
        needs: Elements that a list may have only beside another one.
        within: Parameter whose list has every element of this one.
        only: Distributions that declare the parameter; empty for all.
        differs: What one distribution declares otherwise.
        not_played: What the mock does whatever the value is; absent where it plays the value.
        discouraged: Accepted values that make motion worse, or unsafe.
        names: What a text, or each item of a list, is the full name of.
        key: Key of the spec that states the same.
    """

    type: ParameterType
    default: ParameterFact | None = None
    required: bool = False
    read_only: bool = False
    minimum: float | None = None
    exclusive_minimum: float | None = None
    maximum: float | None = None
    one_of: tuple[Text, ...] = ()
    subset_of: tuple[Text, ...] = ()
    not_empty: bool = False
    unique: bool = False
    needs: dict[Text, Text] = Field(default_factory=dict)
    within: Text | None = None
    only: tuple[DistroName, ...] = ()
    differs: dict[DistroName, ParameterVariant] = Field(default_factory=dict)
    not_played: Text | None = None
    discouraged: tuple[DiscouragedValue, ...] = ()
    names: Literal["frame", "state interface", "command interface"] | None = None
    key: Text | None = None

    def declared_in(self, distro: Distro) -> bool:
        """Tell whether the distribution knows the parameter; an unknown one is ignored silently."""
        return not self.only or distro in self.only

    def as_in(self, distro: Distro) -> "ParameterFacts":
        """Return what a distribution declares."""
        variant = self.differs.get(distro)
        return self if variant is None else self.model_copy(update=variant.model_dump(exclude_unset=True))


def is_named(declared: str, name: str) -> bool:
    """Whether a written name is that of a declared parameter; ``<joint>`` is any name, which may itself hold dots."""
    first, *others = re.split(r"<[a-z_]+>", declared)
    if not others:
        return name == first
    *inner, last = others
    at = len(first)
    # Each part at its first place: of a search that tries them all, the time grows with the power of their number.
    for part in inner:
        start = name.find(part, at + 1)
        if start < 0:
            return False
        at = start + len(part)
    return name.startswith(first) and name.endswith(last) and len(name) - len(last) > at


def named_part(declared: str, name: str) -> str | None:
    """Return what a written name has for the one placeholder of a declared one; None where it has not one."""
    parts = re.split(r"<[a-z_]+>", declared)
    return name[len(parts[0]) : len(name) - len(parts[1])] if len(parts) == 2 else None
