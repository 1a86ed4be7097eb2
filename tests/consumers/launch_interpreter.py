"""An interpreter of launch XML, written from the public grammar of ros2/launch and launch_ros.

It knows what our files may use and refuses the rest, so that a new action in an emitter must be understood here first.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, field
from xml.etree.ElementTree import Element, fromstring

from tests.consumers.launch_text import LaunchError, World, condition, expand, unescaped

_NODE = {"pkg", "exec", "name", "namespace", "output", "args", "ros_args", "respawn", "on_exit", "launch-prefix"}
_NODE |= {"if", "unless"}
_EXECUTABLE = {"name", "cmd", "output", "if", "unless"}
_OUTPUTS = {"screen", "log", "both", "own_log", "full"}


@dataclass(frozen=True, slots=True)
class Process:
    """A process that launching starts.

    Args:
        name: name of its node, None where the program's own name stays.
        namespace: empty for the root, otherwise with a leading slash.
        files: parameter files by their path in the package, in order.
        values: parameters given one by one, with the type that is forced, empty where YAML decides.
    """

    package: str
    executable: str
    name: str | None
    namespace: str
    arguments: tuple[str, ...]
    ros_arguments: tuple[str, ...]
    files: tuple[str, ...]
    values: Mapping[str, tuple[str, str]]
    remaps: Mapping[str, str]
    respawn: bool
    prefix: tuple[str, ...] = ()
    on_exit: str | None = None


@dataclass(frozen=True, slots=True)
class Command:
    """A program that is no node."""

    name: str
    words: tuple[str, ...]


@dataclass(slots=True)
class Launch:
    """One run of ``ros2 launch PACKAGE cell.launch.xml name:=value …`` on a package in memory."""

    package: str
    texts: Mapping[str, str]
    given: Mapping[str, str]
    configurations: dict[str, str] = field(default_factory=dict)
    namespace: str = ""
    processes: list[Process] = field(default_factory=list)
    commands: list[Command] = field(default_factory=list)
    of_all: dict[str, tuple[str, str]] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    descriptions: dict[str, str] = field(default_factory=dict)

    def run(self, path: str) -> Launch:
        """Interpret a file of the package; raises LaunchError where launching stops."""
        root = fromstring(self.texts[path])
        if root.tag != "launch":
            raise LaunchError(f"{path}: root is {root.tag}")
        for action in root:
            self._act(action)
        return self

    def _act(self, action: Element) -> None:
        if not self._applies(action):
            return
        known = {
            "arg": self._argument,
            "let": self._let,
            "group": self._group,
            "include": self._include,
            "push_ros_namespace": self._push,
            "node": self._node,
            "executable": self._executable,
            "set_parameter": self._set_parameter,
            "set_env": self._set_environment,
        }
        if action.tag not in known:
            raise LaunchError(f"unknown action <{action.tag}>")
        known[action.tag](action)

    def _applies(self, action: Element) -> bool:
        if "if" in action.attrib and "unless" in action.attrib:
            raise LaunchError("if and unless together")
        wanted = "unless" not in action.attrib
        text = action.get("if", action.get("unless"))
        return text is None or condition(self._text(text)) is wanted

    def _text(self, text: str) -> str:
        return expand(text, World(self.configurations, self._command))

    def _command(self, line: str) -> str:
        program, file, *arguments = shlex.split(line)
        if program not in ("xacro", "cat") or (arguments and program != "xacro"):
            raise LaunchError(f"unknown command {line}")
        if not all(":=" in argument for argument in arguments):
            raise LaunchError(f"xacro knows no {arguments}")
        given = dict(argument.split(":=", 1) for argument in arguments)
        return re.sub(r"\$\(arg (\w+)\)", lambda found: given.get(found[1], found[0]), self.texts[self._file(file)])

    def _file(self, path: str) -> str:
        """Return the path in the package of an installed file; one that it lacks stops launching."""
        share = f"/share/{self.package}/"
        inside = path.removeprefix(share)
        if not path.startswith(share) or inside not in self.texts:
            raise LaunchError(f"there is no file {path}")
        return inside

    def _argument(self, action: Element) -> None:
        name = action.attrib["name"]
        self.descriptions[name] = unescaped(action.get("description", ""))
        if name in self.given:
            value = self.given[name]
        elif name not in self.configurations and "default" not in action.attrib:
            raise LaunchError(f"required launch argument '{name}' was not provided")
        else:
            value = self.configurations.get(name, self._text(action.get("default", "")))
        choices = [unescaped(choice.attrib["value"]) for choice in action.findall("choice")]
        if choices and value not in choices:
            raise LaunchError(f"argument '{name}' is '{value}', not one of {choices}")
        self.configurations[name] = value

    def _let(self, action: Element) -> None:
        self.configurations[action.attrib["name"]] = self._text(action.attrib["value"])

    def _group(self, action: Element) -> None:
        configurations, namespace = dict(self.configurations), self.namespace
        for child in action:
            self._act(child)
        if condition(self._text(action.get("scoped", "true"))):
            self.configurations, self.namespace = configurations, namespace

    def _include(self, action: Element) -> None:
        # An include is not scoped: what it sets stays set.
        path = self._file(self._text(action.attrib["file"]))
        given = {arg.attrib["name"]: self._text(arg.attrib["value"]) for arg in action.findall("arg")}
        # IncludeLaunchDescription.execute looks at what the include itself is given, not at its parent's arguments.
        # Of several declarations of an argument the first counts there, and none that has a condition.
        declared = {argument.attrib["name"]: argument for argument in fromstring(self.texts[path]).findall("arg")[::-1]}
        for argument in declared.values():
            conditional = {"if", "unless"} & set(argument.attrib)
            if not conditional and "default" not in argument.attrib and argument.attrib["name"] not in given:
                name = argument.attrib["name"]
                raise LaunchError(f"included launch description missing required argument '{name}'")
        self.configurations |= given
        self.run(path)

    def _push(self, action: Element) -> None:
        self.namespace = self._in(self._text(action.attrib["namespace"]))

    def _in(self, namespace: str) -> str:
        below = namespace if namespace.startswith("/") else f"{self.namespace}/{namespace}"
        return below.rstrip("/")

    def _node(self, action: Element) -> None:
        if unknown := set(action.attrib) - _NODE | {child.tag for child in action} - {"param", "remap"}:
            raise LaunchError(f"<node> has unknown {sorted(unknown)}")
        if action.get("output", "log") not in _OUTPUTS:
            raise LaunchError(f"unknown output {action.get('output')}")
        parameters = action.findall("param")
        self.processes.append(
            Process(
                package=self._text(action.attrib["pkg"]),
                executable=self._text(action.attrib["exec"]),
                name=self._text(action.attrib["name"]) if "name" in action.attrib else None,
                namespace=self._in(self._text(action.get("namespace", ""))),
                arguments=self._words(action.get("args", "")),
                ros_arguments=tuple(shlex.split(self._text(action.get("ros_args", "")))),
                files=tuple(
                    self._file(self._text(parameter.attrib["from"]))
                    for parameter in parameters
                    if "from" in parameter.attrib
                ),
                values=self.of_all
                | {
                    parameter.attrib["name"]: (self._text(parameter.attrib["value"]), parameter.get("type", ""))
                    for parameter in parameters
                    if "from" not in parameter.attrib
                },
                remaps={remap.attrib["from"]: self._text(remap.attrib["to"]) for remap in action.findall("remap")},
                respawn=condition(self._text(action.get("respawn", "false"))),
                prefix=self._words(action.get("launch-prefix", "")),
                on_exit=action.get("on_exit"),
            )
        )

    def _set_parameter(self, action: Element) -> None:
        """Give a parameter to every node that follows, before its own: ``SetParameter`` of launch_ros 0.19 to 0.29."""
        if set(action.attrib) - {"name", "value", "if", "unless"}:
            raise LaunchError(f"<set_parameter> has unknown {sorted(action.attrib)}")
        self.of_all[self._text(action.attrib["name"])] = (self._text(action.attrib["value"]), "")

    def _set_environment(self, action: Element) -> None:
        """Set a variable for every process that follows: ``SetEnvironmentVariable`` of launch."""
        if set(action.attrib) - {"name", "value", "if", "unless"}:
            raise LaunchError(f"<set_env> has unknown {sorted(action.attrib)}")
        self.environment[self._text(action.attrib["name"])] = self._text(action.attrib["value"])

    def _executable(self, action: Element) -> None:
        if unknown := set(action.attrib) - _EXECUTABLE | {child.tag for child in action}:
            raise LaunchError(f"<executable> has unknown {sorted(unknown)}")
        if action.get("output", "log") not in _OUTPUTS:
            raise LaunchError(f"unknown output {action.get('output')}")
        self.commands.append(Command(self._text(action.attrib["name"]), self._words(action.attrib["cmd"])))

    def _words(self, line: str) -> tuple[str, ...]:
        """Return the words of a command; a file of the package by its path in it.

        The text is split, and what a substitution gives is not: `_parse_cmdline` of launch 3.4,
        https://github.com/ros2/launch/blob/001a398e/launch/launch/actions/execute_process.py.
        """
        share = f"/share/{self.package}/"
        values: list[str] = []

        def keep(value: str) -> str:
            values.append(value)
            return f"\0{len(values) - 1}\0"

        split = shlex.split(expand(line, World(self.configurations, self._command), keep))
        words = [re.sub("\0(\\d+)\0", lambda found: values[int(found[1])], word) for word in split]
        return tuple(self._file(word) if word.startswith(share) else word for word in words)
