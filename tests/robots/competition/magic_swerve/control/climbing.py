"""Climb: hook up, drive against the tower, lift."""

from components.climber import Climber
from components.intake import Intake
from components.swerve import Swerve
from magicbot import StateMachine, default_state, state, timed_state


class ClimbControl(StateMachine):
    """Each press of the button goes one step on; the last holds until the match ends."""

    climber: Climber
    intake: Intake
    swerve: Swerve

    def setup(self) -> None:
        """Nothing is lifted yet."""
        self.lifted = False

    def prepare(self) -> None:
        """Raise the hook; call it in each loop."""
        if not self.lifted:
            self.engage("reach")

    def lift(self) -> None:
        """Lift the robot, if the hook is up."""
        if self.current_state == "ready":
            self.next_state("approach")
            self.engage()

    @state(first=True)
    def reach(self) -> None:
        """Raise the hook."""
        self.climber.extend()
        if self.climber.at_goal():
            self.next_state("ready")

    @state(must_finish=True)
    def ready(self) -> None:
        """Wait for the driver."""
        self.swerve.slow = True

    @timed_state(duration=0.5, next_state="pull", must_finish=True)
    def approach(self) -> None:
        """Drive against the tower."""
        self.swerve.drive_robot(-0.4, 0, 0)

    @state(must_finish=True)
    def pull(self) -> None:
        """Lift the robot, and brake."""
        self.swerve.lock()
        self.climber.retract()
        if self.climber.at_goal():
            self.lifted = True
            self.done()

    @default_state
    def hold(self) -> None:
        """Brake whenever nothing moves the hook."""
        self.climber.hold()
