"""The same robot and inputs give the outputs that they give in 2026."""

from __future__ import annotations

from test_same_outputs import test_outputs

__all__ = ["test_outputs"]
