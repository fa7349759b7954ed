"""The channels of encoders, from the arguments of their constructors: WPILib does not return them."""

from __future__ import annotations

from typing import Any

#: The channels A and B by the encoder's index in the HAL, which uses the index of a freed encoder again.
_channels: dict[int, tuple[int, int]] = {}


def note(index: int, *args: Any, **kwargs: Any) -> None:
    """Keep the channels of an encoder that the robot has made, from the arguments of its constructor.

    :param index: in the HAL
    """
    # The names are `aChannel` or `aSource` in 2026, and `a_channel` in 2027.
    given = dict(zip("ab", args, strict=False)) | {name[0]: value for name, value in kwargs.items()}
    _channels[index] = _number(given["a"]), _number(given["b"])


def _number(source: Any) -> int:
    """Return the channel of a source: itself, or a device such as a `DigitalInput`."""
    return int(source.getChannel() if hasattr(source, "getChannel") else source)


def channels_of(index: int) -> tuple[int, int] | None:
    """Return the digital channels of an encoder that exists; None if it was made while no robot was watched."""
    return _channels.get(index)
