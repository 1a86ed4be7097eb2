"""The MoveIt configuration, file by file."""
