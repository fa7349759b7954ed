"""Find the robot's motors, encoders and gyros, by starting its program."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from ...errors import PyfrcError, RobotCodeError
from ...hal import HalData, rows
from ...processes.crash_report import CrashLog
from ...project import Project
from ...runtime.checks.failures import as_robot_code_error, leave_out_libraries
from ...runtime.checks.hang_detector import HangDetector
from ...runtime.exceptions import TestEnded, TestFroze, TestRanTooLong
from ...runtime.loading import load_robot
from ...runtime.patches.install import patches
from ...runtime.robot import RobotRun
from ...wpi import devices, motor_controllers
from .can_devices import CanDevices, find_can_devices
from .motors import Motor
from .names import DeviceName, NamedDevice, Place, find_devices, find_objects, find_track_width, one_line
from .sticks import Responses, try_sticks
from .swerve_modules import SwerveSurvey, find_swerve

#: How long the robot stays disabled before its devices are counted: some are created in the first loop.
_SETTLING_US = 100_000

#: The limit of robot time, for robots that sleep in their loops.
_LIMIT_US = 10_000_000_000

_FAILURES = (Exception, SystemExit, TestFroze, TestRanTooLong)


@dataclass(frozen=True)
class Encoder:
    """A quadrature encoder.

    :param name: its name in the robot's code
    :param index: its index
    :param channels: its two digital inputs, if they are known
    :param counts: whether the robot uses its count, and never calls `setDistancePerPulse`
    """

    name: DeviceName
    index: int
    channels: tuple[int, int] | None
    counts: bool

    def __str__(self) -> str:
        place = f"DIO {self.channels[0]}, {self.channels[1]}" if self.channels else f"encoder {self.index}"
        return f"{self.name or 'encoder'} ({place})"


@dataclass(frozen=True)
class Gyro:
    """A sensor for the robot's heading, in degrees.

    :param name: its name in the robot's code
    :param channel: an analog gyro's channel; None for a SimDevice
    :param device: the name of the SimDevice
    :param angle: the name of the SimDevice's value with the angle
    :param rate: the name of the SimDevice's value with the rate
    :param clockwise: whether its angle increases clockwise
    :param wraps: whether its angle stays between -180 and 180
    """

    name: DeviceName
    channel: int | None = None
    device: str = ""
    angle: str = ""
    rate: str = ""
    clockwise: bool = True
    wraps: bool = False

    def __str__(self) -> str:
        place = f"analog {self.channel}" if self.channel is not None else one_line(self.device)
        return f"{self.name} ({place})" if self.name else place


@dataclass
class Survey:
    """The devices of a robot."""

    motors: list[Motor] = field(default_factory=list)
    encoders: list[Encoder] = field(default_factory=list)
    gyros: list[Gyro] = field(default_factory=list)
    #: The modules of a swerve drive on vendors' motor controllers.
    swerve: SwerveSurvey = field(default_factory=lambda: SwerveSurvey([], []))
    #: From the left wheels to the right ones, in metres; None if the robot's code does not say it.
    track_width: float | None = None
    #: Devices without known physics, as text.
    others: list[str] = field(default_factory=list)
    #: The names of the channels of each kind, for ``sim/config.json``.
    labels: dict[str, dict[str, str]] = field(default_factory=dict)
    #: The motors' reactions to the joysticks.
    responses: Responses = field(default_factory=dict)
    #: Why the joysticks could not be tested, in a line that names the user's.
    problem: str | None = None


def survey(project: Project, log: CrashLog) -> Survey:
    """Start the robot program, find its devices, then drive it to find the motors that react.

    :param log: where this process, which ends when the robot's code hangs and cannot be stopped, reports it
    :raises RobotCodeError: when the robot's code fails before it can be driven, with the user's line
    """
    patches.install(project.files)
    robot_class = load_robot(project)
    run = RobotRun()
    hang_seconds = project.settings.test.hang_seconds
    with HangDetector(project.files, hang_seconds, log).watching():
        try:
            run.open()
            run.clock.limit_us = _LIMIT_US
            try:
                run.construct(robot_class)
                run.start()
                run.run_until(run.clock.now_us + _SETTLING_US)
            except _FAILURES as error:
                raise _of_robot_code(error, project) from error
            objects = find_objects(run.robot, project.files)
            can = find_can_devices(objects)
            found = list_devices(run.hal_data, find_devices(objects), can)
            found.track_width = find_track_width(objects)
            run.clock.before_packet.append(can.update)
            try:
                found.swerve = find_swerve(run, can.motors, objects)
                if not found.swerve.modules:  # otherwise, what drives the robot is known
                    found.responses = try_sticks(run, {motor.path: motor.output for motor in found.motors})
            except _FAILURES as error:
                found.problem = str(_of_robot_code(error, project))
        finally:
            _close(run)
    return found


def _close(run: RobotRun) -> None:
    """End the run; a robot that cannot end does not matter here."""
    with suppress(Exception, TestEnded):
        run.close()


def _of_robot_code(error: BaseException, project: Project) -> PyfrcError:
    leave_out_libraries(error, project.files)
    if not isinstance(error, TestRanTooLong):
        return as_robot_code_error(error, project.files)
    return RobotCodeError(
        f"the robot is still in this line after {_LIMIT_US / 1_000_000:g} s of robot time, and cannot be driven.",
        where=project.files.innermost_line(error.__traceback__),
        remedy="Does it wait here forever? The robot continues only when its methods return.",
    )


def list_devices(hal_data: HalData, named: Mapping[Place, NamedDevice], can: CanDevices) -> Survey:
    """Return the devices that the robot has created in the HAL, with their names in its code."""
    found = Survey()

    def name_of(key: str, channel: int) -> DeviceName:
        return named[key, channel].name if (key, channel) in named else DeviceName()

    strips = hal_data["addressable_led"]
    led_ports = {strips[index]["output_port"] for index in _made(hal_data, "addressable_led")}
    for channel in _made(hal_data, "pwm"):
        if channel in led_ports:
            continue
        if ("servo", channel) in named:
            found.others.append(f"servo: PWM {channel} ({name_of('servo', channel)})")
            continue
        inverted = ("pwm", channel) in named and motor_controllers.is_inverted(named["pwm", channel].thing)
        found.motors.append(Motor(name_of("pwm", channel), channel, inverted=inverted))
    for index in _made(hal_data, "encoder"):
        encoder = hal_data["encoder"][index]
        a, b = (encoder["config"][f"{letter}Source_Channel"] for letter in "AB")
        counts = abs(encoder["distance_per_pulse"]) == 1.0
        channels = None if a is None or b is None else (a, b)
        found.encoders.append(Encoder(name_of("encoder", index), index, channels, counts))
    for gyro in dict.fromkeys(row.kind.name for row in rows.gyros(numbered=True)):
        found.gyros += [Gyro(name_of(gyro, channel), channel) for channel in _made(hal_data, gyro)]
    found.motors += can.motors
    for device in hal_data["CAN"]:
        if can.owns(device):
            continue
        _add_sim_device(found, device, named)
    found.labels = _labels(found, named)
    for (key, channel), device in named.items():
        wired = devices.wired_kind(device.thing)
        kind = {"dio": "digital", "analog_in": "analog"}.get(key)
        if kind is not None and wired not in ("encoder", "analog gyro"):
            found.others.append(f"{kind} channel {channel} ({device.name})")
    return found


def _made(hal_data: HalData, key: str) -> list[int]:
    return [index for index, device in enumerate(hal_data[key]) if device["initialized"]]


@dataclass(frozen=True)
class _GyroKind:
    """Gyros that appear as a SimDevice of this name, and their properties, from the documentation of WPILib and the
    vendors.
    """

    device: re.Pattern[str]
    angle: str
    rate: str
    clockwise: bool = True
    wraps: bool = False


_GYROS = (
    _GyroKind(re.compile(r"Gyro:ADXRS450\[\d+\]"), "angle_x", "rate_x"),
    _GyroKind(re.compile(r"Gyro:ADIS16(448|470)\[\d+\]"), "gyro_angle_z", "gyro_rate_z", clockwise=False),
    _GyroKind(re.compile(r"CANGyro:Pigeon 2 \(v6\)\[\d+\]"), "rawYawInput", "angularVelZ", clockwise=False),
    _GyroKind(re.compile(r"navX-Sensor\[\d+\]"), "Yaw", "Rate", wraps=True),
)


def _add_sim_device(found: Survey, device: str, named: Mapping[Place, NamedDevice]) -> None:
    # WPILib's own devices have a kind before a colon; those that are not on the CAN bus are identified by their
    # channels. The number of a navX is that of its SPI port.
    elsewhere = (":" in device and not device.startswith("CAN")) or device.startswith("navX")
    number = None if elsewhere else re.search(r"\[(?:\d+,)?(\d+)\]$", device)
    known = named.get(("CAN", int(number[1]))) if number else None
    name = known.name if known else DeviceName()
    values = {value.name for value in devices.sim_values(device)}
    for kind in _GYROS:
        if kind.device.fullmatch(device) and kind.angle in values:
            rate = kind.rate if kind.rate in values else ""
            found.gyros.append(Gyro(name, None, device, kind.angle, rate, kind.clockwise, kind.wraps))
            return
    if not elsewhere:
        found.others.append(f"{device} ({name})" if name else device)


#: The keys of `hal_data` whose channels ``sim/config.json`` may name, and the key that each has there.
_LABELLED = {"pwm": "pwm", "dio": "dio", "analog_in": "analog", "relay": "relay", "solenoid": "solenoid", "CAN": "CAN"}


def _labels(found: Survey, named: Mapping[Place, NamedDevice]) -> dict[str, dict[str, str]]:
    names: dict[str, dict[int, str]] = {key: {} for key in _LABELLED.values()}
    # Channels whose devices have no name get the name of their kind.
    names["pwm"] = {motor.channel: "motor" for motor in found.motors if motor.channel is not None}
    for encoder in found.encoders:
        for letter, channel in zip("AB", encoder.channels or (), strict=False):
            names["dio"][channel] = f"encoder {encoder.index} {letter}"
    names["analog"] = {gyro.channel: "gyro" for gyro in found.gyros if gyro.channel is not None}
    for (key, channel), device in named.items():
        if key in _LABELLED:
            names[_LABELLED[key]][channel] = str(device.name)
    return {
        key: {str(channel): labels[channel] for channel in sorted(labels)} for key, labels in names.items() if labels
    }
