"""Kills, full disks, forbidden folders, many writers and damaged caches, counted."""
