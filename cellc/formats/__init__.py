"""How values become the text of files: numbers, XML, YAML, JSON, headers, the URDF and the configuration id."""
