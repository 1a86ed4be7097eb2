"""``cellc completion``: the script that makes a shell complete cellc's commands."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from cellc.printing import show_document


@click.command()
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    """Print the completion script of SHELL; add `eval "$(cellc completion bash)"` to its start-up file.

    \b
    cellc completion bash
    cellc completion fish > ~/.config/fish/completions/cellc.fish
    """
    complete = get_completion_class(shell)
    assert complete is not None
    show_document(complete(context.find_root().command, {}, "cellc", "_CELLC_COMPLETE").source())
