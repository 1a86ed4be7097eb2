"""Evidence of the gates: what is there, of which configuration, what is missing, and who signs; it signs nothing."""
