"""Custom test support: `controller`, `fake_time`, `pytest_plugin`."""
