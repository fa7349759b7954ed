"""State machines that use several mechanisms together."""
