"""The catalog for people: lists that are searched by figures, and a page with a picture for each device."""
