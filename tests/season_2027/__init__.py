"""Tests of season 2027."""
