"""Autonomous modes, which magicbot offers to the drivers in a chooser."""
