"""Bring-up of the simulated cell in stages, each with its evidence: discover, configure, observe, claim."""
