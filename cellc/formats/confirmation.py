"""The word that releases the real target, as the launch file asks for it and the pages for people state it."""

CONFIRMATION = "I_HAVE_PASSED_GATES_G0_TO_G2"
