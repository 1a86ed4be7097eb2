"""The controllers, each by the behavior that its plugin type represents."""
