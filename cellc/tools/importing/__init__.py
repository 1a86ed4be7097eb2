"""Creates a device folder, and a first cell around it, from a robot description as its vendor ships it.

Nothing is guessed silently: a fact that the files do not state is written as UNKNOWN with its question, and reported.
"""
