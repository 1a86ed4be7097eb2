"""Hostile texts in every place of a spec, its device files and descriptions, looked for in everything that is made."""
