"""The script at the root of the repository that the Makefile calls, as a module."""

from __future__ import annotations

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

_FILE = Path(__file__).parents[1] / "make.py"
_SPEC = spec_from_file_location("make_script_of_the_repository", _FILE)
assert _SPEC is not None
assert _SPEC.loader is not None
make_script = module_from_spec(_SPEC)
_SPEC.loader.exec_module(make_script)
