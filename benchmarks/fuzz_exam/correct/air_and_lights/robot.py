"""Pneumatics and an LED strip."""

import wpilib

COUNT = 40


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        kind = wpilib.PneumaticsModuleType.REVPH
        self.hub = wpilib.PneumaticHub(1)
        self.hub.enableCompressorDigital()
        self.claw = wpilib.DoubleSolenoid(1, kind, 0, 1)
        self.claw.set(wpilib.DoubleSolenoid.Value.kReverse)  # toggle() needs a first state
        self.lift = wpilib.Solenoid(1, kind, 2)
        self.touch = wpilib.DigitalInput(0)
        self.gamepad = wpilib.XboxController(0)
        self.strip = wpilib.AddressableLED(9)
        self.strip.setLength(COUNT)
        self.buffer = [wpilib.AddressableLED.LEDData() for _ in range(COUNT)]
        self.strip.setData(self.buffer)
        self.strip.start()
        self.touched_since: float | None = None

    def colour(self) -> tuple[int, int, int]:
        """Return the colour for the alliance; white while it is unknown."""
        alliance = wpilib.DriverStation.getAlliance()
        if self.touched_since is not None:
            return 0, 200, 0
        if alliance == wpilib.DriverStation.Alliance.kRed:
            return 200, 0, 0
        if alliance == wpilib.DriverStation.Alliance.kBlue:
            return 0, 0, 200
        return 90, 90, 90

    def robotPeriodic(self) -> None:
        colour = self.colour()
        lit = COUNT
        left = wpilib.DriverStation.getMatchTime()
        if self.isTeleop() and 0 <= left < 30:
            lit = max(0, min(COUNT, round(COUNT * left / 30)))
        for index, led in enumerate(self.buffer):
            led.setRGB(*(colour if index < lit else (0, 0, 0)))
        self.strip.setData(self.buffer)
        wpilib.SmartDashboard.putNumber("Pressure", self.hub.getPressure(0))

    def autonomousInit(self) -> None:
        self.claw.set(wpilib.DoubleSolenoid.Value.kForward)
        self.touched_since = None

    def teleopInit(self) -> None:
        self.touched_since = None
        self.gamepad.getAButtonPressed()

    def teleopPeriodic(self) -> None:
        if self.gamepad.getAButtonPressed():
            self.claw.toggle()
            self.touched_since = None
        self.lift.set(self.gamepad.getRightTriggerAxis() > 0.5)
        now = wpilib.Timer.getFPGATimestamp()
        if self.touch.get():
            self.touched_since = None
        elif self.touched_since is None:
            self.touched_since = now
        elif now - self.touched_since > 0.1 and self.claw.get() == wpilib.DoubleSolenoid.Value.kReverse:
            self.claw.set(wpilib.DoubleSolenoid.Value.kForward)

    def disabledInit(self) -> None:
        self.lift.set(False)
