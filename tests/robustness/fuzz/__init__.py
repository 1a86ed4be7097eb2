"""A fuzzer that knows the structure of what it damages: specs, devices, descriptions, generated folders, the cache.

Input N of kind K is a function of (K, N) and of the documents of the repository, so that two words name a find:
``python -m tests.robustness.fuzz spec 1234 --show`` prints its files, and without ``--show`` replays it.
"""
