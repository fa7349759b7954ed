"""Autonomous modes: magicbot finds them by looking into this folder."""
