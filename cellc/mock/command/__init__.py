"""The commands behind `cellc mock`: rehearsals, campaign, gates, and the evidence that each leaves."""
