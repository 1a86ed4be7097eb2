"""An edited folder: what its files say that no run executes, against what a run executes."""
