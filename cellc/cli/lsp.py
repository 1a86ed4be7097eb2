"""``cellc lsp``: the language server, which an editor starts and talks to over standard input and output."""

from __future__ import annotations

import sys
from contextlib import redirect_stdout

import click

from cellc.cli.limit_option import limit_option
from cellc.printing import Stream, refuse


@click.command()
@limit_option
def lsp() -> None:
    """Answer an editor over standard input and output, until it says goodbye.

    Findings while you type, as `cellc check` tells them; hover, definition, completion, quick fixes, outline and form.
    docs/editor.md has the settings of VS Code, Neovim, Emacs and Helix. It needs `pip install 'cellc[lsp]'`.

    \b
    cellc lsp                                  as an editor calls it
    """
    try:
        from cellc.lsp.server import server
    except ModuleNotFoundError as missing:
        if (missing.name or "").partition(".")[0] not in ("pygls", "lsprotocol"):
            raise
        refuse("the language server needs the package `pygls`; install it with `pip install 'cellc[lsp]'`")
        raise click.exceptions.Exit(2) from None
    # Nothing else may come between its messages.
    sink = Stream.OUT.opened().fileno()
    with redirect_stdout(Stream.ERR.opened()):
        server.serve(sys.stdin.fileno(), sink)
