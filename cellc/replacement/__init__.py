"""Replacing files of a folder all at once: made ready in a folder beside it, then moved, or every old one put back."""
