"""What robot code sets while the robot is disabled moves nothing; what rolls, rolls on."""

from __future__ import annotations

from collections.abc import Iterator

import hal
import pytest
from conftest import sampled
from hal import simulation as hs
from sim_robots import run, settle

from pyfrc_core.hal.output_gate import OutputGate
from pyfrc_core.project import Project
from pyfrc_core.sim import SimOptions, Simulation
from pyfrc_core.wpi import station

ROBOT = """
    import hal
    import wpilib
    from wpilib.interfaces import MotorController


    class CanMotor(MotorController):
        '''As vendors make them: a SimDevice with a value for the output, and a `get` that asks only this object.'''

        def __init__(self, number):
            super().__init__()
            self.device = hal.SimDevice(f"SPARK MAX [{number}]")
            output = hal.SimDevice.Direction.kOutput
            self.setpoint = self.device.createDouble("Setpoint", output, 0.0)
            self.mode = self.device.createInt("Control Mode", output, 0)
            self.bus = self.device.createDouble("Bus Voltage", output, 12.0)
            self.velocity = self.device.createDouble("Velocity", hal.SimDevice.Direction.kBidir, 0.0)
            self.applied = self.device.createDouble("Applied Output", output, 0.0)
            self.speed = 0.0

        def set(self, speed):
            self.speed = speed
            self.setpoint.set(speed)
            self.applied.set(speed)

        def get(self):
            return self.speed


    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.left, self.right = wpilib.PWMSparkMax(0), wpilib.PWMSparkMax(1)
            self.right.setInverted(True)
            self.servo = wpilib.Servo(2)
            self.relay = wpilib.Relay(0)
            self.solenoid = wpilib.Solenoid(wpilib.PneumaticsModuleType.CTREPCM, 1)
            self.hub = wpilib.Solenoid(wpilib.PneumaticsModuleType.REVPH, 2)
            self.can = CanMotor(5)
            self.seen = []

        def robotPeriodic(self):
            self.left.set(0.5)
            self.right.set(0.5)
            self.servo.set(0.9)
            self.relay.set(wpilib.Relay.Value.kForward)
            self.solenoid.set(True)
            self.hub.set(True)
            self.can.set(0.5)

        def _simulationPeriodic(self):
            self.seen.append((self.left.get(), self.can.get()))
    """

DOCUMENTED = """
    import __main__

    class PhysicsEngine:
        def __init__(self, physics_controller):
            self.physics_controller = physics_controller
            __main__.engine = self

        def update_sim(self, hal_data, now, tm_diff):
            can = hal_data["CAN"]["SPARK MAX [5]"]
            self.outputs = [
                hal_data["pwm"][0]["value"], hal_data["pwm"][1]["value"],
                hal_data["pwm"][0]["raw_value"] - 1500, hal_data["relay"][0]["fwd"],
                hal_data["solenoid"][1]["value"], hal_data["ph"][1][2]["value"],
                can["Setpoint"], can["Applied Output"],
            ]
            self.others = hal_data["pwm"][2]["position"], hal_data["pwm"][2]["value"] > 0.5, can["Bus Voltage"]
            self.physics_controller.drive(5 * hal_data["pwm"][0]["value"], 0, tm_diff)
    """

TODAYS = """
    import __main__
    from wpilib.simulation import CTREPCMSim, PWMSim, RelaySim, REVPHSim, SimDeviceSim
    from wpimath.kinematics import ChassisSpeeds

    class PhysicsEngine:
        def __init__(self, physics_controller, robot):
            self.physics_controller, self.robot = physics_controller, robot
            __main__.engine = self
            self.left = PWMSim(0)
            device = SimDeviceSim("SPARK MAX [5]")
            self.applied, self.bus = device.getDouble("Applied Output"), device.getDouble("Bus Voltage")

        def update_sim(self, now, tm_diff):
            robot = self.robot
            self.outputs = [
                self.left.getSpeed(), robot.left.get(), robot.right.get(), robot.can.get(), self.applied.get(),
                RelaySim(0).getForward(), CTREPCMSim(0).getSolenoidOutput(1), REVPHSim(1).getSolenoidOutput(2),
            ]
            self.others = robot.servo.get(), PWMSim(2).getSpeed() > 0.5, self.bus.get()
            self.physics_controller.drive(ChassisSpeeds(2 * robot.left.get(), 0, 0), tm_diff)
    """

