"""Tests of cellc/lsp: what an editor is told."""
