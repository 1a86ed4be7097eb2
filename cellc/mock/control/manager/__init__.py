"""The controller manager: life cycles, claims, update cycles."""

from cellc.mock.control.manager.controller_manager import ControllerManager

__all__ = ["ControllerManager"]
