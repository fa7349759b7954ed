"""The unit registry: what it knows, that its cache can never make it fail, and errors that name the dimension."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pint
import pytest
from conftest import sampled
from loops import for_each

from pyfrc.physics.motor_cfgs import MOTOR_CFG_CIM
from pyfrc.physics.tankmodel import TankModel
from pyfrc.physics.units import units
from pyfrc_core.physics import registry
from pyfrc_core.physics.parameters import ParameterError
from pyfrc_core.physics.quantities import WrongDimension, magnitude

# -- what it knows -----------------------------------------------------------------------------------------------------


def test_units_of_our_own() -> None:
    assert (60 * units.counts_per_minute).to("count / second").magnitude == pytest.approx(1)
    assert 1 * units.cpm == 1 * units.counts_per_minute
    assert (5310 * units.cpm).to("1 / minute").magnitude == pytest.approx(5310)
    assert (1 * units.N_m).to("joule").magnitude == 1
    assert (0.3048 * units.tm_kv).to("volt * second / metre").magnitude == pytest.approx(1)
    assert (0.3048 * units.tm_ka).to("volt * second ** 2 / metre").magnitude == pytest.approx(1)


def test_units_that_robots_use() -> None:
    assert 5 * units.feet == units.Quantity(60, "inch") == 60 * units.inch
    assert (1 * units.lbs).to("kg").magnitude == pytest.approx(0.45359237)
    assert (10 * units.fps).to("m/s").magnitude == pytest.approx(3.048)


# -- quantities of other registries, and none --------------------------------------------------------------------------


def test_quantities_of_another_registry_are_understood() -> None:
    own = pint.UnitRegistry()
    model = TankModel.theory(MOTOR_CFG_CIM, own.Quantity(90, "lb"), 10.71, x_wheelbase=2 * own.feet)
    ours = TankModel.theory(MOTOR_CFG_CIM, 90 * units.lbs, 10.71, x_wheelbase=2 * units.feet)
    assert model.get_distance(-1, 0.5, 0.5) == ours.get_distance(-1, 0.5, 0.5)
    assert magnitude(pint.Quantity(1, "metre"), "foot", "length") == pytest.approx(1 / 0.3048)
    with pytest.raises(WrongDimension, match="robot_mass: 2 foot is a length, a mass was expected"):
        TankModel.theory(MOTOR_CFG_CIM, 2 * own.feet, 10.71)


@for_each(
    "value, unit, error",
    [
        (90 * units.foot, "pound", "it: 90 foot is a length, a mass was expected, such as 90 * units.lbs"),
        (90, "pound", "it: 90 has no unit, a mass was expected"),
        (units.foot, "pound", "it: foot is a unit without a number, a mass was expected"),
        ("90 lbs", "pound", "it: '90 lbs' is not a quantity, a mass was expected"),
        (True, "pound", "it: True is not a quantity, a mass was expected"),
        (None, "foot / second", "it: None is not a quantity, a speed was expected, such as 12 * units.fps"),
        (
            1 * units.tm_ka,
            "volt * second / foot",
            "is a voltage for an acceleration, a voltage for a speed was expected",
        ),
        (1 * units.lbs / units.s, "second", "is of dimension [mass] / [time], a time was expected"),
        (units.Quantity(3, ""), "foot", "is a number without a dimension, a length was expected"),
    ],
)
def test_a_wrong_dimension_names_what_was_given_and_what_was_expected(value: Any, unit: str, error: str) -> None:
    with pytest.raises(WrongDimension) as raised:
        magnitude(value, unit, "it")
    assert error in str(raised.value)


def test_a_plain_number_where_it_may_be_one() -> None:
    assert magnitude(2, "foot", "x_wheelbase", plain=True) == 2.0
    assert magnitude(24 * units.inch, "foot", "x_wheelbase", plain=True) == pytest.approx(2.0)
    for none in (float("nan"), float("inf") * units.feet):
        with pytest.raises(ParameterError, match="x_wheelbase"):
            magnitude(none, "foot", "x_wheelbase", plain=True)
    with pytest.raises(WrongDimension, match="x_wheelbase"):
        magnitude(2 * units.lbs, "foot", "x_wheelbase", plain=True)


# -- the cache on disk -------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def definitions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the parsed definitions, for copies."""
    folder = tmp_path_factory.mktemp("cache") / "definitions"
    registry.build(folder)
    return folder


def works(built: Any) -> bool:
    return bool((60 * built.cpm).to("count / second").magnitude == 1 and (1 * built.foot).to("inch").magnitude > 11)


def test_definitions_are_kept_and_read_again(tmp_path: Path) -> None:
    folder = tmp_path / "not there yet" / "definitions"
    assert works(registry.build(folder))
    kept = {path.name: path.stat().st_mtime_ns for path in folder.iterdir()}
    assert any(name.endswith(".pickle") for name in kept)
    assert works(registry.build(folder))
    assert {path.name: path.stat().st_mtime_ns for path in folder.iterdir()} == kept


@pytest.mark.parametrize(
    "content",
    sampled([b"\x80\x05K\x05.", None], None),
    ids=["other", "half"],
)
def test_a_damaged_cache_is_made_anew(definitions: Path, tmp_path: Path, content: bytes | None) -> None:
    folder = shutil.copytree(definitions, tmp_path / "definitions")
    sound = {path.name: path.stat().st_size for path in folder.iterdir()}
    for path in folder.iterdir():
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2] if content is None else content)
    assert works(registry.build(folder))  # without it
    assert works(registry.build(folder))
    assert {path.name: path.stat().st_size for path in folder.iterdir()} == pytest.approx(sound, rel=0.1)


def test_a_cache_that_cannot_be_kept_costs_only_time(tmp_path: Path) -> None:
    a_file = tmp_path / "file"
    a_file.write_text("in the way", "utf-8")
    assert works(registry.build(a_file / "below"))
    assert a_file.read_text("utf-8") == "in the way"


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="XDG_CACHE_HOME is of Linux")
def test_pint_is_imported_when_units_are_used_and_its_cache_is_in_the_users_cache_directory(tmp_path: Path) -> None:
    """Dask, which pint would import, is not, and can be afterwards."""
    code = """
import sys
from pyfrc.physics.units import units
print("pint" in sys.modules)
print((12 * units.inch).to("feet").magnitude, 60 * units.cpm)
print("pint" in sys.modules, "dask" in sys.modules)
import dask
print(dask.__name__)
"""
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert done.stdout.splitlines() == ["False", "1.0 60 counts_per_minute", "True False", "dask"], done.stderr
    assert list((tmp_path / "pyfrc").glob("pint-*/*.pickle"))
