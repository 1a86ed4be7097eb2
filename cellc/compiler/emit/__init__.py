"""What a cell becomes: one emitter a file, each from the graph to the text of its artifacts."""
