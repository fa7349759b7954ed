"""Commands that need more than one subsystem, or state of their own."""
