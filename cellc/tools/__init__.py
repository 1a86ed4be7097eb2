"""What people and their editors call: the command line, the language server, reviews, import, pages."""