TESTS = """
    import __main__
    import pytest
    from hal import simulation as hs


    @pytest.fixture
    def place(physics_controller):
        return lambda: physics_controller.get_position()[0]


    def set_by_code(robot, hal_data):
        assert (robot.left.get(), robot.right.get(), robot.can.get()) == (0.5, 0.5, 0.5)
        assert (hal_data["pwm"][0]["value"], hal_data["pwm"][1]["value"]) == (0.5, -0.5)
        assert hal_data["pwm"][0]["raw_value"] > 1700
        assert hal_data["relay"][0]["fwd"] and hal_data["solenoid"][1]["value"] and hal_data["ph"][1][2]["value"]
        can = hal_data["CAN"]["SPARK MAX [5]"]
        assert (can["Setpoint"], can["Applied Output"], can["Bus Voltage"]) == (0.5, 0.5, 12.0)


    def test_never_enabled(control, robot, hal_data, place):
        before = place()
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=False, enabled=False)
            assert place() == before
            assert not any(__main__.engine.outputs), __main__.engine.outputs
            assert __main__.engine.others == (0.9, True, 12.0)
            assert set(robot.seen) == {(0.0, 0.0)}
            set_by_code(robot, hal_data)
            control.step_timing(seconds=0.02, autonomous=False, enabled=True)
            assert all(__main__.engine.outputs), __main__.engine.outputs
            assert place() > before
            assert robot.seen[-1] == (0.5, 0.5)
            set_by_code(robot, hal_data)


    @pytest.mark.parametrize("stop", [hs.setDriverStationEStop, lambda on: hs.setDriverStationDsAttached(not on)])
    def test_stopped_on_the_way(control, robot, hal_data, place, stop):
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=True, enabled=True)
            stop(True)
            before = place()
            for _ in range(10):
                control.step_timing(seconds=0.1, autonomous=False, enabled=False)
            assert place() == before != 0
            assert not any(__main__.engine.outputs)
            assert robot.can.get() == 0.5
    """


@pytest.mark.parametrize(
    "physics", [DOCUMENTED, pytest.param(TODAYS, marks=pytest.mark.slow)], ids=["documented", "today's"]
)
def test_outputs_of_a_disabled_robot_are_off_for_physics(physics: str, make_project) -> None:
    project = make_project({"robot.py": ROBOT, "physics.py": physics, "tests/test_it.py": TESTS})
    result = project.run("test")
    assert result.code == 0, result.output


ROLLS = {
    "tank model, documented": """
        from pyfrc.physics import motor_cfgs, tankmodel
        from pyfrc.physics.units import units

        class PhysicsEngine:
            def __init__(self, physics_controller):
                self.physics_controller = physics_controller
                self.wheels = tankmodel.TankModel.theory(motor_cfgs.MOTOR_CFG_CIM, 110 * units.lbs, 10.71)

            def update_sim(self, hal_data, now, tm_diff):
                left, right = hal_data["pwm"][0]["value"], hal_data["pwm"][1]["value"]
                self.physics_controller.distance_drive(*self.wheels.get_distance(left, right, tm_diff))
                hal_data["encoder"][0]["count"] = round(self.wheels.l_position * 100_000)
        """,
    "tank model, today's": """
        from pyfrc.physics import motor_cfgs, tankmodel
        from pyfrc.physics.units import units
        from wpilib.simulation import EncoderSim

        class PhysicsEngine:
            def __init__(self, physics_controller, robot):
                self.physics_controller, self.robot = physics_controller, robot
                self.encoder = EncoderSim(robot.encoder)
                self.wheels = tankmodel.TankModel.theory(motor_cfgs.MOTOR_CFG_CIM, 110 * units.lbs, 10.71)

            def update_sim(self, now, tm_diff):
                left, right = -self.robot.left.get(), -self.robot.right.get()
                self.physics_controller.move_robot(self.wheels.calculate(left, right, tm_diff))
                self.encoder.setCount(round(self.wheels.l_position * 100_000))
        """,
}

ROLLING_ROBOT = """
    import wpilib

    class MyRobot(wpilib.TimedRobot):
        def robotInit(self):
            self.left, self.right = wpilib.PWMSparkMax(0), wpilib.PWMSparkMax(1)
            self.encoder = wpilib.Encoder(0, 1)
            self.encoder.setDistancePerPulse(1 / 100_000)

        def robotPeriodic(self):
            self.left.set(-1)
            self.right.set(1)
    """

ROLLING_TESTS = """
    import math

    def test_it(control, robot, physics_controller):
        start, _, _ = physics_controller.get_position()
        with control.run_robot():
            control.step_timing(seconds=2, autonomous=False, enabled=True)
            stopped, _, _ = physics_controller.get_position()
            places = []
            for _ in range(250):
                control.step_timing(seconds=0.02, autonomous=False, enabled=False)
                places.append(physics_controller.get_position()[0])
                assert abs(robot.encoder.getDistance() - (places[-1] - start)) < 1e-4
            assert places[0] - stopped > 0.05
            assert all(later >= before for before, later in zip(places, places[1:]))
            assert places[-1] - places[-2] < 0.01  # coming to rest, with full power set
    """


