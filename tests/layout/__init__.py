"""Tests of cellc/layout: the canonical form of files."""
