"""Rules on who commands and who answers."""
