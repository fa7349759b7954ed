"""The documented name of `engine.scene`: the same objects."""

from .engine.scene import Field, Line, Point, Pose, Scene, Shape, Tag, Target, Text

__all__ = ["Field", "Line", "Point", "Pose", "Scene", "Shape", "Tag", "Target", "Text"]
