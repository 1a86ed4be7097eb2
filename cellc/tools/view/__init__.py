"""One HTML page of a cell, without anything from outside: 3D, rehearsals played back, findings, interfaces, gates.

Python computes every pose; the page draws them, and knows no kinematics. three.js comes from the installed package that
ships it. What is written for people is in the page as elements, so that it is read without scripts.
"""
