"""The gates of bring-up as checklists, part by part."""
