"""Masses, drives and contacts of a cell, behind the hardware of its controller managers."""
