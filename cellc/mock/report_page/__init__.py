"""The report of a call: one HTML page without anything from outside, readable without scripts, on paper and phone."""
