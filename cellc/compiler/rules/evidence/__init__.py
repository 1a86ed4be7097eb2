"""Rules on what an attempt leaves behind."""
