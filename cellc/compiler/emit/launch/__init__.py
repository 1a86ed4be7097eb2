"""The launch files, part by part."""
