"""``cellc show``: the value that cellc uses, and its source."""

from __future__ import annotations

import click

from cellc.compiler.pipeline import check
from cellc.contract.diagnostics import did_you_mean
from cellc.contract.printing import Style, Styled, columns
from cellc.contract.printing import show as show_lines
from cellc.tools.cli.findings import linked
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.report.resolved import Leaf, Tree, flatten, resolved_tree


@click.command()
@click.argument("file", type=click.Path(path_type=str))
@click.argument("path", required=False, default="")
@limit_option
def show(file: str, path: str) -> None:
    """Show the resolved value at PATH of the cell in FILE, such as `devices.arm.joints`, and its source.

    Without PATH, list the sections.

    \b
    cellc show cells/bench/cell.yaml devices.arm.joints
    cellc show cells/bench/cell.yaml control.controllers
    """
    path = path.rstrip(".")
    tree = resolved_tree(linked(check(file)).cell)
    if not path:
        show_lines(*tree)
        return
    leaves = list(flatten(_at(tree, path), path))
    if not leaves:
        show_lines(f"`{path}` is empty")
    width = max((len(name) for name, _ in leaves), default=0)
    width = min(width, columns(2 * width) // 2)  # on a terminal the other half is for the values
    values = ((name, leaf.text or "(empty)", leaf.origin) for name, leaf in leaves)
    show_lines(*((f"{name:<{width}}  {text}", Styled(f"  # {origin}", Style.DIM)) for name, text, origin in values))


def _at(tree: Tree, path: str) -> Tree:
    """Walk down a dotted path; keys may hold dots themselves, so the longest key that fits is taken."""
    # The spec says `control` for the one controller manager that most cells have.
    rest = f"managers.{path}" if path.partition(".")[0] == "control" else path
    while rest:
        if isinstance(tree, Leaf):
            raise click.UsageError(f"`{path}` leads below a value; there is nothing at `{rest}`")
        keys = [key for key in tree if rest == key or rest.startswith(f"{key}.")]
        if not keys:
            wanted = rest.partition(".")[0]
            if not wanted:
                raise click.UsageError(f"`{path}` has an empty name beside a dot")
            above = path.removesuffix(rest).rstrip(".")
            place = f"in `{above}`" if above else "at the top of the cell"
            raise click.UsageError(f"there is no `{wanted}` {place}: {did_you_mean(wanted, tree, 'names here')}")
        key = max(keys, key=len)
        tree, rest = tree[key], rest[len(key) + 1 :]
    return tree
