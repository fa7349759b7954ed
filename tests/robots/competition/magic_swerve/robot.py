#!/usr/bin/env python3
"""A swerve robot that collects balls, shoots them and climbs, built with magicbot."""

import constants
import magicbot
import rev
import wpilib
from components.climber import Climber
from components.diagnostics import Diagnostics
from components.indexer import Indexer
from components.intake import Intake
from components.lights import Lights
from components.shooter import Shooter
from components.swerve import Swerve
from components.swerve_module import SwerveModule
from control.climbing import ClimbControl
from control.collecting import CollectControl
from control.shooting import ShootControl
from magicbot import tunable
from wpimath import applyDeadband


class MyRobot(magicbot.MagicRobot):
    """Creates the devices, which magicbot gives to the components by name."""

    # State machines decide before the mechanisms move.
    shoot_control: ShootControl
    collect_control: CollectControl
    climb_control: ClimbControl

    swerve: Swerve
    intake: Intake
    indexer: Indexer
    shooter: Shooter
    climber: Climber
    lights: Lights
    diagnostics: Diagnostics

    max_speed = tunable(4.0)
    max_turn = tunable(5.0)

    def createObjects(self) -> None:
        """Create all devices."""
        wpilib.DataLogManager.start()
        wpilib.DriverStation.startDataLog(wpilib.DataLogManager.getLog())

        self.driver = wpilib.XboxController(0)
        self.operator = wpilib.XboxController(1)

        self.gyro = wpilib.ADXRS450_Gyro()
        self.swerve_modules = [SwerveModule(name) for name in constants.MODULES]
        self.field = wpilib.Field2d()
        wpilib.SmartDashboard.putData("Field", self.field)

        self.intake_roller = rev.SparkMax(constants.INTAKE_ROLLER, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.smartCurrentLimit(40).openLoopRampRate(0.1)
        self.configure(self.intake_roller, config)
        self.intake_pivot = wpilib.PWMTalonFX(constants.PWM_INTAKE_PIVOT)
        self.intake_potentiometer = wpilib.AnalogPotentiometer(
            constants.ANALOG_INTAKE_PIVOT,
            constants.INTAKE_POTENTIOMETER_RANGE,
            constants.INTAKE_POTENTIOMETER_OFFSET,
        )

        self.indexer_belt = wpilib.PWMVictorSPX(constants.PWM_INDEXER)
        self.indexer_belt.setInverted(True)
        self.indexer_entry = wpilib.DigitalInput(constants.DIO_INDEXER_ENTRY)
        self.indexer_exit = wpilib.DigitalInput(constants.DIO_INDEXER_EXIT)

        self.shooter_left = rev.SparkMax(constants.SHOOTER_LEFT, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.smartCurrentLimit(60).voltageCompensation(12).setIdleMode(rev.SparkMaxConfig.IdleMode.kCoast)
        config.closedLoop.pid(0.0003, 0, 0)
        self.configure(self.shooter_left, config)
        self.shooter_right = rev.SparkMax(constants.SHOOTER_RIGHT, rev.SparkMax.MotorType.kBrushless)
        config = rev.SparkMaxConfig()
        config.smartCurrentLimit(60).follow(self.shooter_left, True)
        self.configure(self.shooter_right, config)
        self.shooter_hood = wpilib.Servo(constants.PWM_HOOD)

        self.climber_left = wpilib.PWMSparkMax(constants.PWM_CLIMBER_LEFT)
        self.climber_right = wpilib.PWMSparkMax(constants.PWM_CLIMBER_RIGHT)
        self.climber_left.addFollower(self.climber_right)
        self.climber_encoder = wpilib.Encoder(constants.DIO_CLIMBER_A, constants.DIO_CLIMBER_B)
        self.climber_encoder.setDistancePerPulse(
            2 * 3.14159265 * constants.CLIMBER_DRUM / constants.CLIMBER_GEARING / constants.CLIMBER_COUNTS * 4
        )
        self.climber_bottom = wpilib.DigitalInput(constants.DIO_CLIMBER_BOTTOM)
        self.climber_brake = wpilib.Solenoid(
            constants.PNEUMATICS, wpilib.PneumaticsModuleType.REVPH, constants.SOLENOID_CLIMBER_BRAKE
        )
        self.pneumatics = wpilib.PneumaticHub(constants.PNEUMATICS)
        self.pdh = wpilib.PowerDistribution(constants.POWER_DISTRIBUTION, wpilib.PowerDistribution.ModuleType.kRev)

        self.sparks = {f"{module.name} drive": module.drive for module in self.swerve_modules}
        self.sparks |= {f"{module.name} steering": module.steer for module in self.swerve_modules}
        self.sparks |= {"shooter left": self.shooter_left, "shooter right": self.shooter_right}
        self.sparks["intake"] = self.intake_roller

        self.start_chooser = wpilib.SendableChooser()
        self.start_chooser.setDefaultOption("Center", "Center")
        self.start_chooser.addOption("Left", "Left")
        self.start_chooser.addOption("Right", "Right")
        wpilib.SmartDashboard.putData("Start", self.start_chooser)
        self.drive_chooser = wpilib.SendableChooser()
        self.drive_chooser.setDefaultOption("Field", True)
        self.drive_chooser.addOption("Robot", False)
        wpilib.SmartDashboard.putData("Driving as seen from", self.drive_chooser)

    @staticmethod
    def configure(spark: rev.SparkMax, config: rev.SparkMaxConfig) -> None:
        """Store a configuration in a SPARK MAX."""
        error = spark.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)
        if error != rev.REVLibError.kOk:
            wpilib.reportWarning(f"SPARK MAX {spark.getDeviceId()} is not configured: {error}")

    # -- each loop ---------------------------------------------------------------------------------------------------

    def robotPeriodic(self) -> None:
        """Look at the sensors in every mode."""
        self.swerve.update_odometry()
        self.indexer.count()
        self.climber.check_bottom()
        self.diagnostics.check()
        self.lights.show()

    def disabledPeriodic(self) -> None:
        """Show on the dashboard where the autonomous mode will begin."""
        start = constants.STARTS[self.start_chooser.getSelected() or "Center"]
        self.field.getObject("start").setPose(start)

    def teleopInit(self) -> None:
        """Tell the drivers that it begins."""
        self.driver.setRumble(wpilib.XboxController.RumbleType.kBothRumble, 0)

    def teleopPeriodic(self) -> None:
        """Read both gamepads."""
        with self.consumeExceptions():
            self.drive_with_sticks()
        with self.consumeExceptions():
            self.operate()

    def drive_with_sticks(self) -> None:
        """The driver's gamepad: sticks drive, the right trigger shoots."""
        x, y, turn = (
            applyDeadband(-value, 0.08) * abs(value)
            for value in (self.driver.getLeftY(), self.driver.getLeftX(), self.driver.getRightX())
        )
        x, y, turn = x * self.max_speed, y * self.max_speed, turn * self.max_turn
        if wpilib.DriverStation.getAlliance() == wpilib.DriverStation.Alliance.kRed:
            x, y = -x, -y
        self.swerve.slow = self.driver.getLeftBumper()
        if self.driver.getXButton():
            self.swerve.lock()
        elif self.driver.getRightTriggerAxis() > 0.5:
            self.shoot_control.shoot(0.4 * x, 0.4 * y)
        elif self.drive_chooser.getSelected() is False:
            self.swerve.drive_robot(x, y, turn)
        else:
            self.swerve.drive_field(x, y, turn)
        if self.driver.getStartButtonPressed():
            self.gyro.reset()

    def operate(self) -> None:
        """The operator's gamepad: collecting, preparing shots, climbing."""
        if self.operator.getAButton():
            self.collect_control.collect()
        elif self.operator.getBButton():
            self.intake.eject()
            self.indexer.reverse()
        if self.operator.getRightBumper():
            self.shooter.idle()
        if self.operator.getPOV() == 0:
            self.climb_control.prepare()
        elif self.operator.getPOV() == 180:
            self.climb_control.lift()
        full = self.indexer.is_full() and self.operator.getAButton()
        self.operator.setRumble(wpilib.XboxController.RumbleType.kBothRumble, 0.6 if full else 0)
