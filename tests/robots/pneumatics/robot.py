"""A robot with air: a gripper, a shifter, a climber's brake, and the sensors around them."""

import wpilib


class MyRobot(wpilib.TimedRobot):
    """Closes its gripper by itself when something touches the switch inside."""

    def robotInit(self) -> None:
        """Create the devices; the climber's valve sits on a module of the other make."""
        ctre = wpilib.PneumaticsModuleType.CTREPCM
        self.compressor = wpilib.Compressor(0, ctre)
        self.gripper = wpilib.DoubleSolenoid(0, ctre, 0, 1)
        self.shifter = wpilib.Solenoid(0, ctre, 2)
        self.brake = wpilib.Solenoid(1, wpilib.PneumaticsModuleType.REVPH, 0)

        self.lift_motor = wpilib.PWMSparkMax(0)
        self.lift_encoder = wpilib.Encoder(0, 1)
        self.lift_encoder.setDistancePerPulse(0.01)  # 100 counts are a metre
        # The switch pulls its input to ground when something presses it.
        self.grip_switch = wpilib.DigitalInput(2)
        self.wrist = wpilib.AnalogPotentiometer(0, 270.0)
        self.gyro = wpilib.ADXRS450_Gyro()

        self.gamepad = wpilib.Joystick(0)
        self.grips = 0

    def autonomousInit(self) -> None:
        """Start with an open gripper, the brake on."""
        self.gripper.set(wpilib.DoubleSolenoid.Value.kReverse)
        self.brake.set(True)

    def autonomousPeriodic(self) -> None:
        """Lift to half a metre."""
        self.lift_motor.set(1.0 if self.lift_encoder.getDistance() < 0.5 else 0.0)
        self.grip_when_touched()

    def teleopInit(self) -> None:
        """Start with an open gripper, the brake off."""
        self.gripper.set(wpilib.DoubleSolenoid.Value.kReverse)
        self.brake.set(False)
        self.lift_motor.set(0.0)

    def teleopPeriodic(self) -> None:
        """Button 1 opens the gripper, button 2 shifts; 3 is the brake, and each press toggles it."""
        self.shifter.set(self.gamepad.getRawButton(2))
        if self.gamepad.getRawButtonPressed(3):
            self.brake.toggle()
        if self.gamepad.getRawButton(1):
            self.gripper.set(wpilib.DoubleSolenoid.Value.kReverse)
        else:
            self.grip_when_touched()

    def grip_when_touched(self) -> None:
        """Close once when the switch is pressed, and count it."""
        closed = self.gripper.get() == wpilib.DoubleSolenoid.Value.kForward
        if not closed and not self.grip_switch.get():
            self.gripper.set(wpilib.DoubleSolenoid.Value.kForward)
            self.grips += 1

    def disabledPeriodic(self) -> None:
        """Nothing moves while the robot is disabled."""
        self.lift_motor.set(0.0)