@pytest.mark.parametrize("physics", sampled(ROLLS, "tank model, documented"))
def test_wheels_that_roll_out_move_encoders_and_pose_alike(physics: str, make_project) -> None:
    project = make_project({"robot.py": ROLLING_ROBOT, "physics.py": ROLLS[physics], "tests/test_it.py": ROLLING_TESTS})
    result = project.run("test")
    assert result.code == 0, result.output


SUBSYSTEM_ROBOT = """
    import commands2
    import wpilib
    from wpilib.simulation import PWMSim

    class Arm(commands2.Subsystem):
        def __init__(self):
            self.motor = wpilib.PWMSparkMax(0)
            self.seen = []

        def periodic(self):
            self.motor.set(1)

        def simulationPeriodic(self):
            self.seen.append((PWMSim(0).getSpeed(), self.motor.get()))

    class MyRobot(commands2.TimedCommandRobot):
        def robotInit(self):
            self.arm = Arm()
    """

SUBSYSTEM_TESTS = """
    def test_it(control, robot):
        with control.run_robot():
            control.step_timing(seconds=1, autonomous=False, enabled=False)
            assert set(robot.arm.seen) == {(0.0, 0.0)}
            assert robot.arm.motor.get() == 1
            control.step_timing(seconds=0.1, autonomous=False, enabled=True)
            assert robot.arm.seen[-1] == (1.0, 1.0)
    """


def test_physics_in_a_subsystem_sees_them_off_too(make_project) -> None:
    project = make_project({"robot.py": SUBSYSTEM_ROBOT, "tests/test_it.py": SUBSYSTEM_TESTS})
    result = project.run("test")
    assert result.code == 0, result.output


def test_a_simulated_robot_stands_still_after_the_emergency_stop(make_project) -> None:
    project = make_project({"robot.py": ROBOT, "physics.py": TODAYS})
    with Simulation(Project(project.path / "robot.py"), SimOptions(paused=True, speed=0)) as simulation:
        settle(simulation)
        places = []
        for prepare in (lambda: None, simulation.enable, simulation.emergency_stop, lambda: None):
            prepare()
            run(simulation, 0.5)
            assert simulation.snapshot is not None
            places.append(simulation.snapshot.scene.robot[0])
            assert simulation.snapshot.values["pwm[0].value"] == 0.5
    start, driven, stopped, later = places
    assert start < driven
    assert driven == stopped == later


# -- single outputs ----------------------------------------------------------------------------------------------------


@pytest.fixture
def gate() -> Iterator[OutputGate]:
    """Of a robot that is disabled."""
    station.reset_driver_station()
    yield OutputGate()
    hs.resetDriverStationData()


def test_what_a_vendors_model_writes_meanwhile_stays(gate: OutputGate) -> None:
    device = hal.SimDevice("SPARK MAX [41]")
    applied = device.createDouble("Applied Output", hal.SimDevice.Direction.kOutput, 0.5)
    for written in (0.0, 0.25):
        applied.set(0.5)
        with gate.closed_while_disabled():
            assert applied.get() == 0
            applied.set(written)
        assert applied.get() == written


def test_sensors_and_settings_of_a_motor_controller_stay(gate: OutputGate) -> None:
    names = {"SPARK MAX [42]": ["Velocity", "Position"], "CANEncoder:Talon FX (v6)[3]/Rotor Sensor": ["velocity"]}
    devices = {name: hal.SimDevice(name) for name in names}
    values = [
        devices[name].createDouble(value, hal.SimDevice.Direction.kBidir, 1.5)
        for name, its in names.items()
        for value in its
    ]
    values.append(devices["SPARK MAX [42]"].createDouble("Bus Voltage", hal.SimDevice.Direction.kOutput, 1.5))
    with gate.closed_while_disabled():
        assert [value.get() for value in values] == [1.5] * len(values)


def test_an_error_in_physics_leaves_what_the_code_set(gate: OutputGate) -> None:
    device = hal.SimDevice("CANMotor:Talon FX (v6)[43]")
    duty_cycle = device.createDouble("dutyCycle", hal.SimDevice.Direction.kOutput, -0.5)

    def physics() -> None:
        with gate.closed_while_disabled():
            assert duty_cycle.get() == 0
            _ = 1 / 0

    with pytest.raises(ZeroDivisionError):
        physics()
    assert duty_cycle.get() == -0.5
