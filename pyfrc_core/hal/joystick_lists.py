"""The axes, buttons and POVs of a joystick, as three lists of `hal_data`; a season's class reads and writes the HAL."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import partial

from .containers import LiveDict, Slot, ValueList
from .kinds import BOOL, ValueKind, number, whole
from .paths import join

_ANGLE = ValueKind("-1 or an angle from 0 to 360", whole(-1, 360).convert, -1)


class JoystickLists(LiveDict, ABC):
    """A joystick with `axes`, `buttons` and `povs`.

    :param path: its path in `hal_data`
    :param read: returns the access to each of its values, by key
    :param axes, povs: the lengths of these lists
    """

    def __init__(self, path: str, read: Callable[[], dict[str, Slot]], axes: int, povs: int) -> None:
        super().__init__(path, read)

        def changed(key: str) -> Callable[[], object]:
            return partial(self._changed, key)

        self.axes = ValueList(
            join(path, "axes"),
            number(-1, 1),
            lambda: axes,
            self._axis,
            self._set_axis,
            self._load_axes,
            changed("axes"),
        )
        self.buttons = ValueList(
            join(path, "buttons"),
            BOOL,
            self._buttons_shown,
            self._button,
            self._set_button,
            self._load_buttons,
            changed("buttons"),
        )
        self.povs = ValueList(
            join(path, "povs"), _ANGLE, lambda: povs, self._pov, self._set_pov, self._load_povs, changed("povs")
        )

    @abstractmethod
    def _axis(self, index: int) -> float: ...

    @abstractmethod
    def _set_axis(self, index: int, value: float) -> None: ...

    @abstractmethod
    def _load_axes(self) -> list[float]: ...

    @abstractmethod
    def _buttons_shown(self) -> int: ...

    @abstractmethod
    def _button(self, index: int) -> bool: ...

    @abstractmethod
    def _set_button(self, index: int, value: bool) -> None: ...

    @abstractmethod
    def _load_buttons(self) -> list[bool]: ...

    @abstractmethod
    def _pov(self, index: int) -> int: ...

    @abstractmethod
    def _set_pov(self, index: int, value: int) -> None: ...

    @abstractmethod
    def _load_povs(self) -> list[int]: ...
