"""The mutants of a source file: one small change of what it does, each with its line and its replacement.

Changed are comparisons, conditions, ``and`` and ``or``, arithmetic, signs, figures and truth values, ``min`` and
``max``, the order of two arguments, calls for their effect, and what a function returns. Left out is what no test can
see: texts, f-strings, docstrings, annotations, decorators, asserts, ``__all__`` and its kind, what
is asked of the platform, keywords that only forbid (``strict``, ``frozen``, ``slots``, ``repr``), and the order of what
a symmetric function takes.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
_BOUNDARY: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
}  # fmt: skip
_ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult,
}  # fmt: skip
_DEFAULTS = {"bool": "False", "int": "0", "float": "0.0", "str": "''", "tuple": "()", "list": "[]", "dict": "{}"}
_TEXT = (ast.JoinedStr, ast.List, ast.Tuple)
_FORBIDDING = {"strict", "frozen", "slots", "repr"}
_AS_THEY_ARE = {"isinstance", "issubclass", "cast", "dist", "gcd", "hypot", "isclose", "maximum", "minimum", "suppress"}
"""Calls whose first two arguments no test can tell apart, or whose order mypy holds."""
_NAMES = {"__all__", "__slots__", "model_config"}
_PLATFORM = ("TYPE_CHECKING", "__name__", "sys.platform", "sys.version_info", "os.name")


Function = ast.FunctionDef | ast.AsyncFunctionDef
Around = tuple[ast.stmt, ...]


@dataclass(frozen=True)
class Mutant:
    """One change: the text between two places of a file becomes another; offsets count UTF-8."""

    file: str
    line: int
    begin: int
    end: int
    kind: str
    text: str
    instead: str
    statements: tuple[int, ...]
    """The lines of the statements around it, the innermost first; none for what an import evaluates."""

    @property
    def name(self) -> str:
        """Where it is and what it does, on one line."""
        was, becomes = (" ".join(text.split()) for text in (self.text, self.instead))
        return f"{self.file}:{self.line} {self.kind}: {was[:90]} -> {becomes[:90]}"

    def applied(self, source: bytes) -> bytes:
        """Return the file with the change."""
        return source[: self.begin] + self.instead.encode() + source[self.end :]


def mutants_of(file: Path, root: Path) -> list[Mutant]:
    """Return every mutant of a file, in order of lines."""
    source = file.read_bytes()
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    found = []
    tree = ast.parse(source)
    asked = {id(condition) for node in ast.walk(tree) for condition in _conditions(node)}
    for node, around in _decisions(tree, ()):
        begin = starts[node.lineno - 1] + node.col_offset
        end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
        text = source[begin:end].decode()
        negated = [("condition", ast.UnaryOp(ast.Not(), node))] if id(node) in asked else []
        for kind, instead in (*negated, *_changes(node, around)):
            if ast.unparse(instead) != ast.unparse(node):
                written = ast.unparse(instead) if isinstance(instead, ast.stmt) else f"({ast.unparse(instead)})"
                lines = tuple(_first_line(node) for node in reversed(around))
                name = file.relative_to(root).as_posix()
                found.append(Mutant(name, node.lineno, begin, end, kind, text, written, lines))
    return sorted(found, key=lambda one: (one.begin, one.end, one.kind))


def _conditions(node: ast.AST) -> list[ast.expr]:
    """Return what a statement asks, where no other change is one of it already."""
    asked = [node.test] if isinstance(node, (ast.If, ast.IfExp, ast.While)) else getattr(node, "ifs", [])
    return [node for node in asked if isinstance(node, (ast.Name, ast.Attribute, ast.Call, ast.Subscript))]


def _decisions(node: ast.AST, around: Around) -> Iterator[tuple[ast.expr | ast.stmt, Around]]:
    """Walk what decides something, with the statements around it, from its function inwards."""
    if isinstance(node, (ast.JoinedStr, ast.Assert, ast.Raise, ast.pattern, ast.arg)) or _is_declaration(node):
        return
    function = isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    inside = (*around, node) if isinstance(node, ast.stmt) and (around or function) else around
    if isinstance(node, (ast.expr, ast.stmt)):
        yield node, inside
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "decorator_list", "returns"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and not (isinstance(child, ast.keyword) and child.arg in _FORBIDDING):
                yield from _decisions(child, around if function and name == "args" else inside)


def _is_declaration(node: ast.AST) -> bool:
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
        return node.targets[0].id in _NAMES
    if isinstance(node, (ast.If, ast.IfExp)):
        return any(word in ast.unparse(node.test) for word in _PLATFORM)
    return isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id == "Literal"


def _changes(node: ast.expr | ast.stmt, around: Around) -> Iterator[tuple[str, ast.expr | ast.stmt]]:
    if isinstance(node, ast.Compare):
        operator = type(node.ops[0])
        yield "comparison", _with(node, ops=[_OPPOSITE[operator](), *node.ops[1:]])
        if operator in _BOUNDARY:
            yield "boundary", _with(node, ops=[_BOUNDARY[operator](), *node.ops[1:]])
    elif isinstance(node, ast.BoolOp):
        yield "and-or", _with(node, op=ast.Or() if isinstance(node.op, ast.And) else ast.And())
    elif isinstance(node, ast.BinOp):
        if type(node.op) in _ARITHMETIC and not any(map(_is_text, (node.left, node.right))):
            yield "arithmetic", _with(node, op=_ARITHMETIC[type(node.op)]())
    elif isinstance(node, ast.UnaryOp):
        if isinstance(node.op, ast.Not):
            yield "not", node.operand
        elif isinstance(node.op, ast.USub):
            yield "sign", node.operand
    elif isinstance(node, ast.Constant):
        yield from _figures(node)
    elif isinstance(node, ast.Call):
        yield from _calls(node)
    elif isinstance(node, (ast.Expr, ast.AugAssign, ast.Return)):
        yield from _statements(node, around)


def _figures(node: ast.Constant) -> Iterator[tuple[str, ast.expr]]:
    if isinstance(node.value, bool):
        yield "truth", ast.Constant(not node.value)
    elif isinstance(node.value, (int, float)):
        yield "figure", ast.Constant(node.value + 1)
        yield "figure", ast.Constant(node.value - 1)


def _calls(node: ast.Call) -> Iterator[tuple[str, ast.expr]]:
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    if name in ("min", "max"):
        yield "extreme", _with(node, func=ast.Name("max" if name == "min" else "min"))
    elif ast.unparse(node.func).rpartition(".")[2] not in _AS_THEY_ARE and len(node.args) > 1:
        first, second, *rest = node.args
        kinds = (ast.Name, ast.Attribute, ast.Subscript)
        if isinstance(first, kinds) and isinstance(second, kinds):
            yield "arguments", _with(node, args=[second, first, *rest])


def _statements(node: ast.Expr | ast.AugAssign | ast.Return, around: Around) -> Iterator[tuple[str, ast.stmt]]:
    if isinstance(node, ast.AugAssign):
        if type(node.op) in _ARITHMETIC and not _is_text(node.value):
            yield "arithmetic", _with(node, op=_ARITHMETIC[type(node.op)]())
    elif isinstance(node, ast.Return):
        if node.value is not None:
            returns = next((node.returns for node in reversed(around) if isinstance(node, Function)), None)
            default = _DEFAULTS.get(ast.unparse(returns).partition("[")[0], "None") if returns else "None"
            yield "return", ast.Return(ast.parse(default, mode="eval").body)
    elif isinstance(node.value, ast.Call):
        yield "effect", ast.Pass()
    elif isinstance(node.value, (ast.Yield, ast.YieldFrom)):
        yield "effect", ast.Expr(ast.YieldFrom(ast.Tuple([], ast.Load())))


def _first_line(node: ast.stmt) -> int:
    decorators: list[ast.expr] = getattr(node, "decorator_list", [])
    return decorators[0].lineno if decorators else node.lineno


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, _TEXT) or (isinstance(node, ast.Constant) and isinstance(node.value, (str, bytes)))


def _with(node: ast.expr | ast.stmt, **fields: object) -> ast.expr | ast.stmt:
    changed = copy.copy(node)
    for name, value in fields.items():
        setattr(changed, name, value)
    return changed
