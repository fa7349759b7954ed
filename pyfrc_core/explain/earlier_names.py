"""Names of earlier seasons, and what replaces them."""

from __future__ import annotations

from .other_season import in_2027


def _spark(setting: str) -> str:
    """Return how a motor controller of REV is set up: all settings at once."""
    once = "MOTOR.configure(config, rev.ResetMode.kResetSafeParameters, rev.PersistMode.kPersistParameters)"
    return f"config = rev.SparkMaxConfig(); config.{setting}; and once, with all settings: {once}"


def _all(names: str, instead: str) -> dict[str, str]:
    return dict.fromkeys(names.split(), instead)


#: Names of earlier seasons: what to write instead.
GONE = {
    # wpilib
    **_all("IterativeRobot SampleRobot", "wpilib.TimedRobot"),
    "RobotDrive": "wpilib.drive.DifferentialDrive",
    "SpeedController": "wpilib.interfaces.MotorController",
    "SpeedControllerGroup": "wpilib.MotorControllerGroup",
    "Victor": "wpilib.PWMVictorSPX",
    "Jaguar": "wpilib.PWMSparkMax",
    "PWMSpark": "wpilib.Spark",
    "PWMVictorSP": "wpilib.VictorSP",
    "PWMTalon": "wpilib.PWMTalonSRX",
    "PIDController": "wpimath.controller.PIDController",
    "PowerDistributionPanel": "wpilib.PowerDistribution",
    "AddressableLEDBuffer": "[wpilib.AddressableLED.LEDData() for _ in range(60)]",
    "PIDController.get": "calculate(measurement)",
    "CameraServer.startAutomaticCapture": "wpilib.CameraServer.launch()",
    "GearTooth": "wpilib.Counter",
    "Shuffleboard": "wpilib.SmartDashboard",
    "Filesystem": "wpilib.getDeployDirectory() and wpilib.getOperatingDirectory()",
    "command": "the package commands2",
    "Hand": "getLeftX(), getRightX(), getLeftY() and getRightY()",
    "GenericHID.getX": "getLeftX() or getRightX()",
    "GenericHID.getY": "getLeftY() or getRightY()",
    "GenericHID.getButton": "getRawButton(number), or the buttons by name, such as getAButton()",
    "GenericHID.POV": "getPOV(), an angle in degrees: 0 is up, 90 right, and -1 that none is pressed",
    "Timer.delay": "timer.get() or hasElapsed(seconds), asked each time: a robot that waits does nothing else",
    "PWMMotorController.follow": "LEADER.addFollower(FOLLOWER)",
    **_all("DutyCycleEncoder.getAbsolutePosition AnalogEncoder.getAbsolutePosition", "get(), in turns from 0 to 1"),
    "DutyCycleEncoder.getDistance": "get(), in turns from 0 to 1, and your own factor",
    **_all(
        "DutyCycleEncoder.setDistancePerRotation DutyCycleEncoder.reset",
        "DutyCycleEncoder(channel, fullRange, expectedZero)",
    ),
    "DifferentialDrive.setRightSideInverted": "setInverted(True) of the right motor",
    **_all("NetworkTableInstance.getInstance NetworkTables", "ntcore.NetworkTableInstance.getDefault()"),
    "Compressor.start": "enableDigital()",
    "setClosedLoopControl": "enableDigital() or disable()",
    "Command.addSequential": "one.andThen(other)",
    "Command.addParallel": "one.alongWith(other)",
    "setInterruptible": "withInterruptBehavior(commands2.InterruptionBehavior.kCancelIncoming)",
    "hasPeriodPassed": "hasElapsed(seconds), or advanceIfElapsed(seconds) for something that repeats",
    "getInstance": "the methods of the class itself, such as wpilib.DriverStation.isEnabled()",
    "addDefault": "setDefaultOption",
    "addObject": "addOption",
    "setSpeed": "set",
    "isOperatorControl": "isTeleop",
    "getBumper": "getLeftBumper and getRightBumper",
    "getTriggerAxis": "getLeftTriggerAxis and getRightTriggerAxis",
    "getStickButton": "getLeftStickButton and getRightStickButton",
    "isSysBrownedOut": "isBrownedOut",
    **_all("putInt putDouble", "putNumber"),
    "getDouble": "getNumber",
    # commands2
    "CommandBase": "commands2.Command",
    "SubsystemBase": "commands2.Subsystem",
    "Scheduler": "commands2.CommandScheduler",
    **_all("whenPressed whenActive", "onTrue"),
    **_all("whenReleased whenInactive", "onFalse"),
    **_all("whenHeld whileActiveOnce", "whileTrue"),
    **_all("whileHeld whileActiveContinous whileActiveContinuous", "whileTrue(command.repeatedly())"),
    **_all("toggleWhenPressed toggleWhenActive", "toggleOnTrue"),
    "requires": "addRequirements",
    "PerpetualCommand": "commands2.RepeatCommand",
    "perpetually": "repeatedly",
    "withInterrupt": "until",
    "MecanumControllerCommand": "commands2.SwerveControllerCommand or a command of your own",
    # vendors
    "CANSparkMax": "rev.SparkMax",
    "CANSparkMaxLowLevel": "rev.SparkLowLevel",
    "CANSparkFlex": "rev.SparkFlex",
    "CANEncoder": "rev.RelativeEncoder",
    **_all("CANPIDController SparkMaxPIDController SparkPIDController", "rev.SparkClosedLoopController"),
    "getPIDController": "getClosedLoopController",
    "SparkBase.setSmartCurrentLimit": _spark("smartCurrentLimit(40)"),
    "SparkBase.setIdleMode": _spark("setIdleMode(rev.SparkMaxConfig.IdleMode.kBrake)"),
    "SparkBase.follow": _spark("follow(LEADER)"),
    "SparkBase.setOpenLoopRampRate": _spark("openLoopRampRate(0.5)"),
    "SparkBase.enableVoltageCompensation": _spark("voltageCompensation(12)"),
    "setPositionConversionFactor": _spark("encoder.positionConversionFactor(0.05)"),
    "setVelocityConversionFactor": _spark("encoder.velocityConversionFactor(0.05)"),
    "SparkClosedLoopController.setP": _spark("closedLoop.P(0.1)"),
    **_all("SparkBase.restoreFactoryDefaults SparkBase.burnFlash", _spark("inverted(False)")),
    "AHRS_SPI": "navx.AHRS.create_spi()",
    "WPI_TalonFX": "phoenix6.hardware.TalonFX",
    # pyfrc: words of WPILib, where the fixtures have those of 2019
    **_all("TestController.set_teleop TestController.set_teleoperated", "control.set_operator_control(enabled=True)"),
    **_all("TestController.set_disabled TestController.disable", "control.set_operator_control(enabled=False)"),
    "TestController.enable": "control.set_operator_control(enabled=True) or control.set_autonomous(enabled=True)",
    **_all("RobotBase.enable RobotBase.disable", "control.set_operator_control(enabled=True)"),
    "FakeTime.sleep": "fake_time.increment_time_by(seconds), or control.step_timing(...) for a robot that runs",
}


def earlier_name(name: str, owner: type) -> str:
    """Return what replaces a name of earlier seasons in a class; empty if none is known."""
    keys = [f"{base.__name__}.{name}" for base in owner.__mro__] + [name]
    return next((in_2027(GONE[key]) for key in keys if key in GONE), "")
