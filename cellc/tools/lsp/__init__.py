"""What an editor asks of a cell while it is written, and the language server that answers (extra ``lsp``)."""
