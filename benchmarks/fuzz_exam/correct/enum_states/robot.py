"""A scoring mechanism as a state machine with an enumeration; each state has a way out, also without its sensor."""

import enum

import wpilib


class State(enum.Enum):
    EMPTY = enum.auto()
    COLLECTING = enum.auto()
    LOADED = enum.auto()
    SCORING = enum.auto()
    CLEARING = enum.auto()


class MyRobot(wpilib.TimedRobot):
    def robotInit(self) -> None:
        self.rollers = wpilib.PWMVictorSPX(0)
        self.kicker = wpilib.PWMVictorSPX(1)
        self.beam = wpilib.DigitalInput(0)
        self.gamepad = wpilib.XboxController(0)
        self.timer = wpilib.Timer()
        self.state = State.EMPTY
        self.enter(State.EMPTY)

    def enter(self, state: State) -> None:
        """Go to a state."""
        self.state = state
        self.timer.restart()

    def seconds(self) -> float:
        """Return for how long the state has lasted."""
        return self.timer.get()

    def step(self, collect: bool, score: bool, cancel: bool) -> None:
        """Do one step of the machine."""
        rollers = kicker = 0.0
        loaded = not self.beam.get()
        if cancel:
            self.enter(State.CLEARING)
        if self.state is State.EMPTY:
            if loaded:
                self.enter(State.LOADED)
            elif collect:
                self.enter(State.COLLECTING)
        elif self.state is State.COLLECTING:
            rollers = 0.7
            if loaded:
                self.enter(State.LOADED)
            elif not collect or self.seconds() > 5.0:
                self.enter(State.EMPTY)
        elif self.state is State.LOADED:
            if score:
                self.enter(State.SCORING)
            elif not loaded and self.seconds() > 0.5:
                self.enter(State.EMPTY)
        elif self.state is State.SCORING:
            rollers, kicker = 0.5, 1.0
            if self.seconds() > 0.8:
                self.enter(State.EMPTY)
        elif self.state is State.CLEARING:
            rollers = -0.8
            if self.seconds() > 0.6:
                self.enter(State.EMPTY)
        self.rollers.set(rollers)
        self.kicker.set(kicker)

    def robotPeriodic(self) -> None:
        wpilib.SmartDashboard.putString("State", self.state.name)

    def autonomousInit(self) -> None:
        self.enter(State.LOADED)

    def autonomousPeriodic(self) -> None:
        self.step(False, True, False)

    def teleopInit(self) -> None:
        self.enter(State.EMPTY)

    def teleopPeriodic(self) -> None:
        self.step(self.gamepad.getAButton(), self.gamepad.getRightBumper(), self.gamepad.getBButton())

    def stop(self) -> None:
        self.rollers.set(0.0)
        self.kicker.set(0.0)

    def disabledInit(self) -> None:
        self.stop()

    def testInit(self) -> None:
        self.stop()
