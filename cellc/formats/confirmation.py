"""The words that release the real target and motion, as launch files ask for them and pages for people state them."""

CONFIRMATION = "I_HAVE_PASSED_GATES_G0_TO_G2"
"""Releases the real target: connecting, reading, claiming."""

MOTION_CONFIRMATION = "I_HAVE_PASSED_GATES_G0_TO_G6"
"""Releases motion on the real target: what sends goals is started."""
