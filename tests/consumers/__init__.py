"""Emitted packages against the programs that read them, without a line of cellc's own understanding of them."""
