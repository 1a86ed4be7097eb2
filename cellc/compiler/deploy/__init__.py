"""How a cell is deployed: hosts, start order, gates, recording, files: what several emitters share."""
