"""The version of pyfrc."""

from pyfrc_core._version import __version__

version = __version__
version_tuple = tuple(map(int, version.split(".")))
