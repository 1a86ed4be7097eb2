"""Transforms over time: sources with one authority each, and a buffer that answers as tf2 does."""
