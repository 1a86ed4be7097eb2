"""Mutation test of every rule: how many mutants the corpus and the page examples notice.

``python benchmarks/rule_mutants.py [--survivors] [--rule CODE]``. A mutant is one changed condition, comparison,
figure, word or yield of a rule's check, or of what its module has for it. It is killed where its findings differ by
file and line, on any case, from those of the rule as it is, which the tests hold. What only words a message is not
mutated.
"""

from __future__ import annotations

import argparse
import ast
import copy
import shutil
import sys
import tempfile
import types
from collections.abc import Container, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from cellc.compiler.graph.cell_graph import CellGraph, build_graph  # noqa: E402  the checkout comes before what is installed
from cellc.compiler.link.link import link  # noqa: E402
from cellc.compiler.rules.kit import Rule  # noqa: E402
from cellc.compiler.rules.run import ALL_RULES, rules_in  # noqa: E402
from cellc.compiler.source.read import read  # noqa: E402
from cellc.compiler.spec.parse import parse  # noqa: E402
from tests.rules import boundaries, examples, sources  # noqa: E402

_WORDING = {"message", "advice", "names", "related", "way", "chain", "allowed", "turns", "faults", "expected", "got"}
_WORDING |= {"queue", "legal", "per", "deadline", "period", "even", "age", "claimed", "needed", "written", "bounds"}
_WORDING |= {"fitting", "three"}
_WORDING_CALLS = {"join", "did_you_mean", "Related"}
_SWAPS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
Places = tuple[tuple[str, int], ...]


def mutants(tree: ast.Module) -> Iterator[tuple[str, ast.Module]]:
    """Yield each mutant of a module with its line and kind."""
    for index, node in enumerate(ast.walk(tree)):
        for kind in _kinds(node):
            changed = copy.deepcopy(tree)
            _mutate(list(ast.walk(changed))[index], kind)
            yield f"{getattr(node, 'lineno', 0)} {kind}", ast.fix_missing_locations(changed)


def _kinds(node: ast.AST) -> tuple[str, ...]:
    """Name the changes that a node admits; ``mutable`` is set unless the node is wording."""
    if not getattr(node, "mutable", False):
        return ()
    if isinstance(node, ast.Compare):
        return ("swap", "negate")
    if isinstance(node, ast.BoolOp):
        return ("and-or",)
    if isinstance(node, (ast.If, ast.IfExp)) and not isinstance(node.test, ast.Compare):
        return ("condition",)
    if isinstance(node, ast.Expr) and isinstance(node.value, (ast.Yield, ast.YieldFrom)):
        return ("no-yield",)
    if isinstance(node, (ast.Continue, ast.Break)):
        return ("go-on",)
    if isinstance(node, ast.Constant) and isinstance(node.value, (bool, int, float)):
        return ("figure",)
    return ("word",) if isinstance(node, ast.Constant) and isinstance(node.value, str) else ()


def _mutate(node: ast.AST, kind: str) -> None:
    if isinstance(node, ast.Compare):
        swap = _SWAPS[type(node.ops[0])]
        opposite = {ast.LtE: ast.Gt, ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE}
        node.ops[0] = opposite.get(type(node.ops[0]), swap)() if kind == "negate" else swap()
    elif isinstance(node, ast.BoolOp):
        node.op = ast.Or() if isinstance(node.op, ast.And) else ast.And()
    elif isinstance(node, (ast.If, ast.IfExp)):
        node.test = ast.UnaryOp(ast.Not(), node.test)
    elif isinstance(node, ast.Expr):
        node.value = ast.Constant(None)
    elif isinstance(node, (ast.Continue, ast.Break)):
        node.__class__ = ast.Pass  # type: ignore[assignment]  # one statement without fields for another
    elif isinstance(node, ast.Constant):
        node.value = _other(node.value)


def _other(value: object) -> bool | float | str:
    if isinstance(value, bool):
        return not value
    return value * 1.5 + 1 if isinstance(value, (int, float)) else f"{value}~"


