"""Simple drivetrains: compute the robot's motion from its motors' values. Wheels follow their motors at once.

Two generations of callers use the same classes: `get_vector` uses feet and clockwise radians, `calculate` and
`wheelSpeeds` WPILib's metres and counter-clockwise radians. Motor values beyond -1 and 1 count as full power.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from ..wpi import geometry
from .deadzones import DeadzoneCallable, deadzone_function, motor_output
from .parameters import finite, positive
from .pose import METRES_PER_FOOT
from .quantities import magnitude

if TYPE_CHECKING:
    from pint import Quantity


# Bound once: `calculate` is called in each step of physics.
_chassis_speeds = geometry.chassis_speeds_in_feet


class DriveVector(NamedTuple):
    """The robot's motion relative to itself: the tuple (to the right, forward, clockwise) in ft/s and rad/s."""

    vx_fps: float
    vy_fps: float
    vw: float

    @property
    def omega(self) -> float:
        """The counter-clockwise rotation, as in WPILib, in rad/s."""
        return 0.0 - self.vw


class _TankDrivetrain:
    """Two sides whose wheels cannot slip: forward = (L+R)/2, clockwise = (L-R)/W.

    Signs are changed by `0.0 - x`, since `-x` would give a robot at rest a speed of -0.0.
    """

    #: Speed of each side in ft/s after the last calculation, forward positive. Multiplied by the time, it is the
    #: distance of that side's encoder.
    l_speed: float = 0.0
    r_speed: float = 0.0

    def __init__(
        self,
        x_wheelbase: float | Quantity[Any] = 2,
        speed: float | Quantity[Any] = 5,
        deadzone: DeadzoneCallable | None = None,
    ) -> None:
        """
        :param x_wheelbase: distance between left and right wheels, in feet or as a quantity
        :param speed: the robot's speed at full power, in ft/s or as a quantity
        :param deadzone: a motor's output as a function of its input, such as the result of :func:`linear_deadzone`
        :raises ParameterError: for a length or speed that is not above zero, or a deadzone that is not a function
        """
        #: In feet and ft/s; both may be changed.
        self.x_wheelbase = _feet(x_wheelbase, "x_wheelbase")
        self.speed = _feet_per_second(speed)
        self.deadzone = deadzone_function(deadzone)

    @property
    def kinematics(self) -> geometry.DifferentialDriveKinematics:
        """WPILib's kinematics for a robot of this width."""
        return geometry.tank_kinematics(self.x_wheelbase * METRES_PER_FOOT)

    @property
    def wheelSpeeds(self) -> geometry.DifferentialDriveWheelSpeeds:
        """Speed of each side in m/s after the last calculation, forward positive."""
        return geometry.tank_wheel_speeds_in_feet(self.l_speed, self.r_speed)

    def _vector(self, left: float, right: float) -> tuple[float, float]:
        """Return the speed forward in ft/s and clockwise in rad/s.

        :param left: the left side's share of full speed, forward positive
        :param right: the right side's share of full speed, forward positive
        """
        self.l_speed = left = left * self.speed
        self.r_speed = right = right * self.speed
        return (left + right) * 0.5, (left - right) / self.x_wheelbase

    def _chassis(self, left: float, right: float) -> geometry.ChassisSpeeds:
        forward, clockwise = self._vector(left, right)
        return _chassis_speeds(forward, 0.0, 0.0 - clockwise)


class TwoMotorDrivetrain(_TankDrivetrain):
    """A motor on each side: forward = (L+R)/2, clockwise = (L-R)/W."""

    def get_vector(self, l_motor: float, r_motor: float) -> tuple[float, float]:
        """
        :param l_motor: left motor, -1 to 1; -1 is forward
        :param r_motor: right motor, -1 to 1; 1 is forward
        :returns: speed of the robot in ft/s, its clockwise rotation in rad/s
        :raises ParameterError: for NaN
        """
        left = motor_output(l_motor, "l_motor", self.deadzone)
        return self._vector(0.0 - left, motor_output(r_motor, "r_motor", self.deadzone))

    def calculate(self, l_motor: float, r_motor: float) -> geometry.ChassisSpeeds:
        """
        :param l_motor: left motor, -1 to 1; 1 is forward
        :param r_motor: right motor, -1 to 1; -1 is forward
        :returns: speed of the robot in m/s and rad/s, counter-clockwise
        :raises ParameterError: for NaN
        """
        left = motor_output(l_motor, "l_motor", self.deadzone)
        return self._chassis(left, 0.0 - motor_output(r_motor, "r_motor", self.deadzone))


