"""Descriptions as their vendors ship them, with constructs that are not ours."""
