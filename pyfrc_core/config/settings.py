"""``[tool.pyfrc]`` in a robot project's pyproject.toml: its keys and their defaults.

Plain dataclasses, so that a project with default settings does not wait for the import of pydantic, which validates
the settings of the others.
"""

from __future__ import annotations

import functools
import json
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from ..errors import SettingsError
from ..season import CURRENT
from .findings import Path as KeyPath
from .findings import mistakes, settings_error
from .toml_file import TomlFile

if TYPE_CHECKING:
    from pydantic import TypeAdapter


class _Positive:
    """The constraint "greater than 0", which imports pydantic only when pydantic asks for it."""

    @staticmethod
    def __get_pydantic_core_schema__(source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema

        def check(value: Any) -> Any:
            if value <= 0:
                raise ValueError("must be greater than 0")
            return value

        return core_schema.no_info_after_validator_function(check, handler(source))


#: For pydantic: unknown keys are errors, and so is ``"15"`` for a number.
STRICT: Any = {"extra": "forbid", "strict": True}

Seconds = Annotated[float, _Positive]

#: Of random generators, in tests.
DEFAULT_SEED = 0


@dataclass(frozen=True)
class MatchSettings:
    """``[tool.pyfrc.match]``: how long the practice match's periods are, in seconds."""

    __pydantic_config__ = STRICT

    #: Disabled on the field, before the match starts.
    before: Seconds = 1.0
    autonomous: Seconds = CURRENT.match.autonomous
    #: Disabled, between autonomous and teleoperated.
    pause: Seconds = CURRENT.match.pause
    teleop: Seconds = CURRENT.match.teleop


@dataclass(frozen=True)
class TestSettings:
    """``[tool.pyfrc.test]``: how tests are run."""

    __pydantic_config__ = STRICT

    #: How many tests run at the same time.
    jobs: Annotated[int, _Positive] | Literal["auto"] = "auto"
    #: What each test that uses the robot runs in: a forked process, an earlier one, or this one.
    isolation: Literal["auto", "fork", "reuse", "none"] = "auto"
    #: Seconds of computing without progress in robot time after which robot code counts as hanging. For code that
    #: waits, it is at least 10 s.
    hang_seconds: Seconds = 10.0
    #: How long a periodic function may wait, in robot time, until it counts as one that never returns. What begins in
    #: autonomous or test mode has the length of the autonomous period, where that is longer.
    loop_seconds: Seconds = 2.0
    #: How many times as fast as real time robot time passes at most, in a robot with devices that a vendor's library
    #: simulates in real time (`compat.unrepeatable`). Replays and fuzzing have the same limit.
    real_time_speed: Annotated[float, _Positive] = 8.0

    __test__ = False  # pytest: not a test class, for all its name


@dataclass(frozen=True)
class DeploySettings:
    """``[tool.pyfrc.deploy]``: what belongs on the robot."""

    __pydantic_config__ = STRICT

    #: Patterns of files and directories that are not uploaded.
    exclude: tuple[str, ...] = ()
    #: Patterns of files that are uploaded without a question although they seem to be private.
    private: tuple[str, ...] = ()


@dataclass(frozen=True)
class FuzzSettings:
    """``[tool.pyfrc.fuzz]``: how long fuzzing's matches are, and which checks run.

    Each ``bool`` switches a check of `fuzz.oracle.checks` on or off, which reports its failures under this name.
    """

    __pydantic_config__ = STRICT

    #: How long each match is, in robot time. A check that waits for longer finds nothing.
    match_seconds: Seconds = 30.0
    #: Processor seconds without progress in robot time, after which robot code counts as hanging.
    hang_seconds: Seconds = 2.0
    #: A loop that takes longer than its period, in robot time.
    slow_loops: bool = True
    #: A motor command while the robot is disabled.
    motors_while_disabled: bool = True
    #: A motor that runs on in teleop with what autonomous has set.
    motors_left_running: bool = True
    #: A motor command with the value NaN.
    not_a_number: bool = True
    #: A motor command greater than 1 or less than -1.
    out_of_range: bool = False
    #: An error that the HAL reports.
    hal_errors: bool = True
    #: A robot that does not leave a mode, or a program that ends.
    stuck_modes: bool = True


@dataclass(frozen=True)
class SimSettings:
    """``[tool.pyfrc.sim]``: what ``pyfrc sim`` does."""

    __pydantic_config__ = STRICT

    #: Names of values that ``pyfrc sim --log`` does not compare, such as for how long code has computed.
    ignore: tuple[str, ...] = ()


@dataclass(frozen=True)
class Settings:
    """``[tool.pyfrc]``."""

    __pydantic_config__ = STRICT

    #: The file with the robot class, relative to pyproject.toml, when it is not robot.py.
    main: str | None = None
    #: The robot class's name, when the file has several.
    robot_class: str | None = None
    #: The team's number, by which its robot is found.
    team: int | None = None
    match: MatchSettings = field(default_factory=MatchSettings)
    test: TestSettings = field(default_factory=TestSettings)
    sim: SimSettings = field(default_factory=SimSettings)
    fuzz: FuzzSettings = field(default_factory=FuzzSettings)
    deploy: DeploySettings = field(default_factory=DeploySettings)


def load_settings(pyproject: Path) -> Settings:
    """Return what ``[tool.pyfrc]`` in this file says, or the defaults where there is no such file or table.

    :raises SettingsError: with the file, the line and the key
    """
    if not pyproject.is_file():
        return Settings()
    file = TomlFile(pyproject)
    if "pyfrc" in file.content:
        raise SettingsError("[pyfrc] has no effect", where=file.place_of("pyfrc"), remedy="Write: [tool.pyfrc]")
    tools = file.table_at("tool") or {}
    table = tools.get("pyfrc")
    return _validated(table, file) if table else Settings()


@functools.cache
def _validator() -> TypeAdapter[Settings]:
    """Return the validator, which is built once: a command may read the settings more than once."""
    import pydantic

    return pydantic.TypeAdapter(Settings)


def _validated(table: object, file: TomlFile) -> Settings:
    import pydantic

    try:
        # As JSON, since strict checking of Python data would ask for instances where files have tables.
        return _validator().validate_json(json.dumps(table, default=str))
    except pydantic.ValidationError as invalid:
        raise settings_error(mistakes(invalid, table, file, ("tool", "pyfrc"), _KEYS)) from None


#: The keys of ``[tool.pyfrc]`` and of the tables in it.
_KEYS: dict[KeyPath, list[str]] = {
    path: [key.name for key in fields(table)]
    for path, table in {
        (): Settings,
        ("match",): MatchSettings,
        ("test",): TestSettings,
        ("deploy",): DeploySettings,
        ("sim",): SimSettings,
        ("fuzz",): FuzzSettings,
    }.items()
}
