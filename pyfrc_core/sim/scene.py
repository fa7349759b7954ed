"""The documented name of `engine.scene`: the same objects."""

from .engine.scene import Field, Line, LineStyle, Point, Pose, Scene, Shape, Tag, Target, Text, TextStyle

__all__ = ["Field", "Line", "LineStyle", "Point", "Pose", "Scene", "Shape", "Tag", "Target", "Text", "TextStyle"]
