"""The documented name of `engine.snapshot`: the same objects."""

from .engine.snapshot import Chooser, Failure, Snapshot, State, Status

__all__ = ["Chooser", "Failure", "Snapshot", "State", "Status"]
