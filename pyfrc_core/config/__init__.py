"""The project's settings and sim/config.json, as typed objects.

In: `[tool.pyfrc]` in pyproject.toml (`settings`), `sim/config.json` (`sim`, `sim_file`). Out: objects with defaults,
and `findings` with the line of each mistake.

pydantic models define what a file may contain. Settings are plain dataclasses, so that a project with default settings
never imports pydantic. A file is parsed a second time, for line numbers, only when a message names a place in it.
"""
