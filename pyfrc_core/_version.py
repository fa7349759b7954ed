"""The version: the year of the season in which it is released, then the release within it.

Which seasons' robots it runs is in `season.SEASONS`.
"""

__version__ = "2026.1.0"


def requirement(*extras: str) -> str:
    """Return the requirement for pip, such as ``pyfrc[picture]>=2026.1``.

    Always with the version: the index has older packages of this name, which are another program.
    """
    release = ".".join(__version__.split(".")[:2])
    chosen = f"[{','.join(extras)}]" if extras else ""
    return f"pyfrc{chosen}>={release}"
