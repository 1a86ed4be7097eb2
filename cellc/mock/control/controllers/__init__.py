"""The controllers, each by the behaviour that its plugin type stands for."""
