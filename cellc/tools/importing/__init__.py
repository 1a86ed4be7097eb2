"""A robot as its vendor ships it becomes a device folder, and a first cell around it.

Nothing is guessed in silence: what the files do not say is written as UNKNOWN with its question, and told.
"""
