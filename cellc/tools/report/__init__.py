"""Everything that a person or a program reads of the compiler's findings is formatted here, and printed elsewhere."""
