"""The xacro library with its exits from the description's folder closed.

xacro keeps its functions and its state in module globals, so the closing is done there and undone afterwards: files are
read under one root only, ``$(…)`` knows ``arg``, ``find`` and ``dirname``, expressions go through our interpreter, and
macros, includes and elements are counted.
"""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any
from xml.dom import minidom

import xacro

from cellc.contract.diagnostics import Span
from cellc.contract.limits import limits, option
from cellc.robot.description.packages import find_package, searched_folders
from cellc.robot.description.xacro_expression import evaluate
from cellc.robot.description.xacro_files import ConfinedFiles, XacroRefusedError
from cellc.robot.description.xacro_names import known_names, names_of_eval
from cellc.robot.description.xml_tree import XmlElement, read_xml

_PLACE = "cellc-place"
_SUBSTITUTION = re.compile(r"\$\((\w+)\s*(.*?)\s*\)", re.DOTALL)


class Confinement:
    """What xacro calls instead of its own functions during one expansion, and what was seen on the way."""

    def __init__(self, root: str, shown_root: str | None = None, beside: Sequence[str] = ()) -> None:
        self.root = root
        self.files = ConfinedFiles(root, shown_root, beside)
        self._beside = tuple(beside)
        self.warnings: list[str] = []
        self.known_arguments: set[str] = set()
        self.macros: dict[str, Span] = {}
        self.elements = 0
        self.failure: BaseException | None = None
        self.place: Span | None = None
        self.called = ""
        self.unprefixed = ""
        self._touched: Any = None
        self._packages: dict[str, str] = {}

    @contextmanager
    def installed(self) -> Iterator[None]:
        """Replace xacro's functions for the time of one expansion."""
        hooks: dict[str, Any] = {
            "parse": self.parse,
            "safe_eval": lambda text, symbols, _locals=None: evaluate(text, symbols),
            "eval_extension": self.substitute,
            "eval_text": _skipping_plain_text(xacro.eval_text),
            "get_include_files": self.include_files,
            "eval_all": self._counted(xacro.eval_all),
            "handle_macro_call": self._located(xacro.handle_macro_call),
            "process_include": self._located(xacro.process_include),
            "grab_property": self._located(xacro.grab_property),
            "check_attrs": self._touching(xacro.check_attrs),
            "warning": lambda *texts, **_options: self.warnings.append(" ".join(map(str, texts))),
            "print_location": lambda: None,
            "_global_symbols": known_names(self._xacro_functions()),
        }
        originals = {name: getattr(xacro, name) for name in hooks}
        _set_all(hooks)
        try:
            yield
        finally:
            _set_all(originals)

    def parse(self, document: Any, filename: str | None = None) -> Any:
        """Read a file under the root into a DOM whose elements know their place."""
        if document is not None or filename is None:
            return document
        try:
            text = self.files.read(filename)
        except XacroRefusedError:
            xacro.filestack.pop()  # xacro's own reader does so, lest the missing file is named as the place
            raise
        parsed = read_xml(text, self.files.shown(filename))
        if parsed.value is None:
            problem = parsed.diagnostics[0]
            raise XacroRefusedError(problem.code, problem.message, problem.help, problem.span)
        dom = minidom.parseString(text)
        _set_places(dom.documentElement, parsed.value)
        for macro in dom.getElementsByTagName("xacro:macro"):
            place = place_of(macro)
            if place is not None:
                self.macros[macro.getAttribute("name").removeprefix("xacro:")] = place
        return dom

    def include_files(self, specification: str, symbols: Any) -> Iterator[str]:
        """Yield the files of one ``<xacro:include>``, wildcards in sorted order."""
        if len(xacro.filestack) > limits().xacro_includes:
            message = f"includes are nested deeper than {limits().xacro_includes} files"
            raise XacroRefusedError("xacro-too-large", message, "look for a file that includes itself")
        path = self.path_of(str(xacro.eval_text(specification, symbols)))
        wildcard = re.search(r"[*?\[]", path)
        if wildcard is None:
            yield path
            return
        fixed = os.path.dirname(path[: wildcard.start()])
        outside = ".." in path[len(fixed) :].split("/") or not self.files.holds(fixed or ".")
        # What a pattern matches elsewhere is not even looked for: which files a machine has is private.
        files = [] if outside else sorted(glob.glob(path))
        if outside or not all(map(self.files.holds, files)):
            message = f"`{specification[:200]}` reaches for files outside of `{self.files.shown(self.files.root)}`"
            raise XacroRefusedError("xacro-outside-root", message, "copy the files beside the description")
        if not files:
            self.warnings.append(f"`{specification}` matches no file")
        yield from files

    def substitute(self, text: str) -> Any:
        """Resolve ``$(…)`` of ``arg``, ``find``, ``dirname`` and ``eval``; the rest reaches out of the description."""
        match = _SUBSTITUTION.fullmatch(text)
        command, operand = (match[1], match[2]) if match else (text, "")
        if command == "arg":
            return self.argument(operand)
        if command == "find":
            return self.package(operand)
        if command == "dirname":
            return os.path.dirname(xacro.filestack[-1]) or "."
        if command == "eval":
            return str(evaluate(operand, {**self._typed_arguments(), **names_of_eval()}))
        if command == "optenv" and operand:
            return self._without_environment(*operand.split())
        raise XacroRefusedError(
            "xacro-refused-substitution",
            f"`{text[:60]}` is refused: a description may not depend on its surroundings",
            "use `$(arg NAME)`, `$(find PACKAGE)`, `$(dirname)`, `$(eval …)` or `${…}`",
        )

    def _without_environment(self, name: str, *default: str) -> str:
        """Return the default of a variable of the environment: no description may depend on the machine."""
        value = " ".join(default)
        message = f"`$(optenv {name})` is read as its default `{value}`: variables of the environment count for nothing"
        if message not in self.warnings:
            self.warnings.append(message)
        return value

    def _typed_arguments(self) -> dict[str, Any]:
        """Return the arguments as numbers and truths where they are written so, as roslaunch's ``eval`` has them."""
        given: Mapping[str, str] = xacro.substitution_args_context["arg"]
        return {name: _typed(value) for name, value in given.items()}

    def in_packages(self, filename: str) -> str:
        """Name a file as ``package://`` that the description names by the folder of a package that it found.

        The folder is one of this machine, or relative to it; ``file:///$(find PACKAGE)`` is how some vendors write it.
        """
        path = filename.removeprefix("file://")
        for name, folder in sorted(self._packages.items()):
            for prefix in (folder, f"/{folder}"):
                if path.startswith(f"{prefix}/"):
                    return f"package://{name}{path[len(prefix) :]}"
        return filename

    def argument(self, name: str) -> str:
        """Return the value of a xacro argument."""
        arguments: Mapping[str, str] = xacro.substitution_args_context["arg"]
        self.known_arguments.add(name)
        if name not in arguments:
            help_text = f"give it: `{name}:=VALUE` after `cellc import FILE`, or under `arguments:` in `device.yaml`"
            raise XacroRefusedError("xacro-missing-argument", f"argument `{name}` has no value", help_text)
        return arguments[name]

    def package(self, name: str) -> str:
        """Return the folder of a package that lies under the root or beside it."""
        folder = find_package(name, self.root, *self._beside)
        if folder is None:
            places = ", ".join(f"`{place}`" for place in searched_folders(name, self.root))
            raise XacroRefusedError(
                "xacro-package-not-found",
                f"package `{name}` is not found",
                f"put it in one of {places}, or name its folder in `packages:` of the spec or with `--package-path`",
            )
        self._packages[name] = folder
        return folder

    def path_of(self, name: str) -> str:
        """Return where a file lies that a description names: beside the file that does, or in a package it found.

        Where the root is a relative path, so is that of a package, and both count from the current folder.
        """
        in_package = any(name.startswith(f"{folder}/") for folder in self._packages.values())
        return name if in_package else str(xacro.abs_filename_spec(name))

    def _xacro_functions(self) -> dict[str, Any]:
        def fatal(*texts: object) -> None:
            raise XacroRefusedError("xacro-failed", " ".join(map(str, texts)))

        def tell(*texts: object, **_options: object) -> str:
            self.warnings.append(" ".join(map(str, texts)))
            return ""

        return {
            "arg": self.argument,
            "load_yaml": lambda name: self.files.load_yaml(self.path_of(name)),
            "abs_filename": lambda name: self.files.checked(self.path_of(name)),
            "dotify": dict,
            "fatal": fatal,
            "warning": tell,
            "error": tell,
            "message": lambda *_texts, **_options: "",
            "print_location": lambda: "",
            "tokenize": xacro.tokenize,
        }

    def _counted(self, original: Callable[..., Any]) -> Callable[..., Any]:
        located = self._located(original)
        most = limits()

        def eval_all(node: Any, macros: Any, symbols: Any) -> Any:
            self.elements += 1
            if self.elements > most.xacro_elements:
                message = f"the expansion has more than {most.xacro_elements} elements"
                raise XacroRefusedError("xacro-too-large", message, option("xacro-elements"))
            if len(xacro.macrostack) > most.xacro_macros:
                message = f"macros call each other deeper than {most.xacro_macros} levels"
                raise XacroRefusedError("xacro-too-large", message, "look for a macro that calls itself")
            return located(node, macros, symbols)

        return eval_all

    def _located(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def located(node: Any, *arguments: Any) -> Any:
            try:
                return original(node, *arguments)
            except Exception as error:
                # The innermost call comes here first; outer ones see the same exception again.
                if self.failure is not error:
                    self.failure = error
                    self.called = str(node.tagName).removeprefix("xacro:")
                    self.unprefixed = _unprefixed(node)
                    inner = self._touched if getattr(self._touched, "parentNode", None) is node else node
                    self.place = place_of(inner) or place_of(node)
                raise

        return located

    def _touching(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def check_attrs(node: Any, *arguments: Any) -> Any:
            self._touched = node
            if node.tagName == "xacro:arg":
                self.known_arguments.add(node.getAttribute("name"))
            return original(node, *arguments)

        return check_attrs


def _unprefixed(node: Any) -> str:
    """Return the tag around a node that is one of xacro without its prefix: what xacro 1 still took for its own."""
    while node is not None and node.nodeType == minidom.Node.ELEMENT_NODE:
        if node.tagName in ("macro", "property", "if", "unless"):
            return str(node.tagName)
        node = node.parentNode
    return ""


def _typed(value: str) -> Any:
    try:
        return float(value) if "." in value else int(value)
    except ValueError:
        return {"true": True, "false": False}.get(value.lower(), value)


def place_of(node: Any) -> Span | None:
    """Return where a DOM element was written, also for copies that macros made of it."""
    place = node.getUserData(_PLACE) if hasattr(node, "getUserData") else None
    return place if isinstance(place, Span) else None


def _skipping_plain_text(original: Callable[..., Any]) -> Callable[..., Any]:
    # Most texts hold no expression; not lexing them takes a third off an expansion.
    return lambda text, symbols: original(text, symbols) if "$" in text else text


def _set_all(attributes: Mapping[str, Any]) -> None:
    for name, value in attributes.items():
        setattr(xacro, name, value)


class _KeepPlace:
    """Carries the place to the copies of a node (DOM Level 3, UserDataHandler)."""

    def handle(self, operation: int, key: str, data: object, source: Any, copy: Any) -> None:
        if copy is not None:
            copy.setUserData(key, data, self)


_KEEP_PLACE = _KeepPlace()


def _set_places(node: Any, element: XmlElement) -> None:
    node.setUserData(_PLACE, element.span, _KEEP_PLACE)
    children = [child for child in node.childNodes if child.nodeType == minidom.Node.ELEMENT_NODE]
    for child, inner in zip(children, element.children, strict=True):
        _set_places(child, inner)
