"""``cellc lsp``: the language server, which an editor starts and talks to over standard input and output."""

from __future__ import annotations

import logging
import sys
from contextlib import redirect_stdout

import click

from cellc.contract.extras import LSP, gate
from cellc.contract.printing import Stream, show
from cellc.tools.cli.limit_option import limit_option

_ANSWERED = -32803
"""RequestFailed of LSP 3.17: the editor has the reason."""


class _Shown(logging.Handler):
    """Shows what libraries log of messages that they cannot read: each on a line, and no traceback."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a record on standard error."""
        problem = record.exc_info[1] if record.exc_info else None
        if getattr(problem, "code", None) == _ANSWERED:
            return
        line = record.getMessage().partition("\n")[0]
        show(line if problem is None else f"{line}: {problem}", to=Stream.ERR)


@click.command()
@limit_option
def lsp() -> None:
    """Run the language server over standard input and output, until the editor ends it.

    It offers the findings of `cellc check` while you type, hover, definition, references, rename, completion, quick
    fixes, outline and formatting. docs/editor.md has the settings for VS Code, Neovim, Emacs and Helix. It needs the
    package `pygls`.

    \b
    cellc lsp                                  as an editor calls it
    """
    with gate(LSP):
        from cellc.tools.lsp.features import server
    logging.getLogger().addHandler(_Shown())
    # Nothing else may come between its messages.
    sink = Stream.OUT.opened().fileno()
    with redirect_stdout(Stream.ERR.opened()):
        server.serve(sys.stdin.fileno(), sink)
