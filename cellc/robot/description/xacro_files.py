"""The files that an expansion may read: regular ones under one folder, or in the package path, and of bounded size.

The ament index of the machine is left out on purpose: what is built must depend on what lies beside the spec and on
what the call names, and an untrusted description must not reach the packages of the machine.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from cellc.contract.diagnostics import Span, did_you_mean
from cellc.contract.limits import MIB, limits, option
from cellc.contract.store.regular_file import open_regular
from cellc.robot.description.packages import lies_under, package_path, repository_of
from cellc.robot.description.xacro_expression import evaluate
from cellc.robot.description.xacro_names import known_names
from cellc.robot.description.yaml_values import TooManyValuesError, load_values

if TYPE_CHECKING:

    class XacroError(Exception):
        """The error of xacro 2, which has no types: texts, and the error behind it."""

        def __init__(self, *texts: object, exc: BaseException | None = None) -> None: ...

else:
    from xacro import XacroException as XacroError

_UNITS = {
    "!radians": 1.0,
    "!degrees": math.pi / 180.0,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}  # the tags that xacro gives to values in YAML


class XacroRefusedError(XacroError):
    """Ends an expansion with a code of ours; ``span`` where the place is not that of the element in work."""

    def __init__(
        self, code: str, message: str, help_text: str = "", span: Span | None = None, cause: OSError | None = None
    ) -> None:
        # xacro looks for an OSError in `exc` to know that an optional include is merely absent.
        super().__init__(message, exc=cause)
        self.code, self.message, self.help_text, self.span = code, message, help_text, span


class ConfinedFiles:
    """Reads under ``root``; links are resolved before the comparison.

    ``shown_root`` represents it in messages, and ``beside`` are further folders of packages that the spec names.
    """

    def __init__(self, root: str, shown_root: str | None = None, beside: Sequence[str] = ()) -> None:
        self.root = root
        self._roots = (root, *beside)
        self._within = repository_of(root)
        self._shown_root = shown_root
        self._bytes_read = 0

    def holds(self, path: str) -> bool:
        """Whether a path lies under the root or in a folder beside it, links followed."""
        # A path that is written out of the root is out of it; a link may lead to another folder of the repository.
        absolute = os.path.abspath(path)
        if any(f"{absolute}{os.sep}".startswith(f"{os.path.abspath(folder)}{os.sep}") for folder in package_path()):
            return True  # the caller chose it, and links to a workspace are usual there
        return any(
            lies_under(path, root)
            or (f"{absolute}{os.sep}".startswith(f"{os.path.abspath(root)}{os.sep}") and lies_under(path, self._within))
            for root in self._roots
        )

    def checked(self, path: str) -> str:
        """Return ``path`` unless it leads out of the root."""
        if not self.holds(path):
            raise XacroRefusedError(
                "xacro-outside-root",
                f"`{path[:200]}` leads out of the folder `{self.shown(self.root)}`",
                "copy the file beside the description",
            )
        return path

    def shown(self, path: str) -> str:
        """Return a path as diagnostics show it."""
        if self._shown_root is not None:
            path = os.path.join(self._shown_root, os.path.relpath(path, self.root))
        return os.path.normpath(path).replace(os.sep, "/")

    def read(self, path: str) -> str:
        """Return the text of a file."""
        self.checked(path)
        if not os.path.isfile(path):
            missing = FileNotFoundError(path)
            message = f"`{self.shown(path)}` is not a file"
            raise XacroRefusedError("xacro-file-not-found", message, self._instead_of(path), cause=missing)
        data = self._read_bytes(path)
        try:
            return data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            message = f"`{self.shown(path)}` is not UTF-8 text (byte {error.start})"
            raise XacroRefusedError("xacro-not-text", message, "save it as UTF-8") from None

    def _instead_of(self, path: str) -> str:
        """Write the help for a file that is not there: what its folder holds that looks like it."""
        folder, name = os.path.split(path)
        if not os.path.isdir(folder or "."):
            return f"there is no folder `{self.shown(folder)}`"
        names = os.listdir(folder or ".")
        alike = [file for file in names if file.partition(".")[0] == name.partition(".")[0]]
        return did_you_mean(name, alike or names, f"files in `{self.shown(folder)}`")

    def _read_bytes(self, path: str) -> bytes:
        remaining = limits().xml_bytes - self._bytes_read
        try:
            with open_regular(Path(path)) as file:
                data = file.read(remaining + 1)
        except OSError as error:
            message = f"`{self.shown(path)}` cannot be read: {error.strerror}"
            raise XacroRefusedError("xacro-file-not-found", message, cause=error) from None
        if len(data) > remaining:
            message = f"the files are larger than {limits().xml_bytes // MIB} MiB together"
            raise XacroRefusedError("xacro-too-large", message, option("xml-bytes"))
        self._bytes_read += len(data)
        return data

    def load_yaml(self, path: str) -> Any:
        """Read a YAML file of parameters, as ``xacro.load_yaml`` does, with aliases as far as the limits go."""
        text = self.read(path)
        shown = self.shown(path)
        if len(text) > limits().xacro_yaml_bytes:
            message = f"`{shown}` is larger than {limits().xacro_yaml_bytes // MIB} MiB"
            raise XacroRefusedError(
                "xacro-too-large", message, "move what the description does not use to another file"
            )
        try:
            return load_values(text, _UnitLoader)
        except TooManyValuesError as error:
            raise XacroRefusedError("xacro-bad-yaml", f"`{shown}` {error}") from None
        except (yaml.YAMLError, ValueError, RecursionError) as error:
            reason = str(error).split("\n", 1)[0]
            raise XacroRefusedError("xacro-bad-yaml", f"`{shown}` is not readable YAML: {reason}") from None


class _UnitLoader(yaml.SafeLoader):
    """SafeLoader that knows xacro's unit tags."""


def _with_unit(loader: yaml.SafeLoader, suffix: str, node: yaml.Node) -> float:
    if not isinstance(node, yaml.ScalarNode) or f"!{suffix}" not in _UNITS:
        raise yaml.constructor.ConstructorError(None, None, f"unknown tag `!{suffix}`", node.start_mark)
    return float(evaluate(str(node.value), known_names())) * _UNITS[f"!{suffix}"]


_UnitLoader.add_multi_constructor("!", _with_unit)
