"""What is known of symptoms: data with a source each, in which no step can change anything."""

from __future__ import annotations

import re
from functools import cache
from string import Formatter
from typing import Annotated, Literal, TypeVar, get_args

from pydantic import Field, StringConstraints, field_validator, model_validator

from cellc.compiler.catalog.catalog_model import CatalogModel, LayerName, Text, Token
from cellc.compiler.catalog.compiled import CATALOG, compiled_table
from cellc.contract.attempt import Layer
from cellc.contract.vocabulary import ApprovalArea
from cellc.tools.diagnose.fields import FIELDS, Scope

Topic = Literal[
    "network",
    "qos",
    "time",
    "lifecycle",
    "realtime",
    "ownership",
    "planning",
    "perception",
    "vendor",
    "tool",
    "recording",
    "safety",
]
LAYERS: tuple[Topic, ...] = get_args(Topic)
"""The layers in the order in which they are ruled out."""

# Commands that read. Anything else, such as a switch, a parameter set or a published message, is refused as data.
_READING = re.compile(
    r"ros2 (topic (info|list|echo --once|hz|bw|delay|type)|node (list|info)|param (get|list|dump|describe)"
    r"|action (info|list)|service (list|type)|lifecycle (get|nodes)|control list_\w+|pkg (prefix|xml)|doctor --report"
    r"|bag info|interface show|run tf2_ros tf2_(echo|monitor)|run image_transport list_transports)\b[^;&|<>`$]*"
    r"|printenv [A-Z_]+|ip -brief (address|link)|ip (-details )?-statistics link show"
    r"|ip route get [\w{}.]+|ping -c 5 [\w{}.]+"
    r"|chronyc (tracking|sources)|uname -v|locale|ulimit -r|id -nG|lsusb -t"
    r"|ls -l /dev/(shm|serial/by-id)|df -h( /dev/shm)?"
    r"|sysctl net\.core\.rmem_max net\.core\.rmem_default|ss -lntup|top -b -n 1|ps -ef|nvidia-smi|glxinfo -B"
)


_ModelT = TypeVar("_ModelT", bound=CatalogModel)


class Action(CatalogModel):
    """One thing to look at, by a command that reads or by eye."""

    of: Scope
    run: Text | None = None
    look: Text | None = None

    @field_validator("run")
    @classmethod
    def _only_reads(cls, run: str | None) -> str | None:
        if run is not None and not _READING.fullmatch(run):
            raise ValueError(f"`{run}` is no command that only reads")
        return run

    @model_validator(mode="after")
    def _names_its_subject(self) -> Action:
        if (self.run is None) == (self.look is None):
            raise ValueError("an observation either runs a command or looks at something")
        for text in (self.action, *self.read):
            unknown = {name for _, name, _, _ in Formatter().parse(text) if name is not None} - set(FIELDS[self.of])
            if unknown:
                raise ValueError(f"`{self.of}` has no {', '.join(sorted(unknown))}")
        return self

    @property
    def action(self) -> str:
        """The command, or what is looked at."""
        return self.run or self.look or ""

    @property
    def read(self) -> tuple[str, ...]:
        """What outcomes say."""
        return ()


class Observation(Action):
    """An action, and what would rule the hypothesis out."""

    refuted: Text

    @property
    def read(self) -> tuple[str, ...]:
        """What outcomes say."""
        return (self.refuted,)


class Hypothesis(CatalogModel):
    """One cause and how to rule it out."""

    cause: Text
    observations: tuple[Observation, ...] = Field(min_length=1)


Phrase = Annotated[str, StringConstraints(pattern=r"^[a-z0-9]+( [a-z0-9]+)*\Z", max_length=100)]
"""Words with a space between: groups of ``words.yaml``, or beginnings of words."""
Sentence = Annotated[str, StringConstraints(pattern=r"^[^\s].*[^\s]\Z", max_length=200)]
Thread = Annotated[str, StringConstraints(pattern=r"^https://[\w./-]+\Z", max_length=200)]
"""Address of a public thread."""
Template = Annotated[str, StringConstraints(pattern=r"^[^{}\s]([^{}]|\{\w*\}(?!\{))*\Z", max_length=300)]


