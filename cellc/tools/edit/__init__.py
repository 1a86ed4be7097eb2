"""Corrects what has one safe answer in the user's own file: comments, order and layout stay."""
