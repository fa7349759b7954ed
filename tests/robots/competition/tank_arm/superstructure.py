"""Elevator, arm and wrist together: the arm folds in before the elevator goes down."""

import commands2
import commands2.cmd
from subsystems.arm import ArmAndWrist
from subsystems.elevator import ElevatorLift


class Superstructure:
    """Commands that move elevator, arm and wrist together."""

    def __init__(self, elevator: ElevatorLift, arm: ArmAndWrist) -> None:
        self.elevator = elevator
        self.arm = arm

    def go_to(self, position: tuple[float, float, float], name: str) -> commands2.Command:
        """Make a command that goes to a position: the elevator first if it goes up, the arm first if it goes down."""
        metres, arm_degrees, wrist_degrees = position
        going_up = commands2.cmd.sequence(
            self.elevator.move_to(metres), self.arm.move_to(arm_degrees, wrist_degrees).withTimeout(2)
        )
        going_down = commands2.cmd.sequence(
            self.arm.move_to(arm_degrees, wrist_degrees).withTimeout(2), self.elevator.move_to(metres)
        )
        return commands2.cmd.either(going_up, going_down, lambda: metres > self.elevator.height()).withName(name)

    def nudge(self, metres: float) -> commands2.Command:
        """Make a command that moves the elevator a little."""
        return commands2.cmd.runOnce(lambda: self.elevator.set_goal(self.elevator.goal + metres), self.elevator)
