"""The units of robot time. A module of its own, since processes without a robot and without WPILib use them, too."""

#: The driver station sends a packet every 20 ms.
PACKET_US = 20_000


def to_us(seconds: float) -> int:
    """Return a time in whole microseconds."""
    return round(seconds * 1_000_000)
