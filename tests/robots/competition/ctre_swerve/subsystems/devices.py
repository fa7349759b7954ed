"""What all subsystems do with their CTRE devices: configure them, and watch whether they are there."""

from phoenix6.hardware import ParentDevice
from phoenix6.status_code import StatusCode
from wpilib import Alert


def configure(device: ParentDevice, config: object) -> None:
    """Apply the configuration, which may need several attempts on a busy bus."""
    for _ in range(5):
        status: StatusCode = device.configurator.apply(config)
        if status.is_ok():
            return
    Alert(f"{name_of(device)} is not configured: {status.name}", Alert.AlertType.kError).set(True)


def name_of(device: ParentDevice) -> str:
    """Return, for example, `TalonFX 11`."""
    return f"{type(device).__name__} {device.device_id}"


class Connections:
    """One alert for each device that does not send."""

    def __init__(self, *devices: ParentDevice) -> None:
        self._devices = [
            (device, Alert(f"{name_of(device)} is not on the CAN bus", Alert.AlertType.kError)) for device in devices
        ]

    def update(self) -> None:
        """Called once each loop."""
        for device, alert in self._devices:
            alert.set(not device.is_connected)
