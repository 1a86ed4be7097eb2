"""The commands of the mock: rehearsals, campaign, sweep, gates and replay, and the evidence that each leaves."""
