"""How a shot goes: get the wheel up to its speed, then feed the ball."""

from magicbot import StateMachine, state, timed_state

from components.shooter import Shooter


class ShooterControl(StateMachine):
    """Call `fire` for as long as you want to shoot; each state is one step of it."""

    shooter: Shooter

    def fire(self) -> None:
        """Shoot; when this is no longer called, the shot that has begun is finished."""
        self.engage()

    @state(first=True)
    def spin_up(self) -> None:
        """Wait for the wheel."""
        self.shooter.spin()
        if self.shooter.is_ready():
            self.next_state("push")

    @timed_state(duration=0.5, must_finish=True, next_state="spin_up")
    def push(self) -> None:
        """Push a ball into the wheel, for half a second."""
        self.shooter.spin()
        self.shooter.feed()
