"""The responsibility graph as a picture, part by part."""
