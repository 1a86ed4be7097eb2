"""How values become the text of files: numbers, XML, YAML, JSON, headers, parameter files, the URDF."""
