"""Every name of the specification's sections 1.1 to 1.3 exists under `pyfrc`, with its signature."""

from __future__ import annotations

import importlib
import inspect
import io
import re
from typing import Any

import pytest
from loops import for_each

SWERVE = (
    "lr_motor, rr_motor, lf_motor, rf_motor, lr_angle, rr_angle, lf_angle, rf_angle, x_wheelbase=2, y_wheelbase=2, "
    "speed=5, deadzone=None"
)

#: (module, name, parameters as documented); None where the documentation gives no signature.
SPECIFICATION: list[tuple[str, str, str | None]] = [
    ("pyfrc.tests.basic", "test_autonomous", "control, fake_time, robot, gamedata"),
    ("pyfrc.tests.basic", "test_disabled", "control, fake_time, robot"),
    ("pyfrc.tests.basic", "test_operator_control", "control, fake_time, robot"),
    ("pyfrc.tests.basic", "test_practice", "control, fake_time, robot"),
    ("pyfrc.tests.fuzz_test", "test_fuzz", "hal_data, control, fake_time, robot"),
    ("pyfrc.tests.docstring_test", "ignore_object", "o, robot_path"),
    ("pyfrc.tests.docstring_test", "test_docstrings", "robot, robot_path"),
    ("pyfrc.test_support.pytest_plugin", "PyFrcPlugin", "robot_class, robot_file, robot_path"),
    ("pyfrc.test_support.pytest_plugin", "ThreadStillRunningError", None),
    ("pyfrc.test_support.controller", "TestController", "fake_time_inst"),
    ("pyfrc.test_support.controller", "TestController.get_mode", ""),
    ("pyfrc.test_support.controller", "TestController.run_test", "controller=None"),
    ("pyfrc.test_support.controller", "TestController.set_autonomous", "enabled=True"),
    ("pyfrc.test_support.controller", "TestController.set_operator_control", "enabled=True"),
    ("pyfrc.test_support.controller", "TestController.set_practice_match", ""),
    ("pyfrc.test_support.controller", "TestController.set_test_mode", "enabled=True"),
    ("pyfrc.test_support.fake_time", "FakeTime", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.get", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.increment_new_packet", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.increment_time_by", "time"),
    ("pyfrc.test_support.fake_time", "FakeTime.initialize", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.reset", ""),
    ("pyfrc.test_support.fake_time", "FakeTime.set_time_limit", "time_limit"),
    ("pyfrc.test_support.fake_time", "TestEnded", None),
    ("pyfrc.test_support.fake_time", "TestFroze", None),
    ("pyfrc.test_support.fake_time", "TestRanTooLong", None),
    ("pyfrc.physics.core", "PhysicsEngine", "physics_controller"),
    ("pyfrc.physics.core", "PhysicsEngine.initialize", "hal_data"),
    ("pyfrc.physics.core", "PhysicsEngine.update_sim", "hal_data, now, tm_diff"),
    ("pyfrc.physics.core", "PhysicsInitException", None),
    ("pyfrc.physics.core", "PhysicsInterface", "robot_path, fake_time, config_obj"),
    ("pyfrc.physics.core", "PhysicsInterface.add_analog_gyro_channel", "ch"),
    ("pyfrc.physics.core", "PhysicsInterface.add_device_gyro_channel", "angle_key"),
    ("pyfrc.physics.core", "PhysicsInterface.add_gyro_channel", "ch"),
    ("pyfrc.physics.core", "PhysicsInterface.distance_drive", "x, y, angle"),
    ("pyfrc.physics.core", "PhysicsInterface.drive", "speed, rotation_speed, tm_diff"),
    ("pyfrc.physics.core", "PhysicsInterface.get_offset", "x, y"),
    ("pyfrc.physics.core", "PhysicsInterface.get_position", ""),
    ("pyfrc.physics.core", "PhysicsInterface.vector_drive", "vx, vy, vw, tm_diff"),
    ("pyfrc.physics.drivetrains", "FourMotorDrivetrain", "x_wheelbase=2, speed=5, deadzone=None"),
    ("pyfrc.physics.drivetrains", "FourMotorDrivetrain.get_vector", "lr_motor, rr_motor, lf_motor, rf_motor"),
    ("pyfrc.physics.drivetrains", "MecanumDrivetrain", "x_wheelbase=2, y_wheelbase=3, speed=5, deadzone=None"),
    ("pyfrc.physics.drivetrains", "MecanumDrivetrain.get_vector", "lr_motor, rr_motor, lf_motor, rf_motor"),
    ("pyfrc.physics.drivetrains", "TwoMotorDrivetrain", "x_wheelbase=2, speed=5, deadzone=None"),
    ("pyfrc.physics.drivetrains", "TwoMotorDrivetrain.get_vector", "l_motor, r_motor"),
    (
        "pyfrc.physics.drivetrains",
        "four_motor_drivetrain",
        "lr_motor, rr_motor, lf_motor, rf_motor, x_wheelbase=2, speed=5, deadzone=None",
    ),
    ("pyfrc.physics.drivetrains", "four_motor_swerve_drivetrain", SWERVE),
    ("pyfrc.physics.drivetrains", "four_motor_serve_drivetrain", SWERVE),
    ("pyfrc.physics.drivetrains", "linear_deadzone", "deadzone"),
    (
        "pyfrc.physics.drivetrains",
        "mecanum_drivetrain",
        "lr_motor, rr_motor, lf_motor, rf_motor, x_wheelbase=2, y_wheelbase=3, speed=5, deadzone=None",
    ),
    ("pyfrc.physics.drivetrains", "two_motor_drivetrain", "l_motor, r_motor, x_wheelbase=2, speed=5, deadzone=None"),
    *[
        ("pyfrc.physics.motor_cfgs", f"MOTOR_CFG_{motor}", None)
        for motor in ("775PRO", "775_125", "AM_9015", "BAG", "BB_RS550", "BB_RS775", "CIM", "MINI_CIM")
    ],
    (
        "pyfrc.physics.motor_cfgs",
        "MotorModelConfig",
        "name, nominalVoltage, freeSpeed, freeCurrent, stallTorque, stallCurrent",
    ),
    *[
        ("pyfrc.physics.motor_cfgs", f"MotorModelConfig.{name}", None)
        for name in ("freeCurrent", "freeSpeed", "name", "nominalVoltage", "stallCurrent", "stallTorque")
    ],
    (
        "pyfrc.physics.motion",
        "LinearMotion",
        "name, motor_ft_per_sec, ticks_per_feet, max_position=None, min_position=0",
    ),
    ("pyfrc.physics.tankmodel", "MotorModel", "motor_config, kv, ka, vintercept"),
    ("pyfrc.physics.tankmodel", "MotorModel.compute", "motor_pct, tm_diff"),
    (
        "pyfrc.physics.tankmodel",
        "TankModel",
        "motor_config, robot_mass, x_wheelbase, robot_width, robot_length, l_kv, l_ka, l_vi, r_kv, r_ka, r_vi, "
        "timestep=<Quantity(5, 'millisecond')>",
    ),
    ("pyfrc.physics.tankmodel", "TankModel.get_distance", "l_motor, r_motor, tm_diff"),
    *[
        ("pyfrc.physics.tankmodel", f"TankModel.{name}", None)
        for name in ("inertia", "l_position", "l_velocity", "r_position", "r_velocity")
    ],
    (
        "pyfrc.physics.tankmodel",
        "TankModel.theory",
        "motor_config, robot_mass, gearing, nmotors=1, x_wheelbase=<Quantity(21.0, 'inch')>, "
        "robot_width=<Quantity(27.5, 'inch')>, robot_length=<Quantity(36.5, 'inch')>, "
        "wheel_diameter=<Quantity(6, 'inch')>, vintercept=<Quantity(1.3, 'volt')>, "
        "timestep=<Quantity(5, 'millisecond')>",
    ),
    ("pyfrc.sim", "get_user_renderer", ""),
    (
        "pyfrc.sim.field.user_renderer",
        "UserRenderer.draw_line",
        "line_pts, color='#ff0000', robot_coordinates=False, relative_to_first=False, arrow=True, scale=(1, 1)",
    ),
    (
        "pyfrc.sim.field.user_renderer",
        "UserRenderer.draw_pathfinder_trajectory",
        "trajectory, color='#ff0000', offset=None, scale=(1, 1), show_dt=False, dt_offset=0.0",
    ),
    (
        "pyfrc.sim.field.user_renderer",
        "UserRenderer.draw_text",
        "text, pt, color='#000000', fontSize=10, robot_coordinates=False, scale=(1, 1)",
    ),
    ("pyfrc.sim.field.user_renderer", "UserRenderer", None),
    ("pyfrc.physics.units", "units", None),
    *[
        ("pyfrc.physics.units", f"units.{name}", None)
        for name in ("counts_per_minute", "cpm", "N_m", "tm_ka", "tm_kv", "feet", "inch", "lbs")
    ],
    (
        "pyfrc.physics.visionsim",
        "VisionSim",
        "targets, camera_fov, view_dst_start, view_dst_end, data_frequency=15, data_lag=0.05, physics_controller=None",
    ),
    ("pyfrc.physics.visionsim", "VisionSim.Target", "x, y, view_angle_start, view_angle_end"),
    ("pyfrc.physics.visionsim", "VisionSim.compute", "now, x, y, angle"),
    ("pyfrc.physics.visionsim", "VisionSim.dont_compute", ""),
    ("pyfrc.physics.visionsim", "VisionSim.get_immediate_distance", ""),
    ("pyfrc.physics.visionsim", "VisionSimTarget", "x, y, view_angle_start, view_angle_end"),
]

FIXTURES = ["control", "fake_time", "hal_data", "robot", "robot_file", "robot_path", "wpilib"]


def find(module: str, name: str) -> Any:
    found: Any = importlib.import_module(module)
    for part in name.split("."):
        found = getattr(found, part)
    return found


def _as_documented(default: Any) -> str:
    if hasattr(default, "units"):  # pint's own way to write it has changed since
        return f"<Quantity({default.magnitude!r}, '{default.units}')>"
    return repr(default)


def documented_part(signature: inspect.Signature, parameters: str) -> str:
    """As many of the leading parameters as are documented, written as the documentation writes them.

    What we add behind them must be optional, and what is required there may be optional here, so that documented calls
    work.
    """
    documented = re.split(r", (?=[A-Za-z_])", parameters) if parameters else []
    known = [p for p in signature.parameters.values() if p.name not in ("self", "_cls")]
    for extra in known[len(documented) :]:
        if extra.kind is inspect.Parameter.VAR_KEYWORD:
            continue
        assert extra.default is not inspect.Parameter.empty, (
            f"{extra.name} is an addition that callers would have to give"
        )
    ours = zip(known, [*documented, *[""] * len(known)], strict=False)
    return ", ".join(
        parameter.name if "=" not in written else f"{parameter.name}={_as_documented(parameter.default)}"
        for parameter, written in list(ours)[: len(documented)]
    )


@for_each("module, name, parameters", SPECIFICATION)
def test_documented_name(module: str, name: str, parameters: str | None) -> None:
    found = find(module, name)
    if parameters is not None:
        assert documented_part(inspect.signature(found), parameters) == parameters


@pytest.mark.parametrize("name", FIXTURES)
def test_documented_fixture(name: str) -> None:
    assert find("pyfrc.test_support.pytest_plugin", f"PyFrcPlugin.{name}") is not None


def test_star_import_gives_the_ready_made_tests() -> None:
    namespace: dict[str, Any] = {}
    exec("from pyfrc.tests import *", namespace)
    assert {name for name in namespace if name.startswith("test_")} == {
        "test_autonomous",
        "test_disabled",
        "test_fuzz",
        "test_operator_control",
        "test_practice",
    }


def test_the_ends_of_a_run_escape_a_blanket_except() -> None:
    """As documented, `except Exception` in robot code catches none of them."""
    for name in ("TestEnded", "TestFroze", "TestRanTooLong"):
        ending = find("pyfrc.test_support.fake_time", name)
        assert issubclass(ending, BaseException)
        assert not issubclass(ending, Exception)


@for_each("module, name", [(module, name) for module, name, _ in SPECIFICATION if "." not in name])
def test_it_is_the_same_object_as_in_the_core(module: str, name: str) -> None:
    found = find(module, name)
    defined_in = getattr(found, "__module__", "")
    if not defined_in.startswith("pyfrc_core."):  # no class or function of ours
        defined_in = module.replace("pyfrc.", "pyfrc_core.", 1)
    assert find(defined_in, name.rpartition(".")[2]) is found


#: What the pyfrc of 2020 to 2026 has besides: each name that is not a part of its own commands.
SINCE_2020 = {
    "pyfrc": "version __version__",
    "pyfrc.version": "version version_tuple __version__",
    "pyfrc.util": "yesno print_err",
    "pyfrc.physics.core": "PhysicsEngine PhysicsInitException PhysicsInterface.drive PhysicsInterface.move_robot "
    "PhysicsInterface.get_pose",
    "pyfrc.physics.drivetrains": "linear_deadzone DeadzoneCallable TwoMotorDrivetrain.calculate "
    "FourMotorDrivetrain.calculate MecanumDrivetrain.calculate four_motor_swerve_drivetrain",
    "pyfrc.physics.motion": "LinearMotion.position_ft LinearMotion.position_ticks LinearMotion.compute",
    "pyfrc.physics.motor_cfgs": "MotorModelConfig NOMINAL_VOLTAGE",
    "pyfrc.physics.tankmodel": "MotorModel.compute TankModel.theory TankModel.calculate TankModel.inertia "
    "TankModel.l_velocity TankModel.r_velocity TankModel.l_position TankModel.r_position",
    "pyfrc.physics.units": "units Helpers.ensure_mass Helpers.ensure_length Helpers.ensure_acceleration "
    "Helpers.ensure_time Helpers.ensure_velocity",
    "pyfrc.physics.visionsim": "VisionSimTarget.compute VisionSim.Target VisionSim.dont_compute VisionSim.compute "
    "VisionSim.get_immediate_distance",
    "pyfrc.test_support.controller": "TestController.run_robot TestController.robot_is_alive "
    "TestController.step_timing",
    "pyfrc.test_support.pytest_plugin": "PyFrcPlugin.control PyFrcPlugin.robot PyFrcPlugin.robot_file "
    "PyFrcPlugin.robot_path",
    "pyfrc.tests.basic": "test_autonomous test_disabled test_operator_control test_practice",
    "pyfrc.tests.docstring_test": "ignore_object test_docstrings",
}


@for_each("module, name", [(module, name) for module in SINCE_2020 for name in SINCE_2020[module].split()])
def test_name_since_2020(module: str, name: str) -> None:
    assert find(module, name) is not None


def test_the_version_is_in_each_of_its_places() -> None:
    import pyfrc
    import pyfrc.version

    assert pyfrc.version.version == pyfrc.__version__
    assert pyfrc.version.version_tuple[:2] == (2026, 1)


def test_yes_or_no(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from pyfrc.util import print_err, yesno

    for typed, answer in (("y", True), ("n", False), ("maybe\n\nY", True)):
        monkeypatch.setattr("sys.stdin", io.StringIO(f"{typed}\n"))
        assert yesno("Go on?") is answer
    assert capsys.readouterr().out == "Go on? [y/n]" * 5
    with pytest.raises(EOFError):
        yesno("Go on?")
    print_err("no", 1)
    assert capsys.readouterr().err == "no 1\n"


def test_checks_of_dimensions() -> None:
    from pint import DimensionalityError

    from pyfrc.physics.units import Helpers, units

    length, time = 2 * units.feet, 3 * units.second
    right = {"length": length, "time": time, "mass": 4 * units.kg, "velocity": length / time}
    right["acceleration"] = right["velocity"] / time
    for dimension, quantity in right.items():
        ensure = getattr(Helpers, f"ensure_{dimension}")
        assert ensure(quantity) is quantity
        for wrong in [5, *(other for other in right.values() if other is not quantity)]:
            with pytest.raises(DimensionalityError):
                ensure(wrong)