class FourMotorDrivetrain(_TankDrivetrain):
    """Two coupled motors on each side: a side moves at their mean. Otherwise like :class:`TwoMotorDrivetrain`."""

    def get_vector(self, lr_motor: float, rr_motor: float, lf_motor: float, rf_motor: float) -> tuple[float, float]:
        """
        :param lr_motor: left rear motor, -1 to 1; -1 is forward
        :param rr_motor: right rear motor, -1 to 1; 1 is forward
        :param lf_motor: left front motor, -1 to 1; -1 is forward
        :param rf_motor: right front motor, -1 to 1; 1 is forward
        :returns: speed of the robot in ft/s, its clockwise rotation in rad/s
        :raises ParameterError: for NaN
        """
        left, right = self._sides(lf_motor, lr_motor, rf_motor, rr_motor)
        return self._vector(0.0 - left, right)

    def calculate(self, lf_motor: float, lr_motor: float, rf_motor: float, rr_motor: float) -> geometry.ChassisSpeeds:
        """
        :param lf_motor: left front motor, -1 to 1; 1 is forward
        :param lr_motor: left rear motor, -1 to 1; 1 is forward
        :param rf_motor: right front motor, -1 to 1; -1 is forward
        :param rr_motor: right rear motor, -1 to 1; -1 is forward
        :returns: speed of the robot in m/s and rad/s, counter-clockwise
        :raises ParameterError: for NaN
        """
        left, right = self._sides(lf_motor, lr_motor, rf_motor, rr_motor)
        return self._chassis(left, 0.0 - right)

    def _sides(self, lf: float, lr: float, rf: float, rr: float) -> tuple[float, float]:
        deadzone = self.deadzone
        left = motor_output(lf, "lf_motor", deadzone) + motor_output(lr, "lr_motor", deadzone)
        right = motor_output(rf, "rf_motor", deadzone) + motor_output(rr, "rr_motor", deadzone)
        return left * 0.5, right * 0.5


class MecanumDrivetrain:
    """Four mecanum wheels with rollers at 45°, with a motor each.

    To move to the right and forward in ft/s while turning clockwise in rad/s, the wheels turn at::

        left front  = forward + right + k * clockwise
        left rear   = forward - right + k * clockwise
        right front = forward - right - k * clockwise
        right rear  = forward + right - k * clockwise

    with k = (x_wheelbase + y_wheelbase) / 2. (Source: Ether, "Kinematic Analysis of Four-Wheel Mecanum Vehicle"; the
    same as WPILib's `MecanumDriveKinematics`.) Inconsistent wheels slip: there are four equations for three unknowns.
    The columns are orthogonal, so the least-squares solution is each column's product with the wheels, divided by the
    column's square.
    """

    def __init__(
        self,
        x_wheelbase: float | Quantity[Any] = 2,
        y_wheelbase: float | Quantity[Any] = 3,
        speed: float | Quantity[Any] = 5,
        deadzone: DeadzoneCallable | None = None,
    ) -> None:
        """
        :param x_wheelbase: distance between left and right wheels, in feet or as a quantity
        :param y_wheelbase: distance between front and rear wheels, in feet or as a quantity
        :param speed: the robot's speed at full power, in ft/s or as a quantity
        :param deadzone: a motor's output as a function of its input, such as the result of :func:`linear_deadzone`
        :raises ParameterError: for a length or speed that is not above zero, or a deadzone that is not a function
        """
        #: In feet and ft/s; all three may be changed.
        self.x_wheelbase = _feet(x_wheelbase, "x_wheelbase")
        self.y_wheelbase = _feet(y_wheelbase, "y_wheelbase")
        self.speed = _feet_per_second(speed)
        self.deadzone = deadzone_function(deadzone)
        #: Speed of each wheel in ft/s after the last calculation, forward positive, for encoders.
        self.lf_speed = self.lr_speed = self.rf_speed = self.rr_speed = 0.0

    def get_vector(self, lr_motor: float, rr_motor: float, lf_motor: float, rf_motor: float) -> DriveVector:
        """
        :param lr_motor: left rear motor, -1 to 1; 1 is forward
        :param rr_motor: right rear motor, -1 to 1; 1 is forward
        :param lf_motor: left front motor, -1 to 1; 1 is forward
        :param rf_motor: right front motor, -1 to 1; 1 is forward
        :returns: speed of the robot to the right and forward in ft/s, its clockwise rotation in rad/s
        :raises ParameterError: for NaN
        """
        lf, lr, rf, rr = self._outputs(lf_motor, lr_motor, rf_motor, rr_motor, right_forward=1.0)
        linear = self.speed / 4
        right, forward = (lf - lr - rf + rr) * linear, (lf + lr + rf + rr) * linear
        return DriveVector(right, forward, (lf + lr - rf - rr) * self._angular())

    def calculate(self, lf_motor: float, lr_motor: float, rf_motor: float, rr_motor: float) -> geometry.ChassisSpeeds:
        """
        :param lf_motor: left front motor, -1 to 1; 1 is forward
        :param lr_motor: left rear motor, -1 to 1; 1 is forward
        :param rf_motor: right front motor, -1 to 1; -1 is forward
        :param rr_motor: right rear motor, -1 to 1; -1 is forward
        :returns: speed of the robot in m/s and rad/s, counter-clockwise
        :raises ParameterError: for NaN
        """
        lf, lr, rf, rr = self._outputs(lf_motor, lr_motor, rf_motor, rr_motor, right_forward=-1.0)
        rising = lf - rr
        falling = lr - rf
        linear = self.speed / 4
        left, forward = (falling - rising) * linear, (rising + falling) * linear
        return _chassis_speeds(forward, left, (0.0 - lf - lr - rf - rr) * self._angular())

    def _angular(self) -> float:
        return self.speed / (2 * (self.x_wheelbase + self.y_wheelbase))

    def _outputs(
        self, lf: float, lr: float, rf: float, rr: float, right_forward: float
    ) -> tuple[float, float, float, float]:
        """Return the motors' outputs, and set the wheels' speeds.

        :param right_forward: the sign of forward on the right
        """
        deadzone = self.deadzone
        lf, lr = motor_output(lf, "lf_motor", deadzone), motor_output(lr, "lr_motor", deadzone)
        rf, rr = motor_output(rf, "rf_motor", deadzone), motor_output(rr, "rr_motor", deadzone)
        self.lf_speed, self.lr_speed = lf * self.speed, lr * self.speed
        self.rf_speed, self.rr_speed = rf * self.speed * right_forward, rr * self.speed * right_forward
        return lf, lr, rf, rr

    @property
    def wheelSpeeds(self) -> geometry.MecanumDriveWheelSpeeds:
        """Speed of each wheel in m/s after the last calculation, forward positive."""
        return geometry.mecanum_wheel_speeds_in_feet(self.lf_speed, self.rf_speed, self.lr_speed, self.rr_speed)

    @property
    def kinematics(self) -> geometry.MecanumDriveKinematics:
        """WPILib's kinematics for a robot of these dimensions."""
        return geometry.mecanum_kinematics(
            self.y_wheelbase / 2 * METRES_PER_FOOT, self.x_wheelbase / 2 * METRES_PER_FOOT
        )


