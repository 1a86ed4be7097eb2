"""Changes of URDF, xacro and SRDF: elements, attributes, references, expressions."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable, Sequence
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from tests.robustness.fuzz.hostile import NUMBERS, TEXTS

XACRO = "http://www.ros.org/wiki/xacro"
_TAGS = (
    "link", "joint", "collision", "geometry", "mesh", "mimic", "limit", "origin", "transmission", "ros2_control",
    "gazebo", "robot", "x", "material", "safety_controller",
)  # fmt: skip
_ATTRIBUTES = (
    "name", "type", "link", "xyz", "rpy", "lower", "upper", "velocity", "effort", "value", "radius", "length", "size",
    "filename", "scale", "joint", "multiplier", "offset", "x",
)  # fmt: skip
_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical", "")
_EXPRESSIONS = (
    "${1/0}", "${2**99999}", "${'a'*10**9}", "${[0]*10**9}", "${x}", "${size}", "${__import__('os')}",
    "${().__class__}", "${open('/etc/passwd')}", "${1e308*10}", "${pi/0.0}", "${float('nan')}", "${range(10**12)}",
    "${list(range(10**8))}", "${len(range(10**9))}", "${'%s' % xacro}", "${xacro.load_yaml('facts.yaml')}",
    "${xacro.load_yaml('../../x')}", "${lambda: 0}", "${[x for x in range(3)]}", "${-}", "${", "${}}",
    "${(((((1)))))}", "${" + "(" * 300 + "1" + ")" * 300 + "}", "${" + "-" * 3000 + "1}", "${" + "1+" * 3000 + "1}",
    "${sin(1e300)}", "${sqrt(-1)}", "${int('9'*5000)}", "${10**5000}", "${'{0.__class__}'.format(1)}",
    "${dict(a=1)['b']}", "${1 if True else x}", "${radians(1e400)}", "${'x'.join(['y']*9999)}", "$(arg size)",
    "$(arg none)", "$(find demo)", "$(find ..)", "$(env HOME)", "$(eval 1)", "$(dirname)", "$(optenv A b)",
    "$(anon x)", "$$(arg x)", "$${x}", "$(arg $(arg size))",
)  # fmt: skip
_SNIPPETS = (
    '<xacro:include filename="robot.xacro"/>', '<xacro:include filename="/etc/passwd"/>',
    '<xacro:include filename="*.xacro"/>', '<xacro:include filename="part.xacro"/>',
    '<xacro:include filename="none.xacro"/>', '<xacro:include filename="part.xacro" ns="p"/>',
    '<xacro:macro name="again" params="n"><xacro:again n="${n}"/></xacro:macro>',
    '<xacro:macro name="twice" params="n"><xacro:if value="${n > 0}"><xacro:twice n="${n-1}"/><xacro:twice n="${n-1}"/>'
    '</xacro:if><link name="l${n}"/></xacro:macro>',
    '<xacro:again n="1"/>', '<xacro:twice n="30"/>', '<xacro:twice n="4"/>',
    '<xacro:property name="x" value="${x}${x}"/>', '<xacro:property name="x" value="${y}"/>',
    '<xacro:property name="y" value="${x}"/>', '<xacro:property name="x" default="1" scope="global"/>',
    '<xacro:property name="b"><link name="q"/></xacro:property>', '<xacro:insert_block name="b"/>',
    '<xacro:insert_block name="none"/>', '<xacro:if value="maybe"><link name="z"/></xacro:if>',
    '<xacro:unless value="${0}"/>', '<xacro:arg name="size"/>', '<xacro:arg name="size" default="2"/>',
    '<xacro:call macro="leg"/>', '<xacro:leg/>', '<xacro:leg name="a" parent="base" size="${10**400}"/>',
    '<xacro:element xacro:name="link"/>', '<xacro:attribute name="x" value="1"/>', '<xacro:unknown/>',
)  # fmt: skip


class XmlMutator:
    """Changes one XML document; ``others`` are documents that parts are taken from."""

    def __init__(self, root: Element, others: Sequence[Element], chance: random.Random, *, xacro: bool) -> None:
        self.root, self._others, self._chance = root, others, chance
        self._xacro = xacro
        ElementTree.register_namespace("xacro", XACRO)

    def mutate(self, times: int) -> str:
        """Change the document so many times, and return its text."""
        changes: list[Callable[[], None]] = (
            [self._attribute] * 4 + [self._refer] * 4 + [self._number] * 4 + [self._out] * 2
        )
        changes += [self._doubled, self._moved, self._spliced, self._tag, self._new_attribute, self._text, self._turned]
        if self._xacro:
            changes += [self._expression, self._snippet] * 5
        for _ in range(times):
            self._chance.choice(changes)()
        if self._chance.random() < 0.03:
            self._chance.choice((self._deep, self._crowd))()
        return ElementTree.tostring(self.root, encoding="unicode")

    def _any(self) -> Element:
        return self._chance.choice(list(self.root.iter()))

    def _parent_and_child(self) -> tuple[Element, Element] | None:
        found = [(parent, child) for parent in self.root.iter() for child in parent]
        return self._chance.choice(found) if found else None

    def _attributes(self, *names: str) -> list[tuple[Element, str]]:
        return [(element, key) for element in self.root.iter() for key in element.attrib if not names or key in names]

    def _attribute(self) -> None:
        if found := self._attributes():
            element, key = self._chance.choice(found)
            choice = self._chance.random()
            element.set(key, self._chance.choice(NUMBERS if choice < 0.4 else _TYPES if choice < 0.5 else TEXTS))

    def _refer(self) -> None:
        """Let a name be another one of the document."""
        found = self._attributes("link", "name", "joint", "type", "xacro:name")
        if found:
            element, key = self._chance.choice(found)
            other, other_key = self._chance.choice(found)
            element.set(key, other.attrib[other_key])

    def _number(self) -> None:
        found = [(one, key) for one, key in self._attributes() if _has_digit(one.attrib[key])]
        if found:
            element, key = self._chance.choice(found)
            words = element.attrib[key].split() or [""]
            words[self._chance.randrange(len(words))] = self._chance.choice((*NUMBERS, "nan", "inf", "-inf", "x"))
            element.set(key, " ".join(words))

    def _out(self) -> None:
        if (found := self._parent_and_child()) is None:
            return
        parent, child = found
        if self._chance.random() < 0.4 and child.attrib:
            del child.attrib[self._chance.choice(list(child.attrib))]
        else:
            parent.remove(child)

    def _doubled(self) -> None:
        if (found := self._parent_and_child()) is not None:
            parent, child = found
            parent.insert(self._chance.randrange(len(parent) + 1), copy.deepcopy(child))

    def _moved(self) -> None:
        if (found := self._parent_and_child()) is not None:
            parent, child = found
            parent.remove(child)
            self._any().append(child)

    def _spliced(self) -> None:
        other = self._chance.choice(list(self._chance.choice(self._others).iter()))
        if len(list(other.iter())) < 200:
            self._any().append(copy.deepcopy(other))

    def _tag(self) -> None:
        self._any().tag = self._chance.choice(_TAGS)

    def _new_attribute(self) -> None:
        self._any().set(self._chance.choice(_ATTRIBUTES), self._chance.choice(NUMBERS + TEXTS))

    def _text(self) -> None:
        self._any().text = self._chance.choice(TEXTS)

    def _turned(self) -> None:
        """Turn the tree of links: let a parent be its own child, or a child the root."""
        links = [
            element for element in self.root.iter() if element.tag in ("parent", "child") and "link" in element.attrib
        ]
        names = [link.get("name", "") for link in self.root.iter("link")]
        if links and names:
            self._chance.choice(links).set("link", self._chance.choice(names))

    def _expression(self) -> None:
        if found := self._attributes():
            element, key = self._chance.choice(found)
            element.set(key, self._chance.choice(_EXPRESSIONS))

    def _snippet(self) -> None:
        piece = self._chance.choice(_SNIPPETS)
        wrapped = ElementTree.fromstring(f'<w xmlns:xacro="{XACRO}">{piece}</w>')
        holder = self.root if self._chance.random() < 0.7 else self._any()
        holder.insert(self._chance.randrange(len(holder) + 1), wrapped[0])

    def _deep(self) -> None:
        element = self._any()
        for _ in range(self._chance.choice((10, 63, 64, 100, 400))):
            element = ElementTree.SubElement(element, self._chance.choice(_TAGS))

    def _crowd(self) -> None:
        parent, child = self._parent_and_child() or (self.root, self.root)
        size = self._chance.choice((50, 200)) if parent is not child else 0
        for number in range(size):
            another = copy.deepcopy(child)
            if "name" in another.attrib and self._chance.random() < 0.9:
                another.set("name", f"{another.get('name')}_{number}")
            parent.append(another)


def _has_digit(text: str) -> bool:
    return any(character.isdigit() for character in text)
