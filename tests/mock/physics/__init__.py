"""Masses, drives and contacts behind the hardware of the mock."""