def mark(tree: ast.Module, lines: Container[int]) -> None:
    """Mark the nodes that decide, apart from docstrings, annotations, messages and the declaration of the rule."""
    own = [statement for statement in tree.body if statement.lineno in lines]
    for function in (node for node in own if isinstance(node, ast.FunctionDef)):
        for statement in function.body[1:] if ast.get_docstring(function) else function.body:
            _mark(statement)
    for constant in (node for node in own if isinstance(node, ast.Assign)):
        if isinstance(constant.targets[0], ast.Name) and constant.targets[0].id.startswith("_"):
            _mark(constant.value)


def _mark(node: ast.AST) -> None:
    targets = node.targets if isinstance(node, ast.Assign) else []
    wording = any(isinstance(target, ast.Name) and target.id in _WORDING for target in targets)
    called = getattr(node.func, "attr", getattr(node.func, "id", "")) if isinstance(node, ast.Call) else ""
    if wording or called in _WORDING_CALLS or isinstance(node, (ast.JoinedStr, ast.AnnAssign)):
        return
    node.mutable = True  # type: ignore[attr-defined]  # a mark that copies keep
    if isinstance(node, ast.Yield):
        return  # a finding: its path decides the line, its texts do not
    for child in ast.iter_child_nodes(node):
        _mark(child)


def graphs(folder: Path) -> Iterator[CellGraph]:
    """Yield the graph of every case of the corpus, every example of a page and every boundary that links."""
    files = [*(ROOT / "tests/corpus/invalid").glob("*.yaml"), *(ROOT / "tests/corpus/valid").glob("*.yaml")]
    for rule in ALL_RULES:
        for number, example in enumerate(examples.examples(rule)):
            examples.diagnose_example(example, folder / rule.code / str(number))
            files.append(folder / rule.code / str(number) / "cell.yaml")
    for number, (code, fragment, _) in enumerate(boundaries.BOUNDARIES):
        examples.diagnose_example(fragment, folder / code / f"boundary_{number}")
        files.append(folder / code / f"boundary_{number}" / "cell.yaml")
    for file in files:
        document = read(file).value
        spec = None if document is None else parse(document).value
        cell = None if spec is None or document is None else link(spec, document).value
        if cell is not None:
            yield build_graph(cell)


def places(rule: Rule, graph: CellGraph) -> Places:
    """Return where a rule finds something, in order."""
    return tuple(sorted((finding.span.file, finding.span.line) for finding in rule.check(graph)))


def killed(tree: ast.Module, rule: Rule, cases: list[tuple[CellGraph, Places]]) -> bool:
    """Tell whether a mutant finds something else than its rule on any case, or fails."""
    module = types.ModuleType(rule.check.__module__)
    try:
        exec(compile(tree, rule.code, "exec"), module.__dict__)
        (mutant,) = (made for made in rules_in(module.__dict__) if made.code == rule.code)
        return any(places(mutant, graph) != due for graph, due in cases)
    except Exception:  # a mutant may raise anything, and is noticed by it
        return True


def main() -> None:
    """Print the share of mutants that are noticed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--survivors", action="store_true", help="list the mutants that nothing noticed")
    parser.add_argument("--rule", help="only this code")
    options = parser.parse_args()
    folder = Path(tempfile.mkdtemp())
    made = list(graphs(folder))
    total = noticed = 0
    for rule in ALL_RULES:
        if options.rule in (None, rule.code):
            tree = sources.module_of(rule)
            mark(tree, sources.lines_of(rule))
            cases = [(graph, places(rule, graph)) for graph in made]
            for name, mutant in mutants(tree):
                total += 1
                if killed(mutant, rule, sorted(cases, key=lambda case: not case[1])):
                    noticed += 1
                elif options.survivors:
                    print(f"{rule.code}:{name}", flush=True)
    shutil.rmtree(folder)
    print(f"{noticed} of {total} mutants of {len(ALL_RULES)} rules noticed, {noticed / total:.1%}")


if __name__ == "__main__":
    main()
