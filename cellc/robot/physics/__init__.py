"""Rigid bodies with masses, contacts and drives, computed by MuJoCo."""