class Symptom(CatalogModel):
    """What somebody sees, or a program logs.

    Args:
        drivers: packages of the drivers that it belongs to; every device where empty.
        said: phrases of groups and beginnings of words.
        heard: public thread → its symptom in the words of users.
        logged: texts of log lines, with ``{kind}`` where they name something, as ``log_lines`` reads them.
        shows: layer of an attempt in which such a line shows a failure; UNKNOWN where it is of none.
        shows_else: texts of ``logged`` that show another layer.
        names_cause: texts of ``logged`` that name the cause: these alone make a layer certain.
        says_little: texts of ``logged`` that any failure leads to: whatever else is said counts more.
        ask: question whose yes speaks for this symptom; that of its layer where it has none.
        hypotheses: causes, the likeliest first.
        never: the shortcut that hides the cause or takes a protection away.
    """

    name: Text
    never: Text
    source: Text
    drivers: tuple[Token, ...] = ()
    said: tuple[Phrase, ...] = Field(min_length=1)
    heard: dict[Thread, Sentence] = Field(default_factory=dict)
    logged: tuple[Template, ...] = ()
    shows: LayerName | None = None
    shows_else: dict[LayerName, tuple[Template, ...]] = Field(default_factory=dict)
    names_cause: tuple[Template, ...] = ()
    says_little: tuple[Template, ...] = ()
    ask: Text | None = None
    hypotheses: tuple[Hypothesis, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _what_is_logged_shows_a_layer(self) -> Symptom:
        if self.logged and self.shows is None:
            raise ValueError("what is `logged` shows a layer: state `shows`")
        graded = (*self.shows_else.values(), self.names_cause, self.says_little)
        unknown = {text for texts in graded for text in texts} - set(self.logged)
        if unknown:
            raise ValueError(f"`logged` has no {', '.join(sorted(unknown))}")
        return self

    def shown_by(self, template: str) -> Layer | None:
        """Return the layer of an attempt in which a text of ``logged`` shows a failure."""
        return next((layer for layer, texts in self.shows_else.items() if template in texts), self.shows)


class LayerKnowledge(CatalogModel):
    """One layer: its symptoms and the approval area whose owner decides."""

    layer: Topic
    title: Text
    owner: ApprovalArea
    symptoms: tuple[Symptom, ...] = Field(min_length=1)


Word = Annotated[str, StringConstraints(pattern=r"^[a-z0-9]+\Z", max_length=30)]


class Synonyms(CatalogModel):
    """Meaning → beginnings of the words that users have for it; terms that are one word, and words that say nothing."""

    together: tuple[Phrase, ...]
    ignored: tuple[Word, ...]
    words: dict[Token, tuple[Word, ...]]


class Deciding(CatalogModel):
    """A question whose yes speaks for a layer, and whose no speaks for another one that fits too."""

    layer: Topic
    ask: Text


class Between(CatalogModel):
    """A question between two layers: yes speaks for the first, no for the second."""

    layers: tuple[Topic, Topic]
    ask: Text


class Narrowing(CatalogModel):
    """A question that leaves fewer layers, whatever the answer."""

    ask: Text
    yes: tuple[Topic, ...] = Field(min_length=1)
    no: tuple[Topic, ...] = Field(min_length=1)


class Questions(CatalogModel):
    """What is asked where no layer is certain: that between the first two layers, or the first of several of a layer.

    Args:
        narrowing: what is asked where nothing fits.
    """

    between: tuple[Between, ...]
    deciding: tuple[Deciding, ...]
    narrowing: Narrowing


Pattern = Annotated[str, StringConstraints(min_length=3, max_length=300)]
"""A regular expression on a text in small letters, one space between words."""


class Evidence(CatalogModel):
    """What users state beside a symptom, and what it says of causes.

    Args:
        unless: patterns that turn the statement round.
        answers: pieces of questions that need not be asked.
        leaves_out: pieces of observations whose outcome is stated.
        rules_out: pieces of causes that are excluded.
        likelier: pieces of causes that come first in their symptom.
        strengthens, weakens: names of symptoms.
        clears: layers of which something works, so that their symptoms are less likely.
    """

    stated: Text
    says: tuple[Pattern, ...] = Field(min_length=1)
    unless: tuple[Pattern, ...] = ()
    answers: tuple[Text, ...] = ()
    leaves_out: tuple[Text, ...] = ()
    rules_out: tuple[Text, ...] = ()
    likelier: tuple[Text, ...] = ()
    strengthens: tuple[Text, ...] = ()
    weakens: tuple[Text, ...] = ()
    clears: tuple[Topic, ...] = ()


class EvidenceTable(CatalogModel):
    """All statements that are understood."""

    evidence: tuple[Evidence, ...]


class OsError(CatalogModel):
    """An error of the operating system, and which symptom it is on which kind of object.

    Args:
        texts: as ``strerror`` gives them, in small letters.
        means: kind of object → name of a symptom; ``other`` where no kind fits.
    """

    numbers: tuple[int, ...]
    names: tuple[Token, ...]
    texts: tuple[Text, ...]
    means: dict[Token, Text]


class SystemErrors(CatalogModel):
    """Errors of the operating system, and the words by which the object of a call is known: kind → words."""

    kinds: dict[Token, tuple[Text, ...]]
    errors: tuple[OsError, ...]


@cache
def knowledge() -> tuple[LayerKnowledge, ...]:
    """Return every layer, in the order in which they are ruled out.

    Raises:
        ValueError: a file of the package is not what its model says; tests hold that none is.
    """
    return tuple(read_table(f"symptoms/{name}.yaml", LayerKnowledge) for name in LAYERS)


@cache
def synonyms() -> Synonyms:
    """Return which words mean the same.

    Raises:
        ValueError: as ``knowledge``.
    """
    return read_table("symptoms/words.yaml", Synonyms)


@cache
def questions() -> Questions:
    """Return what is asked where no layer is certain.

    Raises:
        ValueError: as ``knowledge``.
    """
    return read_table("symptoms/questions.yaml", Questions)


@cache
def evidence() -> EvidenceTable:
    """Return what statements of users say of causes.

    Raises:
        ValueError: as ``knowledge``.
    """
    return read_table("symptoms/evidence.yaml", EvidenceTable)


@cache
def system_errors() -> SystemErrors:
    """Return what errors of the operating system mean.

    Raises:
        ValueError: as ``knowledge``.
    """
    return read_table("symptoms/errors.yaml", SystemErrors)


def small_letters(text: str) -> str:
    """Return a text in small letters on one line, with straight apostrophes, as the patterns of the tables have it."""
    return " ".join(text.casefold().replace("’", "'").split())


def read_table(file: str, model: type[_ModelT]) -> _ModelT:
    """Return a file of the catalog.

    Raises:
        ValueError: it is not what its model says.
    """
    compiled = compiled_table(file)
    if compiled is not None:
        return model.model_validate_json(compiled)
    from cellc.compiler.catalog.read_model import read_model

    read = read_model(CATALOG / file, file, model)
    if read.value is None:
        raise ValueError("; ".join(f"{diagnostic.span}: {diagnostic.message}" for diagnostic in read.diagnostics))
    return read.value[0]