def four_motor_swerve_drivetrain(
    lr_motor: float,
    rr_motor: float,
    lf_motor: float,
    rf_motor: float,
    lr_angle: float,
    rr_angle: float,
    lf_angle: float,
    rf_angle: float,
    x_wheelbase: float | Quantity[Any] = 2,
    y_wheelbase: float | Quantity[Any] = 2,
    speed: float | Quantity[Any] = 5,
    deadzone: DeadzoneCallable | None = None,
) -> DriveVector:
    """Return the motion of a robot with four motors, each of which can be turned in any direction.

    A wheel at (x to the right, y forward) of the centre of a robot that moves and turns clockwise moves at::

        right + clockwise * y, forward - clockwise * x

    (rigid body motion, the same as WPILib's `SwerveDriveKinematics`). That makes eight equations for three unknowns.
    The wheels are placed symmetrically, so the columns are orthogonal, and the least-squares solution is each column's
    product with the wheels, divided by the column's square.

    :param lr_motor: left rear motor, -1 to 1; 1 is forward. `rr_motor`, `lf_motor`, `rf_motor` likewise
    :param lr_angle: left rear wheel, in degrees clockwise from forward. `rr_angle`, `lf_angle`, `rf_angle` likewise
    :param x_wheelbase: distance between left and right wheels, in feet or as a quantity
    :param y_wheelbase: distance between front and rear wheels, in feet or as a quantity
    :param speed: the robot's speed at full power, in ft/s or as a quantity
    :param deadzone: a motor's output as a function of its input, such as the result of :func:`linear_deadzone`
    :returns: speed of the robot to the right and forward in ft/s, its clockwise rotation in rad/s
    :raises ParameterError: for a length or speed that is not above zero, a deadzone that is not a function, NaN
    """
    half_x = _feet(x_wheelbase, "x_wheelbase") / 2
    half_y = _feet(y_wheelbase, "y_wheelbase") / 2
    full_speed = _feet_per_second(speed)
    deadzone = deadzone_function(deadzone)
    right = forward = moment = 0.0
    for name, motor, angle, x, y in (
        ("lr", lr_motor, lr_angle, -half_x, -half_y),
        ("rr", rr_motor, rr_angle, half_x, -half_y),
        ("lf", lf_motor, lf_angle, -half_x, half_y),
        ("rf", rf_motor, rf_angle, half_x, half_y),
    ):
        wheel_speed = motor_output(motor, f"{name}_motor", deadzone) * full_speed
        direction = math.radians(finite(angle, f"{name}_angle"))
        to_right, to_front = wheel_speed * math.sin(direction), wheel_speed * math.cos(direction)
        right += to_right
        forward += to_front
        moment += y * to_right - x * to_front
    return DriveVector(right / 4, forward / 4, moment / (4 * (half_x**2 + half_y**2)))


#: The documentation uses this spelling in one place.
four_motor_serve_drivetrain = four_motor_swerve_drivetrain


def _feet(length: float | Quantity[Any], parameter: str) -> float:
    return positive(magnitude(length, "foot", parameter, plain=True), parameter)


def _feet_per_second(speed: float | Quantity[Any]) -> float:
    return positive(magnitude(speed, "foot / second", "speed", plain=True), "speed")
