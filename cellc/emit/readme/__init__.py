"""The generated package's own page, part by part."""
